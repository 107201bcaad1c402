"""The microphone of the browser that answers: its sound on the way in, what is said on the way out."""

from __future__ import annotations

import threading
from collections import deque

from mintpilot.console.board import Panes
from mintpilot.console.protocol import MicrophonePane, SpokenPane

RATE_HZ = 16_000
"""Of all sound over the link: one channel, 16 bits, least byte first."""
KEPT_S = 10.0
"""Sound that waits for the mission; of more the oldest is dropped, seconds."""
_PAUSE_S = 0.6
"""Silence that ends what was being said when the button was released, seconds."""
_PAUSE = bytes(2 * int(_PAUSE_S * RATE_HZ))


class Microphone:
    """Between the web server's thread and the mission's. Off until the browser that answers switches it on.

    Args:
        board: where captions are shown, and from where sound goes to browsers.

    Attributes:
        is_aloud: whether that browser plays what the drone says.
    """

    def __init__(self, board: Panes) -> None:
        self._board, self._lock = board, threading.Lock()
        self._sound: deque[bytes] = deque()
        self._waiting = self._said = 0
        self._shown = MicrophonePane()
        self._is_on = False
        self.is_aloud = True

    @property
    def is_on(self) -> bool:
        """Whether a browser listens at this moment."""
        return self._is_on

    def switch(self, on: bool, *, aloud: bool = True) -> None:
        """Switched by the browser that answers, or off when it is gone. What was said before is forgotten."""
        with self._lock:
            if on is not self._is_on:
                self._sound.clear()
                self._sound.append(_PAUSE)
                self._waiting = len(_PAUSE)
            self._is_on, self.is_aloud = on, aloud

    def take(self, sound: bytes) -> None:
        """Sound of the browser that answers; nothing: the button was released."""
        with self._lock:
            if not self._is_on:
                return
            piece = sound[: len(sound) // 2 * 2] or _PAUSE
            self._sound.append(piece)
            self._waiting += len(piece)
            while self._waiting > 2 * KEPT_S * RATE_HZ:
                self._waiting -= len(self._sound.popleft())

    def collect(self) -> bytes:
        """What came since the last call."""
        with self._lock:
            came = b"".join(self._sound)
            self._sound.clear()
            self._waiting = 0
        return came

    def play(self, sound: bytes) -> None:
        """Played by the browser whose microphone is on, in the place of what it still plays."""
        self._said += 1
        self._board.put("spoken", SpokenPane(n=self._said), sound)

    def stop(self) -> None:
        """Ends what is played."""
        self._said += 1
        self._board.put("spoken", SpokenPane(n=self._said))

    def show(self, *, problem: str | None = None, said: str | None = None, heard: str | None = None) -> None:
        """Shows what changed of: why nothing is heard (empty: it is), what is said, what was heard."""
        changes = {"problem": problem, "said": said, "heard": heard}
        update = {name: text[:400] for name, text in changes.items() if text is not None}
        self._shown = self._shown.model_copy(update=update)
        self._board.put("microphone", self._shown)
