"""The person at a web page, as an operator; and a recorder that shows the mission to whoever watches."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from types import TracebackType
from typing import Self, TypeAlias

from mintpilot.console.access import Address, Role, Tokens
from mintpilot.console.answering import Answering, Heard, Turn
from mintpilot.console.board import Board
from mintpilot.console.desk import Asked, Desk
from mintpilot.console.microphone import Microphone
from mintpilot.console.mission_view import MissionView
from mintpilot.console.protocol import AttentionPane, Said
from mintpilot.core.errors import DeviceError, MissingPartError
from mintpilot.core.events import Event, FrameSeen, QuestionTimed, ViewTaken
from mintpilot.core.inputs import OperatorInput, Ordered
from mintpilot.core.ports import Operator, Recorder, Understand
from mintpilot.core.query import Order, Question

_BUSY = 200
"""Events that wait to be shown; beyond that pictures are left out."""
_LATE = 20
"""The same of pictures that are only watched."""
_Work: TypeAlias = Callable[[MissionView], None]


class WebConsole(Operator, Recorder):
    """Serves the page. Close it in the end, or use it as a context manager.

    Args:
        understand: what typed words mean as an answer; it may take its time.
        order_of: the order that words are where nothing is asked; None: they are none.
        address: where to listen.
        tokens: who may do what.

    Raises:
        DeviceError: nothing can be served at that address.
        MissingPartError: the web server is not installed.
    """

    def __init__(
        self,
        *,
        understand: Understand,
        order_of: Callable[[str], Order | None],
        address: Address | None = None,
        tokens: Tokens | None = None,
    ) -> None:
        try:
            from mintpilot.console.server import ConsoleServer
        except ImportError as error:
            raise MissingPartError("the web console needs its web server: pip install 'mintpilot[console]'") from error
        self._board = Board()
        self.microphone = Microphone(self._board)
        """Of the browser that answers, for whoever can hear it."""
        self._desk = Desk(microphone=self.microphone)
        self._order_of = order_of
        self._answering = Answering(understand)
        self._attention = 0
        self._work: queue.SimpleQueue[_Work | None] = queue.SimpleQueue()
        self._tokens = tokens or Tokens()
        self._server = ConsoleServer(self._board, self._desk, address or Address(), self._tokens)
        self._viewer = threading.Thread(target=self._view, name="mintpilot console view", daemon=True)
        self._viewer.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def url(self, role: Role = Role.ANSWER) -> str:
        """The page's address, with the token in its fragment."""
        token = self._tokens.answer if role is Role.ANSWER else self._tokens.watch
        return f"{self._server.base_url}/#{token}"

    def wait_for_somebody(self, timeout_s: float) -> bool:
        """Waits until a browser that may answer has come; False: none has, within so many seconds."""
        return self._desk.wait(timeout_s)

    def close(self) -> None:
        """Shows what is left, and serves no more. Safe to call again."""
        if self._viewer.is_alive():
            self._work.put(None)
            self._viewer.join(timeout=5.0)
        self._answering.close()
        self._server.close()

    # Operator

    @property
    def attended(self) -> bool:
        """True: a person is meant to sit at the page."""
        return True

    @property
    def hears_once(self) -> bool:
        """False: better words replace the first ones on the screen."""
        return False

    def show(self, question: Question, patience_s: float) -> None:
        """Puts the question on every page."""
        turn = self._answering.turn
        if turn is not None and turn.question.id == question.id:
            turn.question = question
        else:
            self._answering.turn = Turn(question, patience_s)
        self._work.put(lambda view: view.show(question, patience_s))

    def withdraw(self, question: str, why: str) -> None:
        """Takes the question off every page, saying why."""
        turn = self._answering.turn
        if turn is not None and turn.question.id == question:
            self._answering.turn = None
        self._work.put(lambda view: view.withdraw(question, why))

    def tell(self, text: str) -> None:
        """Adds a line to the log of every page."""
        self._work.put(lambda view: view.tell(text))

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """What browsers brought since the last call."""
        if not self._server.serves:
            raise DeviceError("the web console serves no more: its server has stopped; answer at the terminal")
        heard = [*self._answering.read(time_s)]
        heard += [self._heard(asked, time_s) for asked in self._desk.collect()]
        turn = self._answering.turn
        if turn is not None and any(one.changed for one in heard):
            question = turn.question
            self._work.put(lambda view: view.show_again(question))
        for show in [one.show for one in heard if one.show]:
            self._attention += 1
            self._board.put("attention", AttentionPane(n=self._attention, to=show))
        return tuple(event for one in heard for event in one.events)

    def _heard(self, asked: Asked, time_s: float) -> Heard:
        command = asked.command
        if not isinstance(command, Said) or self._answering.turn is not None:
            return self._answering.hear(asked, time_s)
        order = self._order_of(command.text)
        if order is None:
            return Heard(show="nothing-asked")
        return Heard(events=(Ordered(time_s=time_s, order=order, operator=asked.who, text=command.text),))

    # Recorder

    def record(self, event: Event) -> None:
        """Shows one event to whoever watches, a moment later, in another thread."""
        turn = self._answering.turn
        if isinstance(event, QuestionTimed) and turn is not None and turn.question.id == event.question:
            turn.patience_s = max(0.0, event.deadline_s - (turn.shown_s or event.deadline_s - turn.patience_s))
        waiting = self._work.qsize()
        if (isinstance(event, FrameSeen) and waiting > _BUSY) or (isinstance(event, ViewTaken) and waiting > _LATE):
            return
        self._work.put(lambda view: view.record(event))

    def _view(self) -> None:
        view = MissionView(self._board)
        while (work := self._work.get()) is not None:
            try:
                work(view)
            except Exception as error:  # what cannot be shown must not end the showing of all else
                view.tell(f"The console could not show something: {error}")
