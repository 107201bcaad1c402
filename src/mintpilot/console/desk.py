"""Which browser answers, and what browsers want done: between the web server's thread and the mission's."""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import dataclass, field

from mintpilot.console.access import Role
from mintpilot.console.microphone import Microphone
from mintpilot.console.protocol import (
    AnyCommand,
    LeaveSeat,
    Listen,
    Ordering,
    Playing,
    QuestionSeen,
    SeatPane,
    Seek,
    TakeSeat,
)

MOST_WAITING = 200
"""Commands that wait for the mission; more than that are refused, orders never."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """A command, and whose it is."""

    command: AnyCommand
    who: str
    """For the record: ``console:ab12cd34@127.0.0.1``."""


@dataclass(slots=True)
class Client:
    """One open link of a browser."""

    browser: str
    role: Role
    address: str

    @property
    def who(self) -> str:
        """For the record."""
        return f"console:{self.browser[:8]}@{self.address}"


@dataclass(slots=True)
class Desk:
    """Thread-safe. One browser has the seat: it answers. Whoever may answer may give orders and take the seat over.

    Beside a recorded mission nobody answers: whoever has the address may go to other moments.
    """

    replays: bool = False
    microphone: Microphone | None = None
    """Of the browser that has the seat; None: nothing is heard here."""
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _clients: list[Client] = field(default_factory=list)
    _inbox: deque[Asked] = field(default_factory=deque)
    _seen: dict[str, int] = field(default_factory=dict)
    _seat: str = ""
    _somebody: threading.Event = field(default_factory=threading.Event)

    def enter(self, client: Client) -> None:
        """A browser has come. The first that may answer gets the seat."""
        with self._lock:
            self._clients.append(client)
            if client.role is Role.ANSWER:
                if not self._seat:
                    self._seat = client.browser
                self._somebody.set()

    def leave(self, client: Client) -> None:
        """A link is gone. The seat stays with its browser: it may come back."""
        with self._lock:
            self._clients = [c for c in self._clients if c is not client]
            if client.browser == self._seat and not any(c.browser == self._seat for c in self._clients):
                self._fall_deaf()

    def seat(self, client: Client) -> SeatPane:
        """What that browser may do."""
        with self._lock:
            return SeatPane(
                may_answer=client.role is Role.ANSWER and not self.replays,
                seated=client.role is Role.ANSWER and client.browser == self._seat and not self.replays,
                taken=any(c.browser == self._seat for c in self._clients),
                viewers=len({c.browser for c in self._clients}),
            )

    def take(self, client: Client, command: AnyCommand) -> bool:
        """Does what that browser wants, or hands it to the mission; False: it may not, or it is too much.

        A command that was taken already, and came again after a broken link, is taken and not done again.
        """
        with self._lock:
            if client.role is not Role.ANSWER:
                return False
            if command.n <= self._seen.get(client.browser, 0):
                return True
            if self.replays or isinstance(command, Seek | Playing):
                if not (self.replays and isinstance(command, Seek | Playing)) or len(self._inbox) >= MOST_WAITING:
                    return False
                self._inbox.append(Asked(command=command, who=client.who))
            elif isinstance(command, Listen):
                if client.browser != self._seat or self.microphone is None:
                    return False
                self.microphone.switch(command.on, aloud=command.aloud)
            elif isinstance(command, TakeSeat):
                if self._seat != client.browser:
                    self._fall_deaf()
                self._seat = client.browser
            elif isinstance(command, LeaveSeat):
                if self._seat == client.browser:
                    self._fall_deaf()
                    self._seat = ""
            elif isinstance(command, Ordering) or (client.browser == self._seat and len(self._inbox) < MOST_WAITING):
                self._inbox.append(Asked(command=command, who=client.who))
            elif not isinstance(command, QuestionSeen):
                return False
            self._seen[client.browser] = command.n
            return True

    def hear(self, client: Client, sound: bytes) -> None:
        """Sound of a browser; that of any but the one that answers is left out."""
        with self._lock:
            if client.role is Role.ANSWER and client.browser == self._seat and self.microphone is not None:
                self.microphone.take(sound)

    def _fall_deaf(self) -> None:
        """A microphone belongs to the browser that switched it on, and is not taken over."""
        if self.microphone is not None:
            self.microphone.switch(False)

    def collect(self) -> tuple[Asked, ...]:
        """What came since the last call, oldest first."""
        with self._lock:
            came = tuple(self._inbox)
            self._inbox.clear()
        return came

    def wait(self, timeout_s: float) -> bool:
        """Waits until somebody who may answer has come; False: nobody has, within so many seconds."""
        return self._somebody.wait(timeout_s)
