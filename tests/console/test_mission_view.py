"""What the panes of a mission say."""

from __future__ import annotations

import json

import pytest
from tests.mission.scenes import hall

from mintpilot import run_mission
from mintpilot.cli.demos import demo_path
from mintpilot.console.board import Board, Cursor, Panes
from mintpilot.console.mission_view import MissionView
from mintpilot.core.events import QuestionTimed
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Reply
from mintpilot.interaction.scripted import RecordedOperator

from .pages import ASKED


def panes(board: Board) -> dict[str, dict[str, object]]:
    """The newest of each pane, without pictures."""
    cursor, found = Cursor(), {}
    while (message := board.news(cursor)) is not None:
        head = message if isinstance(message, str) else message[4 : 4 + int.from_bytes(message[:4], "big")]
        read = json.loads(head)
        if "pane" in read:
            found[read["pane"]] = read["data"]
    return found


def question(board: Board) -> dict[str, object]:
    return panes(board)["question"]


class Collected(Panes):
    """Keeps all that is shown."""

    def __init__(self) -> None:
        self.panes: dict[str, list[object]] = {}

    def put(self, name, pane, payload=None):  # type: ignore[no-untyped-def]
        self.panes.setdefault(name, []).append(pane)

    def append(self, name, item):  # type: ignore[no-untyped-def]
        self.panes.setdefault(name, []).append(item)


class Asks(RecordedOperator):
    """Shows its questions on a page, too."""

    def __init__(self, view: MissionView, replies: list[Reply]) -> None:
        super().__init__(replies)
        self._view = view

    def show(self, question, patience_s):  # type: ignore[no-untyped-def]
        self._view.show(question, patience_s)
        super().show(question, patience_s)


def test_things_are_called_as_in_questions_and_in_the_missions_language() -> None:
    view = MissionView(shown := Collected())
    asks = Asks(view, [Reply.NO])
    run_mission(demo_path("fire-warehouse"), vehicle="kinematic", lang="de", operator=asks, progress=view.record)
    regions = [region.words for region in shown.panes["map"][-1].regions]
    rooms = [thing.words for thing in shown.panes["map"][-1].things if thing.label == "room"]
    assert regions == ["der Rauch beim Regal"]
    assert rooms == ["der geschlossene Raum bei der Kiste"]
    undone = {name for card in shown.panes["question"] for one in card.consequences for name in one.undone}
    assert undone == set(rooms)


@pytest.mark.parametrize("think", [0.0, 20.0])
def test_a_step_is_done_when_its_stop_is_also_while_a_question_is_open(think: float) -> None:
    view = MissionView(shown := Collected())
    record = run_mission(demo_path("fire-warehouse"), vehicle="kinematic", think=think, progress=view.record)
    assert record.outcome is Outcome.SUCCESS
    first, *_ = shown.panes["steps"][-1].steps
    assert (first.text, first.state) == ("go to the injured person in the burning warehouse", "done")


def test_a_gap_counts_as_asked_about_as_soon_as_its_question_is_put() -> None:
    view = MissionView(shown := Collected())
    run_mission(hall(), vehicle="kinematic", operator=Asks(view, [Reply.NO]), progress=view.record)
    before_answer = next(pane for pane in shown.panes["tree"] if any(gap.asked for gap in pane.gaps))
    assert not before_answer.answers


def test_the_countdown_follows_the_question() -> None:
    board = Board()
    view = MissionView(board)
    view.record(QuestionTimed(question="q1", deadline_s=12.0, extended=False))
    view.show(ASKED, 30.0)
    assert (question(board)["deadline_s"], question(board)["extended"]) == (12.0, False)
    view.record(QuestionTimed(question="q1", deadline_s=19.5, extended=True))
    assert (question(board)["deadline_s"], question(board)["extended"]) == (19.5, True)
    view.record(QuestionTimed(question="q7", deadline_s=99.0, extended=False))
    assert question(board)["deadline_s"] == 19.5
