"""Sound from files and packets: checked, and brought to one channel at 16 kHz."""

from __future__ import annotations

import wave
from math import gcd
from pathlib import Path

import numpy as np

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Floats
from mintpilot.voice.ports import RATE_HZ

LONGEST_S = 600.0
"""Files are read no further than this, seconds."""
_EDGE_S = 0.03
"""Kept of the silence around speech, seconds."""
_RATES_HZ = (4_000, 192_000)


def read_wav(path: Path) -> Floats:
    """The samples of a WAV file of 8 to 32 bits, any number of channels and any usual rate, at `RATE_HZ`.

    A file that was cut off is read as far as it goes.

    Raises:
        InputError: it is empty, or no WAV file of whole numbers.
    """
    try:
        with wave.open(str(path), "rb") as file:
            width, channels, rate_hz = file.getsampwidth(), file.getnchannels(), file.getframerate()
            data = file.readframes(int(LONGEST_S * max(1, rate_hz)))
    except (OSError, EOFError, wave.Error) as error:
        raise InputError(f"{path}: {error or 'it is empty'}; it must be a WAV file of whole numbers") from error
    if not _RATES_HZ[0] <= rate_hz <= _RATES_HZ[1]:
        raise InputError(f"{path}: {rate_hz} samples a second; {_RATES_HZ[0]} to {_RATES_HZ[1]} can be read")
    samples = from_pcm(data, width=width, channels=channels)
    if not len(samples):
        raise InputError(f"{path}: there is no sound in it; record it again")
    return resampled(samples, rate_hz)


def write_wav(path: Path, samples: Floats) -> None:
    """Writes sound at `RATE_HZ` as 16 bits."""
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE_HZ)
        file.writeframes(to_pcm16(samples))


def from_pcm(data: bytes, *, width: int = 2, channels: int = 1) -> Floats:
    """Packed whole numbers, least byte first, as samples (n,) from -1 to 1; a last part of a frame is left out.

    Raises:
        InputError: another width than 1, 2, 3 or 4 bytes, or no channel.
    """
    if width not in (1, 2, 3, 4) or channels < 1:
        raise InputError(
            f"sound of {width} bytes and {channels} channels: 1 to 4 bytes and 1 channel or more it must be"
        )
    whole = len(data) // (width * channels) * width * channels
    raw = np.frombuffer(data[:whole], np.uint8).reshape(-1, width)
    if width == 1:
        values = (raw[:, 0].astype(float) - 128) / 128
    else:
        padded = np.zeros((len(raw), 4), np.uint8)
        padded[:, 4 - width :] = raw
        values = padded.view("<i4")[:, 0] / 2.0**31
    return np.asarray(values.reshape(-1, channels).mean(axis=1), dtype=float)


def to_pcm16(samples: Floats) -> bytes:
    """Samples as 16 bits, least byte first; clipped at full scale."""
    return bytes((clean(samples) * 32767).astype("<i2").tobytes())


def clean(samples: Floats) -> Floats:
    """Finite samples: what is no number is silence, what is beyond full scale is clipped."""
    finite: Floats = np.nan_to_num(np.asarray(samples, float).ravel(), nan=0.0, posinf=1.0, neginf=-1.0)
    return np.clip(finite, -1.0, 1.0)


def resampled(samples: Floats, rate_hz: int) -> Floats:
    """Samples at `RATE_HZ` of those at another rate."""
    if rate_hz == RATE_HZ or not len(samples):
        return samples
    from scipy.signal import resample_poly

    common = gcd(rate_hz, RATE_HZ)
    return np.asarray(resample_poly(samples, RATE_HZ // common, rate_hz // common), dtype=float)


def trimmed(samples: Floats) -> Floats:
    """Samples without the silence before and after: what is quieter than a hundredth of the loudest."""
    loud = np.flatnonzero(np.abs(samples) > 0.01 * np.abs(samples).max(initial=0.0))
    if not len(loud):
        return samples
    edge = int(_EDGE_S * RATE_HZ)
    return samples[max(0, loud[0] - edge) : loud[-1] + edge]


def level_db(samples: Floats) -> float:
    """Root mean square of the samples against full scale, decibels; -120 for silence."""
    power = float(np.mean(np.square(samples))) if len(samples) else 0.0
    return 10 * float(np.log10(max(power, 1e-12)))
