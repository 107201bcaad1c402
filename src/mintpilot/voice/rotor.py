"""The noise of four rotors: harmonics of the blade frequency, which drifts and jitters, over broadband noise."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.voice.ports import RATE_HZ

_BLADE_HZ = (150.0, 210.0)
"""Blade frequencies of small four-rotor drones: two blades at 75 to 105 turns a second."""
_HARMONICS = 14
_DRIFT, _JITTER = 0.03, 0.004
"""Shares of the blade frequency: slow changes of speed, and those from sample to sample (smoothed over 20 ms)."""


def rotor_noise(samples: int, rng: np.random.Generator) -> Floats:
    """Noise (samples,) at `RATE_HZ` with a root mean square of 1."""
    from scipy.signal import butter, lfilter

    t_s = np.arange(samples) / RATE_HZ
    tones = np.zeros(samples)
    smooth = RATE_HZ // 50
    for _ in range(4):
        blade_hz = rng.uniform(*_BLADE_HZ)
        drift = _DRIFT * np.sin(2 * np.pi * rng.uniform(0.2, 0.8) * t_s + rng.uniform(0, 2 * np.pi))
        jitter = np.convolve(rng.standard_normal(samples + smooth - 1), np.ones(smooth) / smooth**0.5, "valid")
        phase = 2 * np.pi * np.cumsum(blade_hz * (1 + drift + _JITTER * jitter)) / RATE_HZ
        for harmonic in range(1, _HARMONICS + 1):
            tones += np.sin(harmonic * phase + rng.uniform(0, 2 * np.pi)) / harmonic
    low = lfilter(*butter(1, 1500 / (RATE_HZ / 2)), rng.standard_normal(samples))
    high = lfilter(*butter(1, 7000 / (RATE_HZ / 2)), rng.standard_normal(samples))
    made = tones / _rms(tones) + 0.9 * low / _rms(low) + 0.4 * high / _rms(high)
    return np.asarray(made / _rms(made), dtype=float)


def mixed(speech: Floats, snr_db: float, rng: np.random.Generator) -> Floats:
    """Speech with rotor noise, so many decibels below it (both by their power); scaled down where it would clip."""
    noisy = speech + rotor_noise(len(speech), rng) * _rms(speech) / 10 ** (snr_db / 20)
    return np.asarray(noisy / max(1.0, float(np.abs(noisy).max(initial=0.0))), dtype=float)


def _rms(values: Floats) -> float:
    return max(float(np.sqrt(np.mean(np.square(values)))), 1e-9) if len(values) else 1e-9
