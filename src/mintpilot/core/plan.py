"""Plans [tau] with their cost [C] and what they rely on; the problem that a planner is given."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import Assumptions, KnowledgeGap
from mintpilot.core.geometry import Floats, Vec3, frozen
from mintpilot.core.message import NOTHING, Message, joined, message, verbatim
from mintpilot.core.rule import Ruling
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Action

PRICE_S = 600.0
"""What leaving a stop undone costs where nothing else is said, seconds of flight."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleLimits:
    """What the vehicle can do."""

    radius_m: float = 0.3
    """No part of the vehicle is further from its centre, metres."""
    margin_m: float = 0.1
    """Clearance kept besides the radius, metres."""
    cruise_mps: float = 1.5
    """Speed on straight legs, metres per second; costs are lengths divided by it."""
    max_acceleration_mps2: float = 2.0
    """Of any commanded motion."""
    endurance_s: float = float("inf")
    """Flight time that is left for the mission, seconds; longer plans do not exist."""
    position_sigma_m: float = 0.0
    """Standard deviation of the known position, metres; three times as much is added to the clearance."""
    reserve_s: float = 0.0
    """Flight time that no plan may use, seconds."""

    def __post_init__(self) -> None:
        for name in ("radius_m", "cruise_mps", "max_acceleration_mps2", "endurance_s"):
            if not getattr(self, name) > 0:
                raise MissionError(f"vehicle {name} = {getattr(self, name)}: must be above 0")
        for name in ("margin_m", "position_sigma_m", "reserve_s"):
            if not 0 <= getattr(self, name) < math.inf:
                raise MissionError(f"vehicle {name} = {getattr(self, name)}: must be finite and not below 0")

    @property
    def clearance_m(self) -> float:
        """Distance kept between the vehicle's centre and whatever it must not touch, metres."""
        return self.radius_m + self.margin_m + 3 * self.position_sigma_m


@dataclass(frozen=True, slots=True, kw_only=True)
class Site:
    """One place at which a stop can be fulfilled."""

    position_m: Vec3
    """The thing itself, or the viewpoint; the drone goes to flyable space within ``reach_m`` of it."""
    reach_m: float = 1.5
    """How near is near enough, metres."""
    value: str = ""
    """For a stop bound to a gap: the value of the gap under which this is the place."""
    label: str = ""
    """Short name for reports: ``box-2``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stop:
    """One place to be visited, in order."""

    id: str
    action: Action
    sites: tuple[Site, ...]
    """One; for a stop bound to a target gap, one per value of the gap."""
    gap: str = ""
    """Target gap that says which site is meant, or presence gap that says whether the stop is needed at all."""
    optional: bool = False
    """True for a stop that is needed only if its presence gap has the value of its one site. An optional stop may be
    put anywhere between the others; the ordered ones keep their order."""
    dwell_s: float = 2.0
    """Time spent there, seconds; part of the cost."""
    price_s: float = PRICE_S
    """What leaving it undone costs where it is needed, seconds of flight."""
    step: int = 0
    """Number of the step of the task that it belongs to; 0: none."""
    text: Message = NOTHING
    """What is done there, as a short sentence without a full stop."""
    chance: float = 1.0
    """Probability that an optional stop is needed, as believed when the problem was framed."""
    informs: bool = False
    """True where it is done to know more: what follows is decided after it."""

    @property
    def said(self) -> Message:
        """What is done there; where nothing says it, the stop's id."""
        return self.text or verbatim(self.id)

    def __post_init__(self) -> None:
        if not 0 <= self.price_s < math.inf:
            raise MissionError(f"stop '{self.id}': price_s = {self.price_s}: must be finite and not below 0")


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """A place from which a gap can be settled by looking (method, section 11)."""

    gap: str
    """Id of the gap."""
    viewpoint_m: Vec3
    dwell_s: float = 2.0
    """How long the drone stays there, seconds."""
    sees: float = 1.0
    """Probability that the look settles the gap; else it tells nothing."""

    def __post_init__(self) -> None:
        if not 0 < self.sees <= 1:
            raise MissionError(f"look at '{self.gap}': sees = {self.sees}: must be above 0 and at most 1")
        if not 0 <= self.dwell_s < math.inf:
            raise MissionError(f"look at '{self.gap}': dwell_s = {self.dwell_s}: must be finite and not below 0")


class Shortage(StrEnum):
    """What ran short for a stop that is left undone."""

    BATTERY = "battery"
    """Flight time, beside what the plan does instead."""
    WAY = "way"
    """No way there is known to be safe."""
    THING = "thing"
    """What it would deliver is not picked up."""
    ANSWER = "answer"
    """Which of several places is meant is not known."""
    UNSEEN = "unseen"
    """It is none of the things that were seen."""
    PRICE = "price"
    """The flight would cost more than leaving it undone."""
    RULE = "rule"
    """A rule of the mission does not allow it."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LeftUndone:
    """A stop that a plan leaves undone though it is, or may be, needed."""

    stop: Stop
    resource: Shortage
    needed_s: float | None = None
    """Flight time that doing it besides would take (or, alone, where it is too far even then), seconds."""
    available_s: float | None = None
    """Flight time that is left for it, or the price that it is worth, seconds."""
    rules: tuple[Message, ...] = ()
    """Words of the rules that do not allow it."""

    @property
    def reason(self) -> Message:
        """Why, with the figures, as a clause without a full stop."""
        match self.resource:
            case Shortage.BATTERY:
                needed, given = _seconds(self.needed_s or 0.0, self.available_s or 0.0)
                return message(
                    "the way there needs {needed_s} s, the battery gives {given_s} s", needed_s=needed, given_s=given
                )
            case Shortage.PRICE:
                needed, given = _seconds(self.needed_s or 0.0, self.available_s or 0.0)
                return message(
                    "the way there needs {needed_s} s, and leaving it undone counts for {given_s} s",
                    needed_s=needed,
                    given_s=given,
                )
            case Shortage.WAY:
                return message("no way there is known to be safe")
            case Shortage.THING:
                return message("what it needs is not picked up")
            case Shortage.ANSWER:
                return message("which one is meant is not known")
            case Shortage.UNSEEN:
                return message("it is none of the things that were seen")
            case Shortage.RULE:
                return message("it cannot be done while this is kept: {rules}", rules=joined(self.rules, "; "))


def _seconds(needed: float, given: float) -> tuple[str, str]:
    """Two times as whole seconds, or with the digits that tell them apart."""
    for digits in (0, 1):
        if f"{needed:.{digits}f}" != f"{given:.{digits}f}":
            return f"{needed:.{digits}f}", f"{given:.{digits}f}"
    return f"{needed:.2f}", f"{given:.2f}"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlanningProblem:
    """All that a planner needs to know."""

    map: SemanticMap
    start_m: Vec3
    """Where the drone is."""
    stops: tuple[Stop, ...]
    """Ordered stops in order, then the optional ones."""
    gaps: tuple[KnowledgeGap, ...]
    """The open gaps, sorted by id. An obstacle gap's subject is the id of an open region of the map; regions known
    to be blocked, and open ones without a gap, are obstacles to every plan."""
    limits: VehicleLimits
    finished: frozenset[str] = frozenset()
    """Ids of stops that were already fulfilled; they are not among ``stops``."""
    home_m: Vec3 | None = None
    """Where the drone must be able to return to after its last stop; None: nowhere."""
    ruling: Ruling | None = None
    """The rules that every plan keeps to its end, the way home included; None: there are none."""

    def gap(self, gap_id: str) -> KnowledgeGap:
        """The gap with that id. Raises `KeyError` for an unknown one."""
        for gap in self.gaps:
            if gap.id == gap_id:
                return gap
        raise KeyError(gap_id)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Leg:
    """The way to one stop, and the stay there."""

    stop: Stop
    site: Site
    path_m: Floats
    """Way-points (n, 3), metres, from where the last leg ended; n is at least 1."""
    length_m: float
    duration_s: float
    """Flight at cruise speed plus the stay, seconds."""

    def __post_init__(self) -> None:
        frozen(self.path_m)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Plan:
    """Ordered legs with their cost, and the gaps that the plan would break on or lose by (method, section 2).

    What it costs under a joint hypothesis is the flight, and the prices of what it leaves undone there (section 9):
    ``cost_s + undone_s`` and, for each entry of ``stakes`` whose gap has that value, its price.
    """

    legs: tuple[Leg, ...]
    cost_s: float
    """Seconds of flight, stays included [C]."""
    relies_on: frozenset[str]
    """Ids of gaps, open under the assumptions it was planned with, that it depends on. Empty for a cautious plan."""
    enters: frozenset[str]
    """Ids of all obstacle gaps whose regions it flies through, open or not; on the way home, too, where it returns."""
    home_s: float = 0.0
    """Flight from its last stop to the start where the drone must return, else 0, seconds; no part of the cost."""
    binds: tuple[tuple[str, str], ...] = ()
    """(gap id, value) chosen for each target gap, sorted."""
    skips: frozenset[str] = frozenset()
    """Ids of presence gaps whose room it leaves out, taking it for empty."""
    leaves_undone: tuple[LeftUndone, ...] = ()
    """Stops that it leaves undone though they are needed, or may be: in the order of the problem."""
    undone_s: float = 0.0
    """Prices of what it leaves undone that is needed whatever holds, seconds."""
    stakes: tuple[tuple[str, str, float], ...] = ()
    """(presence gap, value, seconds): what not looking there costs where the gap has that value; sorted."""
    signature: str = field(default="", compare=False)
    """Stable digest of places and way: plans of one plan class share it. Filled in when empty."""

    def __post_init__(self) -> None:
        if not self.signature:
            digest = hashlib.blake2b(digest_size=8)
            for leg in self.legs:
                digest.update(leg.stop.id.encode() + b"\0" + leg.site.value.encode() + b"\0")
                digest.update(np.round(leg.path_m, 6).tobytes())
            object.__setattr__(self, "signature", digest.hexdigest())

    @property
    def path_m(self) -> Floats:
        """The whole way (n, 3), metres; a way-point shared by two legs is given once."""
        if not self.legs:
            return np.zeros((0, 3))
        parts = [self.legs[0].path_m, *(leg.path_m[1:] for leg in self.legs[1:])]
        return np.concatenate(parts)

    @property
    def length_m(self) -> float:
        """Length of the way, metres."""
        return float(sum(leg.length_m for leg in self.legs))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prospect:
    """One plan that an open question may come to."""

    probability: float
    """Of its plan class; 0 for the cautious plan, which is flown when no answer comes."""
    plan: Plan
    """From where the question was asked."""
    given: tuple[Assumptions, ...]
    """Under which answers it is flown: one of these, which exclude each other."""
    free: frozenset[str]
    """Ids of the obstacle gaps whose regions are passable if it comes to it."""
    spare_s: float
    """How much later it may begin and still fit the battery with reserve and way home, from when the question was
    thought of, seconds; infinite without an end of the battery."""
