"""What a person sees while a mission runs, on standard error: a moving line on a terminal, plain lines elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.text import Text

from mintpilot.core.events import (
    Asked,
    Deliberated,
    Event,
    FrameSeen,
    LegFlown,
    MapUpdated,
    MissionEnded,
    MissionStarted,
    Noticed,
    OrderTaken,
    PlanChosen,
)
from mintpilot.core.inputs import OperatorInput
from mintpilot.core.ports import Operator
from mintpilot.core.query import Question


class LenientConsole(Console):
    """Goes silent when its reader goes away, instead of ending the program: a mission may be in the air."""

    def on_broken_pipe(self) -> None:
        """Nothing more is written."""
        self.quiet = True


class Narrator:
    """Tells what happens, one event after the other; use it as a context manager.

    On a terminal the stage that is going on is a moving line; it rests while the person is asked.
    """

    def __init__(self, console: Console) -> None:
        self._console = console
        self._bar: Progress | None = None
        self._stage = "preparing"
        if console.is_terminal:
            self._bar = Progress(
                SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn(), console=console, transient=True
            )
        self._pictures = 0
        self._stops: dict[str, str] = {}
        self.noticed = ""
        """What was noticed last, in words."""

    def __enter__(self) -> Self:
        self._go_on(self._stage)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.rest()

    def __call__(self, event: Event) -> None:
        """Tells one event."""
        if isinstance(event, FrameSeen):
            self._pictures += 1
            self._go_on(f"{self._stage} ({self._pictures} pictures)")
            return
        if isinstance(event, Noticed):
            self.noticed = event.text
        if isinstance(event, PlanChosen) and event.plan is not None:
            self._stops |= {leg.stop.id: leg.stop.text for leg in event.plan.legs}
        line, stage = told(event, self._stops)
        if line:
            self._say(line)
        if stage:
            self._stage = stage
            self._go_on(stage)

    def rest(self) -> None:
        """Takes the moving line away; the next stage brings it back."""
        if self._bar is not None:
            self._bar.stop()
            for task in list(self._bar.task_ids):
                self._bar.remove_task(task)

    def _go_on(self, stage: str) -> None:
        if self._bar is None:
            return
        if not self._bar.task_ids:
            self._bar.add_task(stage, total=None)
            self._bar.start()
        self._bar.update(self._bar.task_ids[0], description=stage)

    def _say(self, line: str) -> None:
        with suppress(OSError):  # a full disk behind a log must not end a flight
            self._console.print(Text("".join(c if c.isprintable() else " " for c in line)), soft_wrap=True)


class Attended(Operator):
    """An operator at the same terminal: the moving line rests while the person is asked, and comes back afterwards."""

    def __init__(self, operator: Operator, narrator: Narrator) -> None:
        self._operator = operator
        self._narrator = narrator

    @property
    def attended(self) -> bool:
        """As the operator inside."""
        return self._operator.attended

    @property
    def hears_once(self) -> bool:
        """As the operator inside."""
        return self._operator.hears_once

    def show(self, question: Question, patience_s: float) -> None:
        """As the operator inside."""
        self._narrator.rest()
        self._operator.show(question, patience_s)

    def withdraw(self, question: str, why: str) -> None:
        """As the operator inside."""
        self._narrator.rest()
        self._operator.withdraw(question, why)

    def tell(self, text: str) -> None:
        """As the operator inside; what the narrator has just said on the same screen is not said again."""
        self._narrator.rest()
        if text != self._narrator.noticed:
            self._operator.tell(text)

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """As the operator inside."""
        return self._operator.poll(time_s)


def told(event: Event, stops: Mapping[str, str] | None = None) -> tuple[str, str]:
    """The line that an event is worth, and the stage that begins with it; either may be empty.

    Args:
        event: what happened.
        stops: what is done at each stop, by its id.
    """
    if isinstance(event, MissionStarted):
        return f"Mission '{event.mission.name}': {event.mission.instruction}", "looking around"
    if isinstance(event, MapUpdated):
        known = event.map
        found = ", ".join(
            _count(len(things), noun)
            for things, noun in ((known.objects, "object"), (known.regions, "region"), (known.rooms, "room"))
        )
        return f"Map ({event.why}): {found}.", "thinking"
    if isinstance(event, Deliberated):
        if event.chosen is None:
            return (
                f"Thought {event.seconds:.2f} s about {_count(len(event.gaps), 'knowledge gap')}: nothing to ask.",
                "",
            )
        worth = f"the best question is worth {event.chosen.gain_bits:.2f} bits"
        return f"Thought {event.seconds:.2f} s about {_count(len(event.gaps), 'knowledge gap')}: {worth}.", ""
    if isinstance(event, Asked):
        return f"Asked: {event.question.text} Answer: {_said(event)}.", "thinking"
    if isinstance(event, PlanChosen):
        if event.plan is None:
            return "No plan that is known to be safe.", "staying safe"
        return f"Plan: {event.plan.length_m:.1f} m, {event.plan.cost_s:.0f} s.", "flying"
    if isinstance(event, LegFlown) and event.phase == "survey":
        return "", "surveying"
    if isinstance(event, LegFlown):
        where = "back to the start" if event.phase == "return" else (stops or {}).get(event.stop_id, "")
        return f"Flown ({event.phase}): {f'{where}, ' if where else ''}{event.log.end.value}.", ""
    if isinstance(event, OrderTaken):
        return f"Order: {event.order.value}. {event.answer}", ""
    if isinstance(event, Noticed):
        return f"Noticed: {event.text}", ""
    if isinstance(event, MissionEnded):
        return f"Ended: {event.verdict.outcome.value}. {event.verdict.reason}", "writing the report"
    return "", ""


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _said(event: Asked) -> str:
    """The reply in a word or two."""
    part = event.answer.part
    return event.answer.reply.value if part is None else event.question.query.part_words(part)
