"""Recorded missions on the page."""

from __future__ import annotations

import json
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from mintpilot import run_mission
from mintpilot.assembly.retelling import retell
from mintpilot.cli.demos import demo_path
from mintpilot.console import ReplayConsole
from mintpilot.console.access import Role
from mintpilot.console.board import Board, Cursor
from mintpilot.console.desk import Client, Desk
from mintpilot.console.mission_view import MissionView
from mintpilot.console.protocol import MoreTime, Ordering, Playing, Seek, TakeSeat
from mintpilot.console.tape import Tape
from mintpilot.core.events import Event, MissionStarted, Stepped, Timed
from mintpilot.core.query import Order
from mintpilot.recording.event_log import EVENTS_FILE

from .pages import opened
from .test_browser import axe


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Event]]:
    out, events = tmp_path_factory.mktemp("runs") / "run", []
    run_mission(demo_path("fire-warehouse"), vehicle="kinematic", out=out, progress=events.append)
    return out, events


class Told:
    def __init__(self) -> None:
        self.events: list[Event] = []
        self.said: list[str] = []
        self.open: list[str] = []

    def record(self, event: Event) -> None:
        self.events.append(event)

    def show(self, question, patience_s: float) -> None:
        self.open.append(question.id)

    def withdraw(self, question: str, why: str) -> None:
        self.open = [name for name in self.open if name != question]

    def tell(self, text: str) -> None:
        self.said.append(text)


@pytest.mark.long
def test_a_run_is_told_again_as_it_was(flown) -> None:
    run, events = flown
    told = Told()
    assert retell(run, told) == ""
    kinds = [[type(event).__name__ for event in one if not isinstance(event, Timed)] for one in (told.events, events)]
    assert kinds[0] == kinds[1]
    assert told.open == []


def test_a_run_that_was_broken_off_is_told_as_far_as_it_goes(flown, tmp_path: Path) -> None:
    run, events = flown
    lines = (run / EVENTS_FILE).read_bytes().splitlines(keepends=True)
    (tmp_path / EVENTS_FILE).write_bytes(b"".join(lines[: len(lines) // 2]) + lines[len(lines) // 2][:40])
    told = Told()
    assert "the log ends after event" in retell(tmp_path, told)
    assert isinstance(told.events[0], MissionStarted)
    assert 10 < len([e for e in told.events if isinstance(e, Stepped)]) < len(events)


@pytest.mark.long
def test_each_moment_is_what_a_page_showed_then(flown) -> None:
    """What the tape shows after a turn, in any order, against a board that saw the mission up to that turn."""
    run, _ = flown
    tape = Tape()
    told = _Taped(tape)
    retell(run, told)
    board, cursor = Board(), Cursor()
    shown: dict[str, object] = {}
    for turn in (told.turns, told.turns // 3, told.turns // 2, 20, told.turns - 5):
        tape.show(board, turn)
        shown |= _messages(board, cursor)
        live = Board()
        retell(run, _Taped(live, turn))
        wanted = _messages(live, Cursor())
        assert len(wanted["log"]) > 0
        for name in wanted:
            if name == "log":
                assert _messages(board, Cursor())["log"] == wanted["log"]
            elif name != "flown":
                assert shown[name] == wanted[name], (turn, name)


class _Taped(Told):
    """A view on a tape, or on a board that sees nothing after a turn."""

    def __init__(self, board: Tape | Board, until: int = 10**9) -> None:
        self.board, self.until, self.turns = board, until, 0
        self.view = MissionView(board, lambda event: None)

    def _goes_on(self, time_s: float = 0.0) -> bool:
        self.turns += 1
        if isinstance(self.board, Tape):
            self.board.turn(time_s)
        return self.turns <= self.until

    def record(self, event: Event) -> None:
        if self._goes_on(event.input.time_s if isinstance(event, Stepped) else 0.0):
            self.view.record(event)

    def show(self, question, patience_s: float) -> None:
        if self._goes_on():
            self.view.show(question, patience_s)

    def withdraw(self, question: str, why: str) -> None:
        if self._goes_on():
            self.view.withdraw(question, why)

    def tell(self, text: str) -> None:
        if self._goes_on():
            self.view.tell(text)


def _messages(board: Board, cursor: Cursor) -> dict[str, object]:
    found: dict[str, object] = {}
    while (message := board.news(cursor)) is not None:
        if isinstance(message, bytes):
            continue
        read = json.loads(message)
        found[read.get("pane") or read["stream"]] = read["data"] if "pane" in read else read["items"]
    return found


def test_going_back_shortens_streams_for_browsers_that_have_more() -> None:
    board, cursor = Board(), Cursor()
    board.put_stream("log", ['{"a":1}', '{"a":2}', '{"a":3}'])
    assert board.news(cursor) == '{"stream":"log","from":0,"items":[{"a":1},{"a":2},{"a":3}]}'
    board.put_stream("log", ['{"a":1}'])
    assert board.news(cursor) == '{"stream":"log","from":1,"items":[]}'
    assert board.news(cursor) is None
    board.put_stream("log", ['{"a":1}', '{"a":2}'])
    assert board.news(cursor) == '{"stream":"log","from":1,"items":[{"a":2}]}'


def test_nothing_is_answered_or_ordered_beside_a_recorded_mission() -> None:
    replayed, flying = Desk(replays=True), Desk()
    client = Client(browser="aaaaaaaa", role=Role.ANSWER, address="")
    for desk in (replayed, flying):
        desk.enter(client)
    commands = (Ordering(n=1, order=Order.ABORT), MoreTime(n=1, question="q1"), TakeSeat(n=1))
    assert [replayed.take(client, command) for command in commands] == [False, False, False]
    assert not replayed.seat(client).may_answer
    assert replayed.take(client, Seek(n=2, time_s=3.0))
    assert [asked.command for asked in replayed.collect()] == [Seek(n=2, time_s=3.0)]
    assert [flying.take(client, one) for one in (Seek(n=1, time_s=1.0), Playing(n=1, speed=1.0))] == [False, False]


@pytest.mark.long
@pytest.mark.xdist_group("browser")
def test_the_scrubber_shows_any_moment(browser, flown) -> None:
    run, _ = flown
    with ReplayConsole(jpeg_of=lambda event: None) as one:
        retell(run, one)
        one.serve()
        with opened(browser, one.url) as seen:
            page = seen.page
            page.wait_for_selector("#replay:not([hidden])")
            assert page.is_hidden("#orders")
            assert page.is_hidden("#say")
            for _ in range(30):
                page.click("#on-to")
                page.wait_for_timeout(150)
                if page.is_visible("#card .text"):
                    break
            assert page.inner_text("#card .text")
            assert page.locator("#card .answer:not(.silence):not(:disabled)").count() == 0
            assert axe(page) == []
            lines = page.locator("#log li").count()
            page.evaluate("() => { const m = document.querySelector('#moment'); m.value = m.max; "
                          "m.dispatchEvent(new Event('change')); }")  # fmt: skip
            page.wait_for_selector(".verdict")
            assert page.locator("#log li").count() > lines
            page.click("#back-to")
            page.wait_for_selector(".verdict", state="detached")
            page.select_option("#speed", "16")
            page.click("#play")
            page.wait_for_selector(".verdict")
            assert seen.errors == []
            assert all(urlsplit(url).netloc == urlsplit(one.url).netloc for url in seen.requests)
