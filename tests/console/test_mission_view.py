"""What the panes of a mission say."""

from __future__ import annotations

import json

from mintpilot.console.board import Board, Cursor
from mintpilot.console.mission_view import MissionView
from mintpilot.core.events import QuestionTimed

from .pages import ASKED


def question(board: Board) -> dict[str, object]:
    cursor, found = Cursor(), {}
    while (message := board.news(cursor)) is not None:
        if isinstance(message, str) and message.startswith('{"pane":"question"'):
            found = json.loads(message)["data"]
    return found


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
