"""What the person tells on the map of their own accord."""

from __future__ import annotations

import pytest

from mintpilot import run_mission
from mintpilot.cli.demos import demo_path
from mintpilot.console import Role
from mintpilot.console.access import Role as AccessRole
from mintpilot.console.answering import Answering
from mintpilot.console.desk import Asked, Client, Desk
from mintpilot.console.protocol import COMMANDS, Confirmed, Drew, TookBack
from mintpilot.core.events import FactsChanged
from mintpilot.core.inputs import FactConfirmed, FactTold, FactUndone
from mintpilot.core.told import KeepOut, RegionBlocked, RegionPassable, RoomSearched, Standing, ThisOne, ToldFact

from .pages import console, opened, poll_until, stays_here
from .test_browser import axe

PLANTED = "<img src=x onerror=\"document.title='owned'\">"


def fact(number: int, what, standing: Standing, words: str = "the grey smoke") -> ToldFact:
    return ToldFact(
        id=f"told-{number}", fact=what, words=words, operator="console:ab@127.0.0.1", told_s=3.0, standing=standing
    )


@pytest.mark.parametrize(
    "text",
    [
        '{"n":1,"kind":"keep-out","corners":[[0,0],[1,1]]}',
        '{"n":1,"kind":"keep-out","corners":[[0,0],[1,1],[NaN,2]]}',
        '{"n":1,"kind":"keep-out","corners":[[0,0],[1,1],[1e9,2]]}',
        '{"n":1,"kind":"keep-out","corners":' + str([[i, 0] for i in range(65)]) + "}",
        '{"n":1,"kind":"tell","fact":"free","subject":"smoke-1"}',
        '{"n":1,"kind":"tell","fact":"passable","subject":"' + "x" * 121 + '"}',
        '{"n":1,"kind":"confirm"}',
    ],
)
def test_what_is_no_command_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="validation error"):
        COMMANDS.validate_json(text)


def test_commands_come_to_facts_with_their_author() -> None:
    answering = Answering(lambda *_args, **_kwargs: None)
    try:
        said = [
            ('{"n":1,"kind":"keep-out","corners":[[0,0],[1,0],[1,1]]}', KeepOut(corners_m=((0, 0), (1, 0), (1, 1)))),
            ('{"n":1,"kind":"tell","fact":"blocked","subject":"a"}', RegionBlocked(region="a")),
            ('{"n":1,"kind":"tell","fact":"passable","subject":"a"}', RegionPassable(region="a")),
            ('{"n":1,"kind":"tell","fact":"searched","subject":"a"}', RoomSearched(room="a")),
            ('{"n":1,"kind":"tell","fact":"this-one","subject":"a"}', ThisOne(thing="a")),
        ]
        for text, meant in said:
            heard = answering.hear(Asked(command=COMMANDS.validate_json(text), who="me"), 2.0)
            assert heard.events == (FactTold(time_s=2.0, fact=meant, operator="me"),)
        for command, event in (
            (Confirmed(n=1, told="told-1"), FactConfirmed(time_s=2.0, told="told-1", operator="me")),
            (TookBack(n=1, told="told-1"), FactUndone(time_s=2.0, told="told-1", operator="me")),
        ):
            assert answering.hear(Asked(command=command, who="me"), 2.0).events == (event,)
    finally:
        answering.close()


def test_only_who_answers_may_tell() -> None:
    desk = Desk()
    seated, second = (Client(browser=name, role=AccessRole.ANSWER, address="") for name in ("aaaaaaaa", "bbbbbbbb"))
    watching = Client(browser="cccccccc", role=AccessRole.WATCH, address="")
    for one in (seated, second, watching):
        desk.enter(one)
    drew = Drew(n=1, corners=((0, 0), (1, 0), (1, 1)))
    assert [desk.take(one, drew) for one in (seated, second, watching)] == [True, False, False]


@pytest.mark.long
@pytest.mark.xdist_group("browser")
def test_a_region_is_drawn_told_of_confirmed_and_undone(browser):
    with console() as one:
        run_mission(demo_path("fire-warehouse"), vehicle="kinematic", progress=one.record)
        with opened(browser, one.url()) as seen:
            page = seen.page
            page.wait_for_selector("#knowns li button:not(:disabled)", state="attached")
            page.click("#draw")
            box = page.locator("#map").bounding_box()
            places = [(0.3, 0.3), (0.5, 0.3), (0.5, 0.6), (0.3, 0.6)]
            spots = [(box["x"] + u * box["width"], box["y"] + v * box["height"]) for u, v in places]
            page.mouse.move(*spots[0])
            page.mouse.down()
            for x, y in spots[1:]:
                page.mouse.move(x, y, steps=8)
            page.mouse.up()
            told = poll_until(one, page, lambda e: isinstance(e, FactTold))
            assert isinstance(told.fact, KeepOut)
            assert told.operator.startswith("console:")
            (x0, x1), (y0, y1) = [(min(v), max(v)) for v in zip(*told.fact.corners_m, strict=True)]
            left, bottom, right, top = page.evaluate("() => JSON.parse(document.querySelector('#map').dataset.box)")
            assert (x1 - x0) / (y1 - y0) == pytest.approx(0.2 * box["width"] / (0.3 * box["height"]), rel=0.05)
            assert left < x0 < x1 < right
            assert bottom < y0 < y1 < top

            page.click("#known summary")
            page.click("#knowns li button >> nth=0")
            chosen = poll_until(one, page, lambda e: isinstance(e, FactTold))
            assert isinstance(chosen.fact, RegionBlocked | RoomSearched)

            one.record(FactsChanged(told=(
                fact(1, told.fact, Standing.COUNTS, ""),
                fact(2, RegionPassable(region="smoke-1"), Standing.READ_BACK, PLANTED),
                fact(3, RoomSearched(room="room-1"), Standing.UNDONE),
            )))  # fmt: skip
            page.wait_for_selector("#back .understood")
            assert PLANTED in page.inner_text("#back")
            assert axe(page) == []
            page.click("#back button >> nth=0")
            assert poll_until(one, page, lambda e: isinstance(e, FactConfirmed)).told == "told-2"
            page.focus("#told button")
            page.keyboard.press("Enter")
            assert poll_until(one, page, lambda e: isinstance(e, FactUndone)).told == "told-1"
            assert page.locator("#told .over").count() == 1
            one.record(FactsChanged(told=(fact(1, told.fact, Standing.UNDO_READ_BACK, ""),)))
            page.wait_for_selector("#back .understood:has-text('counts no longer: Keep out of the drawn region')")
            assert page.locator("#told button").count() == 0, "it is asked once"
            assert "understood" in page.evaluate("() => document.activeElement.className"), (
                "where what was pressed is gone"
            )
            page.dblclick("#back button >> nth=0")
            assert poll_until(one, page, lambda e: isinstance(e, FactConfirmed)).told == "told-1"
            page.wait_for_timeout(300)
            assert not one.poll(1.0), "twice is not sent"
            assert "owned" not in page.title()
            assert seen.errors == []
            assert stays_here(seen, one)


@pytest.mark.slow
@pytest.mark.xdist_group("browser")
def test_a_region_is_drawn_with_keys_before_there_is_a_map_and_not_by_a_viewer(browser):
    with console() as one:
        events = []
        run_mission(demo_path("fire-warehouse"), vehicle="kinematic", progress=events.append)
        one.record(events[0])
        with opened(browser, one.url()) as seen, opened(browser, one.url(Role.WATCH)) as viewer:
            page = seen.page
            page.wait_for_selector("#draw:not(:disabled)")
            page.click("#draw")
            for keys in (["Enter"], ["Shift+ArrowRight", "Enter"], ["Shift+ArrowDown", "Enter", "Enter"]):
                for key in keys:
                    page.keyboard.press(key)
            told = poll_until(one, page, lambda e: isinstance(e, FactTold))
            assert len(told.fact.corners_m) == 3
            assert viewer.page.is_disabled("#draw")
