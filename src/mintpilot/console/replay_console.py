"""A recorded mission on the page: any moment of it, and nothing can be answered."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Self

from mintpilot.console.access import Address, Tokens
from mintpilot.console.board import Board
from mintpilot.console.desk import Desk
from mintpilot.console.mission_view import MissionView
from mintpilot.console.protocol import Playing, ReplayPane, Seek
from mintpilot.console.tape import Tape
from mintpilot.core.errors import MissingPartError
from mintpilot.core.events import Event, FrameSeen, Stepped
from mintpilot.core.ports import Recorder
from mintpilot.core.query import Question

_BEAT_S = 0.05


class ReplayConsole(Recorder):
    """Takes a mission in, then serves it. Close it in the end, or use it as a context manager.

    Args:
        jpeg_of: the picture of an event, where it was kept.
        address: where to listen.
        tokens: who may look.

    Raises:
        DeviceError: nothing can be served at that address.
        MissingPartError: the web server is not installed.
    """

    def __init__(
        self,
        *,
        jpeg_of: Callable[[FrameSeen], bytes | None],
        address: Address | None = None,
        tokens: Tokens | None = None,
    ) -> None:
        try:
            from mintpilot.console.server import ConsoleServer
        except ImportError as error:
            raise MissingPartError("the web page needs its web server: pip install 'mintpilot[console]'") from error
        self._board, self._desk, self._tape = Board(), Desk(replays=True), Tape()
        self._view = MissionView(self._tape, jpeg_of)
        self._tokens = tokens or Tokens()
        self._server = ConsoleServer(self._board, self._desk, address or Address(), self._tokens)
        self._ends = threading.Event()
        self._player = threading.Thread(target=self._play, name="mintpilot replay", daemon=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def url(self) -> str:
        """The page's address, with the token in its fragment."""
        return f"{self._server.base_url}/#{self._tokens.answer}"

    def record(self, event: Event) -> None:
        """Takes in one event of the mission."""
        self._turn(event.input.time_s if isinstance(event, Stepped) else 0.0)
        self._view.record(event)

    def show(self, question: Question, patience_s: float) -> None:
        """Takes in that a question was put."""
        self._turn()
        self._view.show(question, patience_s)

    def withdraw(self, question: str, why: str) -> None:
        """Takes in that a question was taken back."""
        self._turn()
        self._view.withdraw(question, why)

    def tell(self, text: str) -> None:
        """Takes in what was said."""
        self._turn()
        self._view.tell(text)

    def serve(self) -> None:
        """All is taken in: shows its beginning, and lets browsers go to other moments."""
        self._player.start()

    def close(self) -> None:
        """Serves no more. Safe to call again."""
        self._ends.set()
        if self._player.is_alive():
            self._player.join(timeout=5.0)
        self._server.close()

    def _turn(self, time_s: float = 0.0) -> None:
        self._tape.turn(time_s)

    def _play(self) -> None:
        tape, at_s, turn, speed = self._tape, 0.0, 0, 0.0
        shown, before = None, time.monotonic()
        while not self._ends.wait(_BEAT_S):
            now = time.monotonic()
            if speed:
                at_s = at_s + speed * (now - before)
                turn = tape.turn_at(at_s)
            before = now
            for asked in self._desk.collect():
                match asked.command:
                    case Seek(moment=None):
                        at_s = min(asked.command.time_s, tape.end_s)
                        turn = tape.turn_at(at_s)
                    case Seek(moment=int(moment)):
                        turn = tape.turn_of(moment)
                        at_s = tape.time_of(turn)
                    case Playing():
                        at_s, speed = (0.0 if at_s >= tape.end_s else at_s), asked.command.speed
                    case _:
                        pass
            if at_s >= tape.end_s:
                at_s, speed = tape.end_s, 0.0
            if (at_s, turn, speed) != shown:
                shown = (at_s, turn, speed)
                self._show(at_s, turn, speed)

    def _show(self, at_s: float, turn: int, speed: float) -> None:
        self._tape.show(self._board, turn)
        passed, exact = self._tape.passed(turn)
        pane = ReplayPane(
            time_s=round(at_s, 2),
            to_s=round(self._tape.end_s, 2),
            speed=speed,
            moments=tuple(self._tape.moments),
            passed=passed,
            exact=exact,
        )
        self._board.put("replay", pane)
