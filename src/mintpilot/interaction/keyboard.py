"""Keys and lines from a file descriptor, without waiting (method, section 12)."""

from __future__ import annotations

import atexit
import os
import select
import termios
import tty
from dataclasses import dataclass
from typing import Any

LONGEST_LINE = 4096
"""Bytes; what is typed beyond them without a line's end is thrown away."""
ALONE_S = 0.5
"""A letter on an empty line answers when nothing follows for so long, seconds."""
_ENTER, _ERASE, _CLEAR, _END, _ESCAPE = b"\r\n", b"\x08\x7f", 0x15, 0x04, 0x1B


@dataclass(frozen=True, slots=True, kw_only=True)
class Typed:
    """What was typed."""

    text: str
    alone: bool = False
    """True for a single letter that stood alone long enough to be a key; False for a line that was ended."""


class Keyboard:
    """Reads what is typed. At a terminal, letters count one by one between `begin` and `end`; elsewhere lines do.

    Args:
        fd: of a terminal, or of a pipe or file.
    """

    def __init__(self, fd: int) -> None:
        self._fd = fd
        self._before: list[Any] | None = None
        self._letters = ""
        self._pending = b""
        self._line = b""
        self._last_s = 0.0
        self.ended = False
        """Whether nothing more can come."""
        atexit.register(self.end)

    @property
    def is_terminal(self) -> bool:
        """Whether a person may type here."""
        return os.isatty(self._fd)

    @property
    def unfinished(self) -> str:
        """What stands on the line that was not ended yet, at a terminal between `begin` and `end`."""
        return self._line.decode("utf-8", errors="ignore")

    def begin(self, letters: str) -> None:
        """These letters answer alone from now on; what was typed before is thrown away. A pipe's lines are kept."""
        if not self.is_terminal:
            return
        termios.tcflush(self._fd, termios.TCIFLUSH)
        self._pending = self._line = b""
        self._letters = letters
        if self._before is None:
            self._before = termios.tcgetattr(self._fd)
            tty.setcbreak(self._fd, termios.TCSADRAIN)

    def forget(self) -> None:
        """Half a line is forgotten, so that it answers no later question."""
        self._line = b""
        self._pending = self._pending[: self._pending.rfind(b"\n") + 1]

    def end(self) -> None:
        """The terminal is as it was before."""
        self._line = b""
        before, self._before = self._before, None
        if before is not None:
            try:
                termios.tcsetattr(self._fd, termios.TCSADRAIN, before)
            except (termios.error, OSError):  # the terminal was closed
                self.ended = True

    def put_back(self, line: str) -> None:
        """A line that was read too early: it is read again next."""
        self._pending = line.encode() + b"\n" + self._pending

    def read(self, now_s: float) -> Typed | None:
        """The next letter or line; None where there is none yet, or no more.

        Args:
            now_s: of a clock that never goes back, seconds; it tells whether a letter stood alone.
        """
        if self._before is None:
            line = self._read_line()
            return None if line is None else Typed(text=line)
        self._take(now_s)
        return self._typed(now_s)

    def _take(self, now_s: float) -> None:
        while not self.ended and select.select([self._fd], [], [], 0)[0]:
            try:
                chunk = os.read(self._fd, 1024)
            except OSError:  # the terminal was closed
                chunk = b""
            self.ended = not chunk
            self._pending = (self._pending + chunk)[-LONGEST_LINE:]
            self._last_s = now_s

    def _typed(self, now_s: float) -> Typed | None:
        """Edits the line with what came, up to its end."""
        while self._pending:
            byte = self._pending[0]
            if byte == _ESCAPE:  # an arrow or a function key: the rest of what came with it
                self._pending = b""
                break
            self._pending = self._pending[1:]
            if byte in _ENTER:
                line, self._line = self._line, b""
                return Typed(text=line.decode("utf-8", errors="replace").strip())
            if byte in _ERASE:
                self._line = self._line.decode("utf-8", errors="ignore")[:-1].encode()
            elif byte == _CLEAR:
                self._line = b""
            elif byte == _END:
                self.ended = True
            elif byte >= 0x20 and len(self._line) < LONGEST_LINE:
                self._line += bytes([byte])
        letter = self.unfinished
        if len(letter) == 1 and letter.casefold() in self._letters and now_s - self._last_s >= ALONE_S:
            self._line = b""
            return Typed(text=letter, alone=True)
        return None

    def _read_line(self) -> str | None:
        while b"\n" not in self._pending:
            if self.ended or not select.select([self._fd], [], [], 0)[0]:
                return None
            try:
                chunk = os.read(self._fd, 1024)
            except OSError:  # the terminal was closed
                chunk = b""
            if chunk:
                self._pending = (self._pending + chunk)[-LONGEST_LINE:]
                continue
            self.ended = True
            if self._pending:
                self._pending += b"\n"
        line, _, self._pending = self._pending.partition(b"\n")
        return line.decode("utf-8", errors="replace").strip()
