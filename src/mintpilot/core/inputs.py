"""What happens to a mission: the events that its step function takes (method, section 8).

Each carries the time at which it counts, seconds on the mission clock (the vehicle's). Nothing else reaches the
mission: equal events give equal directives.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from mintpilot.core.decisions import Decision
from mintpilot.core.message import NOTHING, Message
from mintpilot.core.motion import MotionEnd
from mintpilot.core.query import Answer, Order
from mintpilot.core.room_view import RoomView
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.told import Fact
from mintpilot.core.trajectory import FlightLog, VehicleState


class Link(StrEnum):
    """What a mission is connected to."""

    OPERATOR = "operator"
    """Everybody who could answer or give orders."""
    CAMERA = "camera"
    TELEMETRY = "telemetry"
    """The autopilot, or the simulator in its place."""
    POSITION = "position"
    """The vehicle's estimate of its position: bad or jumping."""
    CONTROL = "control"
    """The right to fly: down once a pilot, or a fail-safe, has taken the vehicle over."""
    MODEL = "model"
    """A language model or a recogniser."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionBegun:
    """The first event: the vehicle is ready."""

    time_s: float
    vehicle: VehicleState


@dataclass(frozen=True, slots=True, kw_only=True)
class Ticked:
    """Time has passed. Deadlines count when they are reached by such an event."""

    time_s: float
    vehicle: VehicleState | None = None
    """Where the vehicle is; None while nothing is heard of it."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MapObserved:
    """The map was drawn anew from what the camera has seen, with the verdict of the path monitor on it."""

    time_s: float
    map: SemanticMap
    obstruction: Message = NOTHING
    """Why the path that is being flown is not known to be free any more; empty while it is."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionEnded:
    """The vehicle is at rest after a motion, or refused or failed it."""

    time_s: float
    motion: int
    """Id of the motion."""
    end: MotionEnd
    vehicle: VehicleState
    log: FlightLog | None = None
    """What was flown; None for acts and refusals."""
    reason: str = ""
    """For refusals and failures: why."""
    by_hand: str = ""
    """For acts: what a person must do now, because the vehicle cannot; empty: nothing."""
    view: RoomView | None = None
    """For looks into a room: what the vehicle itself says of it; None: the map tells."""


@dataclass(frozen=True, slots=True, kw_only=True)
class QuestionShown:
    """An operator has the question in front of them: its deadline runs from now."""

    time_s: float
    question: str
    """Id of the question."""


@dataclass(frozen=True, slots=True, kw_only=True)
class QuestionReworded:
    """Better words for an open question. Only the words are taken over."""

    time_s: float
    question: str
    text: str
    worded_by: str
    seconds: float = 0.0
    """How long they took to make on this machine; for the record, it decides nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Answered:
    """An operator answered a question: the open one, or an earlier one, late."""

    time_s: float
    question: str
    answer: Answer
    operator: str = ""
    """Which one, for the record."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MoreTimeWanted:
    """An operator needs more time for the open question; granted once."""

    time_s: float
    question: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Ordered:
    """An operator gave an order. Orders count at any time."""

    time_s: float
    order: Order
    operator: str = ""
    text: str = ""
    """As it was given."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FactTold:
    """An operator told something of their own accord. What takes caution away counts once it is confirmed."""

    time_s: float
    fact: Fact
    operator: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class FactConfirmed:
    """An operator confirmed what was read back."""

    time_s: float
    told: str
    """Id of the `ToldFact`."""
    operator: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class FactUndone:
    """An operator took back what was told, or did not confirm it."""

    time_s: float
    told: str
    operator: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkChanged:
    """A link went down, or came up again."""

    time_s: float
    link: Link
    up: bool
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DeliberationEnded:
    """A deliberation came back. One that was dropped meanwhile is ignored."""

    time_s: float
    request: int
    """Id of the request."""
    decision: Decision | None
    """None: it failed."""
    reason: str = ""
    """For a failure: why."""
    seconds: float = 0.0
    """How long it took on this machine; for the record, it decides nothing."""


Input: TypeAlias = (
    MissionBegun
    | Ticked
    | MapObserved
    | MotionEnded
    | QuestionShown
    | QuestionReworded
    | Answered
    | MoreTimeWanted
    | Ordered
    | FactTold
    | FactConfirmed
    | FactUndone
    | LinkChanged
    | DeliberationEnded
)
OperatorInput: TypeAlias = QuestionShown | Answered | MoreTimeWanted | Ordered | FactTold | FactConfirmed | FactUndone
"""What operators bring."""
VehicleInput: TypeAlias = MotionEnded | LinkChanged
"""What vehicles bring."""
