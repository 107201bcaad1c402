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
from mintpilot.core.message import Message, joined, message, verbatim
from mintpilot.core.ports import Operator
from mintpilot.core.query import Question
from mintpilot.core.trajectory import FlightEnd
from mintpilot.recording.build import speech_of
from mintpilot.recording.words import ORDER_WORDS, OUTCOME_WORDS, REPLY_WORDS
from mintpilot.wording.speech import Speech


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
        self._stage = message("preparing")
        if console.is_terminal:
            self._bar = Progress(
                SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn(), console=console, transient=True
            )
        self._pictures = 0
        self._stops: dict[str, Message] = {}
        self._speech = Speech()
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
            self._go_on(message("{stage} ({count} pictures)", stage=self._stage, count=self._pictures))
            return
        if isinstance(event, MissionStarted):
            self._speech = speech_of(event)
        if isinstance(event, Noticed):
            self.noticed = self._speech(event.text)
        if isinstance(event, PlanChosen) and event.plan is not None:
            self._stops |= {leg.stop.id: leg.stop.text for leg in event.plan.legs}
        line, stage = told(event, self._stops)
        if line:
            self._say(self._speech(line))
        if stage:
            self._stage = stage
            self._go_on(stage)

    def rest(self) -> None:
        """Takes the moving line away; the next stage brings it back."""
        if self._bar is not None:
            self._bar.stop()
            for task in list(self._bar.task_ids):
                self._bar.remove_task(task)

    def _go_on(self, stage: Message) -> None:
        if self._bar is None:
            return
        if not self._bar.task_ids:
            self._bar.add_task(self._speech(stage), total=None)
            self._bar.start()
        self._bar.update(self._bar.task_ids[0], description=self._speech(stage))

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


def told(event: Event, stops: Mapping[str, Message] | None = None) -> tuple[Message, Message]:
    """The line that an event is worth, and the stage that begins with it; either may be empty.

    Args:
        event: what happened.
        stops: what is done at each stop, by its id.
    """
    if isinstance(event, MissionStarted):
        named = message(
            "Mission '{name}': {instruction}", name=event.mission.name, instruction=event.mission.instruction
        )
        return named, message("looking around")
    if isinstance(event, MapUpdated):
        known = event.map
        seen = message(
            "Map: {objects} × object, {regions} × region, {rooms} × room.",
            objects=len(known.objects),
            regions=len(known.regions),
            rooms=len(known.rooms),
        )
        return seen, message("thinking")
    if isinstance(event, Deliberated):
        chosen = event.chosen
        worth = (
            message("nothing to ask")
            if chosen is None
            else message("the best question is worth {gain_bits:.2f} bits", gain_bits=chosen.gain_bits)
        )
        thought = message(
            "Thought {seconds:.2f} s about knowledge gaps ({count}): {worth}.",
            seconds=event.seconds,
            count=len(event.gaps),
            worth=worth,
        )
        return thought, Message()
    if isinstance(event, Asked):
        asked = message("Asked: {question} Answer: {answer}.", question=event.question.text, answer=_said(event))
        return asked, message("thinking")
    if isinstance(event, PlanChosen):
        if event.plan is None:
            return message("No plan that is known to be safe."), message("staying safe")
        plan = message(
            "Plan: {length_m:.1f} m, {cost_s:.0f} s.", length_m=event.plan.length_m, cost_s=event.plan.cost_s
        )
        return plan, message("flying")
    if isinstance(event, LegFlown) and event.phase == "survey":
        return Message(), message("surveying")
    if isinstance(event, LegFlown):
        home = message("back to the start")
        where = home if event.phase == "return" else (stops or {}).get(event.stop_id, Message())
        return message("Flown: {what}.", what=joined([where, _ENDS[event.log.end]], ", ")), Message()
    if isinstance(event, OrderTaken):
        return message("Order: {order}. {answer}", order=ORDER_WORDS[event.order], answer=event.answer), Message()
    if isinstance(event, Noticed):
        return message("Noticed: {what}", what=event.text), Message()
    if isinstance(event, MissionEnded):
        ended = message(
            "Ended: {outcome}. {why}", outcome=OUTCOME_WORDS[event.verdict.outcome], why=event.verdict.reason
        )
        return ended, message("writing the report")
    return Message(), Message()


_ENDS = {
    FlightEnd.ARRIVED: message("arrived"),
    FlightEnd.INTERRUPTED: message("broken off"),
    FlightEnd.FAILED: message("failed"),
}


def _said(event: Asked) -> Message:
    """The reply in a word or two."""
    answer = event.answer
    if answer.option is not None:
        return verbatim(event.question.query.part_words(answer.option))
    return REPLY_WORDS[answer.reply]
