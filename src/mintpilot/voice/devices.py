"""Microphone and loudspeaker by PortAudio; files and pipes in their place."""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mintpilot.core.errors import DeviceError, MissingPartError
from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import from_pcm, read_wav
from mintpilot.voice.echo import FRAME, EchoCanceller
from mintpilot.voice.ports import RATE_HZ, SoundLink

_KEPT = 3000
"""Frames of the microphone that wait to be listened to, 30 s; of a flood the oldest are dropped."""
_MOST_BYTES = 1 << 16
"""Of a pipe at one time."""
_GONE_S = 2.0
"""A microphone that gives nothing for so long of the mission clock is gone, seconds."""


class PortAudioLink(SoundLink):
    """The default microphone and loudspeaker, with echo cancellation.

    Raises:
        MissingPartError: ``sounddevice`` or the system library ``libportaudio2`` is not installed.
        DeviceError: there is no microphone or no loudspeaker.
    """

    def __init__(self) -> None:
        try:
            import sounddevice
        except ImportError as error:
            raise MissingPartError(
                "a microphone needs sounddevice: python -m pip install 'mintpilot[voice]'"
            ) from error
        except OSError as error:
            raise MissingPartError(
                "a microphone needs the system library libportaudio2: sudo apt-get install libportaudio2"
            ) from error
        self._echo = EchoCanceller()
        self._lock = threading.Lock()
        self._out: Floats = np.zeros(0)
        self._in: deque[Floats] = deque(maxlen=_KEPT)
        self._heard_s: float | None = None
        try:
            self._stream = sounddevice.Stream(
                samplerate=RATE_HZ, blocksize=FRAME, channels=1, dtype="float32", callback=self._frame
            )
            self._stream.start()
        except sounddevice.PortAudioError as error:
            raise DeviceError(
                f"no microphone or no loudspeaker can be opened ({error}): plug one in, or answer by keys with "
                "--operator terminal"
            ) from error

    def play(self, samples: Floats, time_s: float) -> None:  # noqa: ARG002
        """See `SoundLink.play`."""
        with self._lock:
            self._out = np.concatenate([self._out, samples])

    def stop(self) -> None:
        """See `SoundLink.stop`."""
        with self._lock:
            self._out = np.zeros(0)

    def is_playing(self, time_s: float) -> bool:  # noqa: ARG002
        """See `SoundLink.is_playing`."""
        return len(self._out) > 0

    def listen(self, time_s: float) -> Sequence[Floats]:
        """See `SoundLink.listen`."""
        with self._lock:
            found = list(self._in)
            self._in.clear()
        if found or self._heard_s is None:
            self._heard_s = time_s
        if not self._stream.active or time_s - self._heard_s > _GONE_S:
            raise DeviceError("the microphone gives no sound any more; it may be unplugged. Answer by keys.")
        return found

    def close(self) -> None:
        """See `SoundLink.close`."""
        self._stream.close()

    def _frame(self, heard: Any, played: Any, frames: int, *_: object) -> None:
        """Called by PortAudio on its own thread, every 10 ms."""
        with self._lock:
            now, self._out = self._out[:frames], self._out[frames:]
        played[:, 0] = 0
        played[: len(now), 0] = now
        cleaned = self._echo.process(np.asarray(heard[:, 0], float), np.asarray(played[:, 0], float))
        with self._lock:
            self._in.append(cleaned)


class _Silent(SoundLink):
    """Plays nothing aloud; it takes as long as the sound is."""

    def __init__(self) -> None:
        self._until_s = -np.inf

    def play(self, samples: Floats, time_s: float) -> None:
        """See `SoundLink.play`."""
        self._until_s = max(self._until_s, time_s) + len(samples) / RATE_HZ

    def stop(self) -> None:
        """See `SoundLink.stop`."""
        self._until_s = -np.inf

    def is_playing(self, time_s: float) -> bool:
        """See `SoundLink.is_playing`."""
        return time_s < self._until_s


class PipeLink(_Silent):
    """Hears a pipe of packed 16-bit samples at `RATE_HZ`, as another program brings them; plays nothing aloud.

    Args:
        path: a named pipe, or a device file.

    Raises:
        DeviceError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        try:
            self._pipe = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
        except OSError as error:
            raise DeviceError(f"{path} cannot be heard ({error.strerror}): give a WAV file, or a pipe") from error
        self._rest = b""

    def listen(self, time_s: float) -> Sequence[Floats]:  # noqa: ARG002
        """See `SoundLink.listen`; silence while nobody writes."""
        try:
            came = self._rest + os.read(self._pipe, _MOST_BYTES)
        except BlockingIOError:
            return []
        except OSError as error:
            raise DeviceError(f"the pipe gives no sound any more ({error.strerror}). Answer by keys.") from error
        whole = len(came) // 2 * 2
        self._rest = came[whole:]
        return [from_pcm(came[:whole])] if whole else []

    def close(self) -> None:
        """See `SoundLink.close`."""
        if self._pipe >= 0:
            os.close(self._pipe)
            self._pipe = -1


class FileLink(_Silent):
    """Hears a recording, as fast as the mission clock goes; plays nothing aloud.

    Args:
        path: a WAV file.

    Raises:
        InputError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._sound = read_wav(path)
        self._begun_s: float | None = None
        self._given = 0

    def listen(self, time_s: float) -> Sequence[Floats]:
        """The part of the recording that has passed since the last call; silence after its end."""
        if self._begun_s is None:
            self._begun_s = time_s
        until = int((time_s - self._begun_s) * RATE_HZ)
        piece = self._sound[self._given : until]
        silence = np.zeros(max(0, min(until - self._given - len(piece), RATE_HZ)))
        self._given = max(self._given, until)
        return [part for part in (piece, silence) if len(part)]

    def close(self) -> None:
        """Nothing to give back."""


def link_to(path: Path | None) -> SoundLink:
    """The microphone and loudspeaker of this machine; with a path a recording, or a pipe, in the microphone's place.

    Raises:
        MissingPartError: PortAudio is not installed.
        DeviceError: there is no microphone or no loudspeaker, or the pipe cannot be opened.
        InputError: the recording cannot be read.
    """
    if path is None:
        return PortAudioLink()
    return FileLink(path) if path.is_file() or not path.exists() else PipeLink(path)
