"""Laws of the board: whoever reads late gets the newest of each pane, and every item of a stream once."""

from __future__ import annotations

import json

from hypothesis import given
from hypothesis import strategies as st

from mintpilot.console.board import Board, Cursor
from mintpilot.console.protocol import AttentionPane, LogLine, QuestionPane

STEPS = st.lists(
    st.one_of(
        st.tuples(st.just("put"), st.sampled_from(["question", "pose", "tree"])),
        st.tuples(st.just("append"), st.just("log")),
        st.tuples(st.just("read"), st.integers(0, 1)),
    ),
    max_size=60,
)


@given(STEPS)
def test_every_reader_ends_with_the_newest(steps):
    board, cursors = Board(), (Cursor(), Cursor())
    shown = ({}, {})
    items = ([], [])
    newest, appended = {}, 0

    def read(reader: int) -> bool:
        message = board.news(cursors[reader])
        if message is None:
            return False
        said = json.loads(message)
        if "pane" in said:
            assert said["data"]["n"] >= shown[reader].get(said["pane"], 0)
            shown[reader][said["pane"]] = said["data"]["n"]
        else:
            assert said["from"] == len(items[reader])
            items[reader].extend(int(i["text"]) for i in said["items"])
        return True

    for number, (what, which) in enumerate(steps):
        if what == "put":
            board.put(which, AttentionPane(n=number, to=""))
            newest[which] = number
        elif what == "append":
            board.append("log", LogLine(time_s=0.0, kind="note", text=str(appended)))
            appended += 1
        else:
            read(which)
    for reader in (0, 1):
        while read(reader):
            pass
        assert shown[reader] == newest
        assert items[reader] == list(range(appended))


def test_the_question_comes_before_pictures():
    board = Board()
    board.put("camera", AttentionPane(n=1, to=""), b"jpeg")
    board.put("pose", AttentionPane(n=1, to=""))
    board.put("question", QuestionPane(id="q1"))
    first = board.news(Cursor())
    assert isinstance(first, str)
    assert json.loads(first)["pane"] == "question"


def test_a_picture_is_one_binary_message():
    board = Board()
    board.put("camera", AttentionPane(n=1, to="x"), b"jpeg")
    message = board.news(Cursor())
    assert isinstance(message, bytes)
    size = int.from_bytes(message[:4], "big")
    assert json.loads(message[4 : 4 + size])["pane"] == "camera"
    assert message[4 + size :] == b"jpeg"


def test_a_long_stream_forgets_its_beginning_and_says_so():
    board, cursor = Board(), Cursor()
    for number in range(9000):
        board.append("log", LogLine(time_s=0.0, kind="note", text=str(number)))
    message = board.news(cursor)
    assert isinstance(message, str)
    said = json.loads(message)
    assert said["from"] > 0
    assert said["items"][0]["text"] == str(said["from"])
    assert said["items"][-1]["text"] == "8999"
    assert board.news(cursor) is None
