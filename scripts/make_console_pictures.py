"""Makes the pictures of the web console from one mission: `python scripts/make_console_pictures.py [RUN]`.

Needs MuJoCo and a Chromium that playwright finds. RUN: a folder for the run; kept, and used again where it is there.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.retelling import Watcher, retell, retold
from mintpilot.assembly.talk import Talk
from mintpilot.cli.demos import demo_path
from mintpilot.cli.replaying import kept_pictures
from mintpilot.console import ReplayConsole, WebConsole
from mintpilot.core.events import Event, FactsChanged, FrameSeen
from mintpilot.core.gap import GapKind
from mintpilot.core.observation import Frame
from mintpilot.core.query import Answer, Question, Standing
from mintpilot.core.reading import guarded_replies
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.told import Fact, KeepOut, RegionPassable, RoomSearched, ToldFact
from mintpilot.core.told import Standing as Told
from mintpilot.recording.event_log import read_event_log

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"
WIDE, TALL, NARROW = (1280, 900), (1280, 1180), (360, 900)
WHO = "console:1f6c02ab@127.0.0.1"


class UntilAsked(Watcher):
    """Shows a mission on a page up to its first question: that is left open."""

    def __init__(self, console: WebConsole) -> None:
        self._console = console
        self.asked: Question | None = None

    def record(self, event: Event) -> None:
        """See `Watcher.record`."""
        if self.asked is None:
            self._console.record(event)

    def show(self, question: Question, patience_s: float) -> None:  # noqa: ARG002
        """See `Watcher.show`."""
        if self.asked is None:
            self._console.show(question, 30.0)
            if all(gap.kind is not GapKind.GO for gap in question.gaps):
                self.asked = question

    def withdraw(self, question: str, why: str) -> None:
        """See `Watcher.withdraw`."""
        if self.asked is None:
            self._console.withdraw(question, why)

    def tell(self, text: str) -> None:
        """See `Watcher.tell`."""
        if self.asked is None:
            self._console.tell(text)


def with_pictures(run: Path) -> Iterator[Event]:
    """The events of a run, with those pictures that were kept."""
    for logged in read_event_log(run):
        event = logged.event
        if isinstance(event, FrameSeen):
            file = run / "frames" / f"{event.index:05d}.jpg"
            if not file.is_file():
                continue
            frame: Frame = replace(event.frame, rgb=np.asarray(Image.open(file).convert("RGB")))
            event = replace(event, frame=frame)
        yield event


@contextmanager
def asking(run: Path) -> Iterator[tuple[WebConsole, Question, SemanticMap]]:
    """A page on which the drone asks, its question, and the map that it has then."""
    talk = Talk()
    with WebConsole(understand=talk.understand, order_of=talk.order_of) as console:
        watcher = UntilAsked(console)
        for state in retold(with_pictures(run), watcher):
            if watcher.asked is not None and state.beliefs is not None:
                yield console, watcher.asked, state.beliefs.map
                return
        raise RuntimeError("nothing was asked: take another mission")


@contextmanager
def opened(browser: Browser, url: str, size: tuple[int, int], *, dark: bool = False) -> Iterator[Page]:
    """A page of that size, with everything on it."""
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]},
        color_scheme="dark" if dark else "light",
        reduced_motion="reduce",
        device_scale_factor=1,
    )
    page = context.new_page()
    page.goto(url)
    page.wait_for_selector("#role:not(:empty)")
    page.wait_for_timeout(1500)
    try:
        yield page
    finally:
        context.close()


def keep(page: Page, name: str) -> None:
    """The picture as it will stand in the documents."""
    page.wait_for_timeout(400)
    page.screenshot(path=PICTURES / f"console-{name}.png")
    print(f"console-{name}.png")


def draw(page: Page, places: list[tuple[float, float]], *, ends: bool) -> None:
    """Draws around places on the map, as shares of its width and height."""
    page.click("#draw")
    box = page.locator("#map").bounding_box()
    assert box is not None
    spots = [(box["x"] + u * box["width"], box["y"] + v * box["height"]) for u, v in places]
    page.mouse.move(*spots[0])
    page.mouse.down()
    for x, y in spots[1:]:
        page.mouse.move(x, y, steps=10)
    if ends:
        page.mouse.up()


def while_asking(browser: Browser, run: Path) -> None:
    """The question, its read-back, a telephone, the dark, a second viewer, drawing, and a lost link."""
    with asking(run) as (console, question, map), opened(browser, console.url(), TALL) as page:
        page.hover("#card .answer.yes")
        keep(page, "question")
        page.mouse.move(0, 0)
        with opened(browser, console.url(), WIDE) as second:
            keep(second, "second-viewer")
        frees = min(guarded_replies(question))
        answer = Answer(reply=frees, latency_s=4.0, text=frees.value, by="typed")
        back = replace(question, read_back=replace(answer, standing=Standing.UNCONFIRMED))
        console.show(back, 22.0)
        page.wait_for_selector("#card .understood")
        page.evaluate("() => scrollTo(0, 0)")
        keep(page, "read-back")
        console.show(question, 30.0)
        page.wait_for_selector("#card .answer.silence")
        console.record(FactsChanged(told=page_facts(map)))
        page.wait_for_selector("#back .understood")
        draw(page, [(0.42, 0.2), (0.5, 0.16), (0.56, 0.24), (0.53, 0.36), (0.44, 0.35), (0.415, 0.24)], ends=False)
        page.locator("#place").scroll_into_view_if_needed()
        keep(page, "drawing")
        page.keyboard.press("Escape")
        page.mouse.up()
        console.record(FactsChanged(told=()))
        with opened(browser, console.url(), NARROW) as phone:
            phone.click("#seat")
            phone.wait_for_selector("#role.on")
            keep(phone, "phone")
        with opened(browser, console.url(), TALL, dark=True) as dark:
            dark.click("#seat")
            dark.wait_for_selector("#role.on")
            dark.hover("#card .answer.no")
            keep(dark, "dark")
        page.click("#seat")
        page.wait_for_selector("#role.on")
        page.evaluate("() => scrollTo(0, 0)")
        console.close()
        page.wait_for_selector("#link.lost strong", timeout=20_000)
        keep(page, "link-lost")


def page_facts(map: SemanticMap) -> tuple[ToldFact, ...]:
    """A drawn region that counts, what was taken back of a room, and what is read back of a region."""
    (left, bottom, _), (right, top, _) = map.frame.box.lo_m, map.frame.box.hi_m
    shares = ((0.62, 0.1), (0.8, 0.1), (0.83, 0.3), (0.66, 0.33))
    corners = tuple((left + u * (right - left), bottom + v * (top - bottom)) for u, v in shares)
    made: list[tuple[Fact, str, Told]] = [(KeepOut(corners_m=corners), "", Told.COUNTS)]
    made += [(RoomSearched(room=one.id), one.description, Told.UNDONE) for one in map.rooms[:1]]
    made += [(RegionPassable(region=one.id), one.description, Told.READ_BACK) for one in map.regions[:1]]
    return tuple(
        ToldFact(id=f"told-{n}", fact=fact, words=words, operator=WHO, told_s=40.0 + n, standing=standing)
        for n, (fact, words, standing) in enumerate(made)
    )


def replayed(browser: Browser, run: Path) -> None:
    """A moment of the flight, afterwards."""
    with ReplayConsole(jpeg_of=kept_pictures(run)) as console:
        retell(run, console)
        console.serve()
        with opened(browser, console.url, WIDE) as page:
            end_s = float(page.get_attribute("#moment", "max") or 0.0)
            page.evaluate("""share => { const m = document.querySelector("#moment"); m.value = share * m.max;
                m.dispatchEvent(new Event("change")); }""", 1 - 6.0 / end_s)  # fmt: skip
            page.wait_for_timeout(1000)
            keep(page, "replay")


def main(run: Path) -> None:
    """Flies the mission where there is none yet, and makes all pictures."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    if not run.exists():
        run_mission(demo_path("fire-warehouse"), seed=5, out=run)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        while_asking(browser, run)
        replayed(browser, run)
        browser.close()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(Path(folder) / "run")
