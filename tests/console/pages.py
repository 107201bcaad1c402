"""A console with a page on it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from urllib.parse import urlsplit

from tests.language.questions import BOX, ROOM, SMOKE

from mintpilot.assembly.talk import Talk
from mintpilot.console import Role, WebConsole
from mintpilot.core.inputs import OperatorInput
from mintpilot.core.query import Question

ASKED: Question = replace(SMOKE, id="q1")
SECOND: Question = replace(ROOM, id="q2")
WHICH: Question = replace(BOX, id="q3")


@dataclass
class Watched:
    """One page, with what it asked for and what it complained of."""

    page: object
    requests: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)


def console() -> WebConsole:
    talk = Talk()
    return WebConsole(understand=talk.understand, order_of=talk.order_of)


@contextmanager
def opened(browser, url: str, *, before: Callable[[object], None] | None = None, **options) -> Iterator[Watched]:
    options.setdefault("viewport", {"width": 1280, "height": 900})
    context = browser.new_context(**options)
    page = context.new_page()
    seen = Watched(page)
    context.on("request", lambda request: seen.requests.append(request.url))
    page.on("websocket", lambda link: seen.requests.append(link.url))
    page.on("pageerror", lambda error: seen.errors.append(str(error)))
    page.on("console", lambda said: seen.errors.append(said.text) if said.type == "error" else None)
    page.set_default_timeout(10_000)
    if before is not None:
        before(page)
    try:
        page.goto(url)
        yield seen
    finally:
        context.close()


def poll_until(one: WebConsole, page, fits: Callable[[OperatorInput], bool], time_s: float = 1.0, most_s: float = 15.0):
    """The first input that fits; the page goes on meanwhile."""
    end = time.monotonic() + most_s
    while time.monotonic() < end:
        for event in one.poll(time_s):
            if fits(event):
                return event
        page.wait_for_timeout(20)
    raise AssertionError("nothing of that kind came")


def ready(page) -> None:
    """Waits until the card takes answers: what was pressed just before it appeared does not count."""
    page.wait_for_selector("#card .answer:not(:disabled)")
    page.wait_for_timeout(650)


def stays_here(seen: Watched, one: WebConsole) -> bool:
    here = urlsplit(one.url(Role.WATCH)).netloc
    return all(urlsplit(url).netloc == here for url in seen.requests)
