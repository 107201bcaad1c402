"""All that a page would have shown of a mission, by the mission's clock."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from pydantic import BaseModel

from mintpilot.console.board import Board, Panes, Text, message_of
from mintpilot.console.protocol import LogLine, Moment, PathPane, QuestionPane, ToldPane

_MOMENTS: Final = frozenset({"begun", "question", "answer", "order", "plan", "ended"})
_BLANK: Final[Mapping[str, BaseModel]] = {"question": QuestionPane(), "plan": PathPane(), "told": ToldPane()}
"""What a pane holds before it first came; others show what came first."""


@dataclass(slots=True)
class _Track:
    """One pane or stream: what came in which turn, oldest first."""

    turns: list[int] = field(default_factory=list)
    messages: list[Text] = field(default_factory=list)
    shown: int = -2
    """Which one the board has; -1: the blank one, -2: none."""


class Tape(Panes):
    """Keeps all panes and streams; `show` puts those of one turn on a board.

    A turn is whatever one event of the mission brought: several may have the same time.

    Attributes:
        moments: what is worth going to, oldest first.
    """

    def __init__(self) -> None:
        self.moments: list[Moment] = []
        self._moment_turns: list[int] = []
        self._times_s = [0.0]
        self._panes: dict[str, _Track] = {}
        self._streams: dict[str, _Track] = {}

    @property
    def end_s(self) -> float:
        """When the last turn was, mission clock."""
        return self._times_s[-1]

    def turn(self, time_s: float) -> None:
        """What comes now came then, mission clock, or with the turn before where that was later."""
        self._times_s.append(max(self._times_s[-1], time_s))

    def put(self, name: str, pane: BaseModel, payload: bytes | None = None) -> None:
        """See `Panes.put`."""
        self._keep(self._panes, name, message_of(name, pane, payload))

    def append(self, name: str, item: BaseModel) -> None:
        """See `Panes.append`."""
        self._keep(self._streams, name, item.model_dump_json())
        if isinstance(item, LogLine) and item.kind in _MOMENTS:
            self.moments.append(Moment(time_s=round(self.end_s, 2), kind=item.kind))
            self._moment_turns.append(len(self._times_s) - 1)

    def turn_at(self, time_s: float) -> int:
        """The last turn up to that time, mission clock."""
        return bisect_right(self._times_s, time_s) - 1

    def turn_of(self, moment: int) -> int:
        """The turn that brought that moment, by its index; the last turn where there are fewer."""
        return self._moment_turns[moment] if moment < len(self._moment_turns) else len(self._times_s) - 1

    def time_of(self, turn: int) -> float:
        """When that turn was, mission clock."""
        return self._times_s[turn]

    def passed(self, turn: int) -> tuple[int, bool]:
        """How many moments there were up to a turn, and whether it brought the last of these."""
        count = bisect_right(self._moment_turns, turn)
        return count, count > 0 and self._moment_turns[count - 1] == turn

    def show(self, board: Board, turn: int) -> None:
        """Puts on the board what a page showed after that turn."""
        for name, track in self._panes.items():
            index = bisect_right(track.turns, turn) - 1
            index = 0 if index < 0 and name not in _BLANK else index
            if index != track.shown:
                track.shown = index
                board.put_message(name, track.messages[index] if index >= 0 else message_of(name, _BLANK[name], None))
        for name, track in self._streams.items():
            count = bisect_right(track.turns, turn)
            if count != track.shown:
                track.shown = count
                board.put_stream(name, [str(message) for message in track.messages[:count]])

    def _keep(self, tracks: dict[str, _Track], name: str, message: Text) -> None:
        track = tracks.setdefault(name, _Track())
        track.turns.append(len(self._times_s) - 1)
        track.messages.append(message)
