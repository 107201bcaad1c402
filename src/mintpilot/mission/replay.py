"""A recorded mission, thought through again: every step bit for bit, every deliberation within `TOLERANCE`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from mintpilot.core.difference import first_difference
from mintpilot.core.digest import digest
from mintpilot.core.errors import MintPilotError, RecordError
from mintpilot.core.events import MissionStarted, Stepped
from mintpilot.core.inputs import DeliberationEnded, Input, MissionBegun
from mintpilot.core.query import Query
from mintpilot.core.tree import Mint
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.directives import Deliberate
from mintpilot.mission.requests import Request, decide
from mintpilot.mission.state import MissionState, Setup
from mintpilot.mission.step import initial_state, step

TOLERANCE = 1e-9
"""Numbers of a decision may differ by so much, absolutely or relatively: machines round differently."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """Where the mission went another way."""

    number: int
    """Of the event in the record."""
    event: str
    """What had happened."""
    before: str
    """What had happened before that."""
    what: str
    """What differs, in one line."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verification:
    """What came of thinking it through again."""

    steps: int
    """Steps that were compared."""
    deliberations: int
    """Deliberations that were worked out again."""
    difference: Difference | None
    """The first one; None: all is equal."""


def verify(started: MissionStarted, steps: Iterable[tuple[int, Stepped]], parts: DeliberationParts) -> Verification:
    """Feeds the recorded events to `step` again and compares what it does.

    Args:
        started: the record's first event.
        steps: the recorded steps with their numbers in the record, in order.
        parts: fresh parts of deliberation, as the mission began with. What a language model proposed is taken from the
            record.

    Raises:
        RecordError: the record holds no steps, does not begin with the beginning, or was kept without digests.
    """
    proposer = _Recorded()
    replayed = _Replay(started, replace(parts, proposer=proposer), proposer)
    for number, stepped in steps:
        if not stepped.digest:
            raise RecordError(f"event {number}: the record was kept without digests, so that it cannot be replayed")
        difference = replayed.step(number, stepped)
        if difference is not None:
            return Verification(steps=replayed.steps, deliberations=replayed.deliberations, difference=difference)
    if not replayed.steps:
        raise RecordError("the record holds no step of a mission: there is nothing to verify")
    return Verification(steps=replayed.steps, deliberations=replayed.deliberations, difference=None)


@dataclass(slots=True)
class _Recorded:
    """Proposes what was proposed then."""

    queries: tuple[Query, ...] = ()

    @property
    def name(self) -> str:
        return "recorded"

    def propose(self, mint: Mint) -> tuple[Query, ...]:  # noqa: ARG002
        return self.queries


@dataclass(slots=True)
class _Replay:
    started: MissionStarted
    parts: DeliberationParts
    proposer: _Recorded
    steps: int = 0
    deliberations: int = 0
    _state: MissionState | None = None
    _before: str = "nothing"
    _requests: dict[int, Request] = field(default_factory=dict)

    def step(self, number: int, stepped: Stepped) -> Difference | None:
        """Compares one step; where it differs, says how."""
        event = stepped.input
        if self._state is None:
            if not isinstance(event, MissionBegun):
                raise RecordError(f"event {number}: the steps begin with {type(event).__name__}: the start is missing")
            self._state = initial_state(setup_of(self.started), event.vehicle)
        what = self._thought_again(event) if isinstance(event, DeliberationEnded) else ""
        if not what:
            self._state, directives = step(self._state, event)
            for directive in directives:
                if isinstance(directive, Deliberate):
                    self._requests[directive.request.id] = directive.request
            names = tuple(type(directive).__name__ for directive in directives)
            if names != stepped.directives:
                what = f"directives {', '.join(stepped.directives) or 'none'}; now {', '.join(names) or 'none'}"
            elif digest(directives) != stepped.digest:
                what = f"the contents of {', '.join(names)}"
        self.steps += 1
        if what:
            return Difference(number=number, event=_described(event), before=self._before, what=what)
        self._before = _described(event)
        return None

    def _thought_again(self, event: DeliberationEnded) -> str:
        """What differs in a decision that is worked out again; empty: nothing."""
        request = self._requests.pop(event.request, None)
        if request is None:
            return f"a decision on request {event.request}, which is not asked for now"
        proposed = getattr(getattr(event.decision, "reasoning", None), "proposed", ())
        self.proposer.queries = tuple(scored.query for scored in proposed)
        self.deliberations += 1
        try:
            decision = decide(self.parts, request)
        except MintPilotError as error:
            return "" if event.decision is None else f"a decision, and the failure '{error}' now"
        if event.decision is None:
            return f"the failure '{event.reason}', and a {type(decision).__name__} now"
        return first_difference(event.decision, decision, tolerance=TOLERANCE, place=type(event.decision).__name__)


def setup_of(started: MissionStarted) -> Setup:
    """What a recorded mission began with."""
    return Setup(
        mission=started.mission,
        task=started.task,
        surveys=started.surveys,
        simulated=started.simulated,
        lands=started.lands,
        briefing=started.briefing,
    )


def _described(event: Input) -> str:
    """An event in one line."""
    name, at = type(event).__name__, f"at {event.time_s:.2f} s"
    shown = [
        f"{what}={getattr(event, what)}"
        for what in ("motion", "end", "order", "question", "link", "up", "request")
        if hasattr(event, what)
    ]
    return " ".join([name, at, *shown])
