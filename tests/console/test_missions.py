"""The demo missions, flown and answered on the page."""

from __future__ import annotations

import threading

import pytest

from mintpilot import run_mission
from mintpilot.cli.demos import demo_path
from mintpilot.console import WebConsole
from mintpilot.core.mission import Outcome

from .pages import opened, ready, stays_here

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]


def flown(browser, mission: str, press) -> tuple[object, list[str]]:
    """The record of a mission that is answered by ``press(page, question)``, and the questions."""
    made: list[WebConsole] = []
    ready_to_open, records = threading.Event(), []

    def operator(talk) -> WebConsole:
        made.append(WebConsole(understand=talk.understand, order_of=talk.order_of))
        ready_to_open.set()
        assert made[0].wait_for_somebody(30.0)
        return made[0]

    def fly() -> None:
        records.append(
            run_mission(
                demo_path(mission), vehicle="kinematic", operator=operator, progress=lambda e: made[0].record(e)
            )
        )

    flight = threading.Thread(target=fly)
    flight.start()
    try:
        assert ready_to_open.wait(60.0)
        with opened(browser, made[0].url()) as seen:
            asked: list[str] = []
            while flight.is_alive():
                seen.page.wait_for_timeout(100)
                if seen.page.query_selector("#card .answer:not(:disabled)"):
                    ready(seen.page)
                    asked.append(seen.page.inner_text("#card .text"))
                    press(seen.page, asked[-1])
                    seen.page.wait_for_timeout(400)
            seen.page.wait_for_selector(".verdict")
            assert seen.errors == []
            assert stays_here(seen, made[0])
    finally:
        flight.join(timeout=120)
        made[0].close()
    return records[0], asked


@pytest.mark.parametrize("how", ["clicks", "keys", "words"])
def test_the_warehouse(browser, how):
    def press(page, question: str) -> None:
        read_back = page.query_selector(".understood")
        if how == "clicks":
            page.click("#card .answer.no")
        elif how == "keys":
            page.keyboard.press("n")
        elif read_back:
            page.fill("#words", "yes")
            page.keyboard.press("Enter")
        else:
            page.fill("#words", "it is toxic" if "smoke" in question else "nobody is in there, I am sure of that")
            page.keyboard.press("Enter")

    record, asked = flown(browser, "fire-warehouse", press)
    assert asked
    assert record.outcome is not Outcome.COLLISION


@pytest.mark.parametrize("how", ["clicks", "keys"])
def test_the_boxes(browser, how):
    def press(page, question: str) -> None:
        choice = page.query_selector("#card .answer.option")
        if how == "clicks":
            page.click("#card .answer.option >> nth=0" if choice else "#card .answer.yes")
        else:
            page.keyboard.press("1" if choice else "y")

    _, asked = flown(browser, "medicine", press)
    assert asked
