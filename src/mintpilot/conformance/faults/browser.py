"""The web console with a real browser: slow, killed, flooding, doubled, late, two of them, and one without a right."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from mintpilot.assembly.components import Choices, VehicleChoice, scripted_operator
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World
from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.faulty_operator import FaultyOperator
from mintpilot.conformance.faults.faulty_source import FaultySource
from mintpilot.conformance.faults.faulty_vehicle import FaultyVehicle
from mintpilot.conformance.faults.kinds import Fault, FaultKind
from mintpilot.conformance.faults.ledger import INTRUDER, Ledger
from mintpilot.conformance.faults.stage import Stage
from mintpilot.conformance.faults.telling import Teller
from mintpilot.core.errors import DeviceError
from mintpilot.core.inputs import FactTold
from mintpilot.core.query import Order, Reply
from mintpilot.core.told import Fact, KeepOut, RegionBlocked, RegionPassable, RoomSearched, ThisOne
from mintpilot.mission_file.schema import OperatorSpec

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

    from mintpilot.console import WebConsole

CHROMIUM: Final = Path("/usr/bin/chromium")
FLAGS: Final = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run"]
READY_S: Final = 60.0
LOOK_MS: Final = 150
"""Between two looks at the page, milliseconds."""
THINKS_S: Final = 2.0
"""Longest that the person thinks, seconds."""
BUSY_MS: Final = 4000
"""Longest that a slow page does nothing, milliseconds."""
HELD_S: Final = 10.0
"""After an order, whatever it was, the mission is told to go on, seconds."""
FLOOD: Final = 400
"""Most messages of a flood."""
Command: TypeAlias = dict[str, object]
"""A message to the server, without its number."""

HOOK: Final = """
(() => {
  const Real = window.WebSocket;
  let last = 0, extra = 0;
  window.WebSocket = class extends Real {
    constructor(...given) {
      super(...given);
      window.link = this;
      let heard = null;
      Object.defineProperty(this, "onmessage", { get: () => heard, set: (f) => { heard = f; } });
      this.addEventListener("message", (event) => {
        if (!heard) return;
        let data = event.data;
        if (typeof data === "string" && data.startsWith('{"ack"')) {
          const ack = JSON.parse(data);
          if (ack.ack % 1000) return;
          data = JSON.stringify({ ...ack, ack: ack.ack / 1000 });
        }
        heard({ data });
      });
    }
    send(data) {
      if (typeof data === "string" && data.includes('"n":')) {
        const message = JSON.parse(data);
        if (message.n !== last) { last = message.n; extra = 0; }
        data = JSON.stringify({ ...message, n: message.n * 1000 });
        if (window.twice) super.send(data);
      }
      super.send(data);
    }
    raw(message) { super.send(JSON.stringify({ ...message, n: last * 1000 + Math.min(++extra, 999) })); }
  };
  window.WebSocket.OPEN = Real.OPEN;
})();
"""
"""Numbers the page's messages in thousands, so that others fit between them on the same link."""
RAW: Final = "(all) => { for (const one of all) if (window.link && link.readyState === 1) link.raw(one); }"
ALONE: Final = """([token, browser, all]) => {
  const link = new WebSocket(`ws://${location.host}/live`);
  link.onopen = () => {
    link.send(JSON.stringify({ kind: "hello", token, browser }));
    all.forEach((one, i) => link.send(JSON.stringify({ ...one, n: i + 1 })));
    setTimeout(() => link.close(), 2000);
  };
}"""
"""A link of its own, with any token."""
BUSY: Final = "(ms) => setTimeout(() => { const end = Date.now() + ms; while (Date.now() < end); }, 0)"


@contextmanager
def on_console(draw: Draw, world: World, ledger: Ledger, talk: Talk) -> Iterator[Stage]:
    """The kinematic simulator, and a person at a browser: mission time passes as on the wall."""
    from mintpilot.console import WebConsole

    calm = replace(draw, faults=())
    ledger.on_the_wall = True
    with WebConsole(understand=talk.understand, order_of=talk.order_of) as console:
        person = Person(draw=draw, world=world, ledger=ledger, console=console)
        person.begin()
        try:
            yield Stage(
                choices=Choices(vehicle=VehicleChoice.KINEMATIC),
                operators=(FaultyOperator(console, calm, ledger),),
                recorders=(console,),
                beset=lambda made: replace(
                    made,
                    vehicle=FaultyVehicle(made.vehicle, calm, ledger),
                    map_source=FaultySource(made.map_source, calm, ledger),
                ),
            )
        finally:
            person.end()


@dataclass(slots=True)
class Person:
    """Somebody at a browser, in a thread of its own, who knows the truth and answers by the page's buttons."""

    draw: Draw
    world: World
    ledger: Ledger
    console: WebConsole
    _over: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None
    _done: set[tuple[str, bool]] = field(default_factory=set)
    """Questions, and read-backs, that were answered."""
    _once: set[FaultKind] = field(default_factory=set)
    _failed: str = ""
    _ordered_s: float = math.inf

    def begin(self) -> None:
        """Opens the browser. Raises `DeviceError` where it does not come."""
        self._thread = threading.Thread(target=self._sit, name="mintpilot faults browser", daemon=True)
        self._thread.start()
        if not self.console.wait_for_somebody(READY_S):
            raise DeviceError(f"no browser came within {READY_S:g} s: {self._failed}")

    def end(self) -> None:
        """Closes it."""
        self._over.set()
        if self._thread is not None:
            self._thread.join(timeout=20.0)

    def _sit(self) -> None:
        from playwright.sync_api import Error, sync_playwright

        try:
            with sync_playwright() as playwright:
                browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
                page: Page | None = self._opened(browser)
                while not self._over.is_set():
                    with suppress(Error):  # a page that is slow or gone is what is tried out
                        page = self._look(browser, page)
                    self._over.wait(LOOK_MS / 1000)
                browser.close()
        except Exception as error:  # told by whoever waits for the browser
            self._failed = str(error)

    def _opened(self, browser: Browser) -> Page:
        page = browser.new_context().new_page()
        page.add_init_script(HOOK)
        page.goto(self.console.url(), timeout=READY_S * 1000)
        page.set_default_timeout(2000)
        return page

    def _look(self, browser: Browser, page: Page | None) -> Page | None:
        """Answers what is asked, and does what goes wrong now."""
        killed = self._on(FaultKind.TAB_KILLED)
        if killed is not None:
            if page is not None:
                page.context.close()
            return None
        if page is None:
            page = self._opened(browser)
        page.evaluate("(on) => { window.twice = on; }", self._on(FaultKind.DOUBLED) is not None)
        slow = self._on(FaultKind.CLIENT_SLOW)
        if slow is not None:
            page.evaluate(BUSY, BUSY_MS * slow.size)
        self._misuse(browser, page)
        self._answer(page)
        return page

    def _misuse(self, browser: Browser, page: Page) -> None:
        rng = np.random.default_rng([self.draw.number, 19, round(self.ledger.now_s * 10)])
        if self._on(FaultKind.LATE) is not None:
            late: list[Command] = [_reply(name, "yes") for name in self.ledger.withdrawn]
            page.evaluate(RAW, late)
        if self._on(FaultKind.TOLD) is not None:
            page.evaluate(RAW, _told(self.draw, self.ledger, rng))
        if self._first(FaultKind.FLOODING) is not None:
            page.evaluate(RAW, _flood(self.ledger, rng))
        ordering = self._on(FaultKind.ORDERS)
        if ordering is not None and (self._first(FaultKind.ORDERS) is not None or rng.random() < 0.02):
            orders = [order for order in Order if order is not Order.CONTINUE]
            page.evaluate(RAW, [{"kind": "order", "order": orders[int(rng.integers(len(orders)))].value}])
            self._ordered_s = self.ledger.now_s
        if self.ledger.now_s > self._ordered_s + HELD_S:  # to hold is meant for half an hour
            page.evaluate(RAW, [{"kind": "order", "order": Order.CONTINUE.value}])
            self._ordered_s = math.inf
        if self._on(FaultKind.SECOND) is not None:
            self._second(browser)
        if self._on(FaultKind.WRONG_TOKEN) is not None:
            self._intrude(page)

    def _second(self, browser: Browser) -> None:
        """Somebody else takes the seat over, and says the opposite of what is true."""
        open_ = [name for name in self.ledger.shown if name not in self.ledger.withdrawn]
        if not open_:
            return
        other = self._opened(browser)
        try:
            reply = "no" if self._truth(open_[-1]) is Reply.YES else "yes"
            confirms = self.ledger.shown[open_[-1]].question.read_back is not None
            other.wait_for_selector("#role")
            other.wait_for_timeout(300)
            other.evaluate(RAW, [{"kind": "take-seat"}, {**_reply(open_[-1], reply), "confirms": confirms}])
            other.wait_for_timeout(300)
            other.evaluate(RAW, [{"kind": "leave-seat"}])
        finally:
            other.context.close()

    def _intrude(self, page: Page) -> None:
        """Links with no right: a token that was made up, one that was cut, one that may only watch."""
        from mintpilot.console import Role

        answers, watches = (self.console.url(role).partition("#")[2] for role in (Role.ANSWER, Role.WATCH))
        all_: list[Command] = [{"kind": "take-seat"}, {"kind": "order", "order": "abort"}]
        all_ += [_reply(name, "yes") for name in self.ledger.shown]
        all_ += [{"kind": "tell", "fact": "passable", "subject": region.id} for region in self.world.map.regions]
        for n, token in enumerate(("", "a" * len(answers), answers[:-1], watches, answers.swapcase())):
            if token != answers:
                page.evaluate(ALONE, [token, f"{INTRUDER}{n}", all_])

    def _answer(self, page: Page) -> None:
        """Presses the true answer's button, once for each question and each read-back."""
        open_ = [name for name in self.ledger.shown if name not in self.ledger.withdrawn]
        if not open_:
            return
        shown = self.ledger.shown[open_[-1]]
        key = (open_[-1], shown.question.read_back is not None)
        if key in self._done or self.ledger.now_s < shown.time_s + THINKS_S * (self.draw.number % 5) / 4:
            return
        reply = Reply.YES if key[1] else self._truth(open_[-1])
        page.click(f"#card .answer.{reply.value}:not(:disabled)", timeout=500)
        self._done.add(key)

    def _truth(self, name: str) -> Reply:
        knows = scripted_operator(self.world, OperatorSpec())
        reply = knows.answer(self.ledger.shown[name].question, 60.0).reply
        return reply if reply in (Reply.YES, Reply.NO) else Reply.UNSURE

    def _on(self, kind: FaultKind) -> Fault | None:
        fault = self.draw.first(kind)
        return fault if fault is not None and fault.is_on(self.ledger.now_s) else None

    def _first(self, kind: FaultKind) -> Fault | None:
        """The fault, the first time that it is on."""
        fault = self._on(kind)
        if fault is None or kind in self._once:
            return None
        self._once.add(kind)
        return fault


def _reply(question: str, reply: str) -> Command:
    return {"kind": "reply", "question": question, "reply": reply}


def _told(draw: Draw, ledger: Ledger, rng: np.random.Generator) -> list[Command]:
    """As `Teller` tells it, in the page's messages."""
    messages: list[Command] = []
    for event in Teller(replace(draw, number=int(rng.integers(1 << 30))), ledger).tells(0.0):
        if isinstance(event, FactTold):
            messages.append(_fact(event.fact))
        else:
            messages.append({"kind": "confirm" if type(event).__name__ == "FactConfirmed" else "undo", **_named(event)})
    return messages


def _named(event: object) -> Command:
    return {"told": getattr(event, "told", "")}


def _fact(fact: Fact) -> Command:
    match fact:
        case KeepOut(corners_m=corners):
            return {"kind": "keep-out", "corners": [list(corner) for corner in corners]}
        case RegionPassable(region=name):
            return {"kind": "tell", "fact": "passable", "subject": name}
        case RegionBlocked(region=name):
            return {"kind": "tell", "fact": "blocked", "subject": name}
        case RoomSearched(room=name):
            return {"kind": "tell", "fact": "searched", "subject": name}
        case ThisOne(thing=name):
            return {"kind": "tell", "fact": "this-one", "subject": name}


def _flood(ledger: Ledger, rng: np.random.Generator) -> list[Command]:
    """More than anybody says, an order among it, and what is no message at all."""
    names = [*ledger.shown, "q0", ""]
    messages: list[Command] = []
    for _ in range(int(rng.integers(50, FLOOD))):
        name = names[int(rng.integers(len(names)))]
        kinds: tuple[Command, ...] = (
            _reply(name, "unsure"),
            {"kind": "seen", "question": name},
            {"kind": "more-time", "question": name},
            {"kind": "say", "question": name, "text": "x" * int(rng.integers(1, 600))},
            {"kind": "order", "order": "continue"},
            {"kind": ["seen"], "question": {"a": [1] * 50}},
        )
        messages.append(kinds[int(rng.integers(len(kinds)))])
    return messages
