"""What a deliberation comes to (method, section 8). Values: the step function takes them over or drops them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from mintpilot.core.gap import Belief, KnowledgeGap
from mintpilot.core.geometry import Bools, Vec3, frozen
from mintpilot.core.message import Message
from mintpilot.core.plan import LeftUndone, Plan, Prospect, Stop
from mintpilot.core.query import Question
from mintpilot.core.semantic_map import Knowledge
from mintpilot.core.trajectory import Trajectory
from mintpilot.core.tree import Certificate, GapExplanation, Mint, ScoredQuery


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reasoning:
    """What a deliberation on the mission looked at."""

    gaps: tuple[KnowledgeGap, ...]
    """All that is open and bears on the task, sorted by id."""
    belief: Belief
    """Over these gaps."""
    regions: tuple[tuple[str, Knowledge], ...] = ()
    """Regions that the answers have settled, by id."""
    rooms: tuple[tuple[str, Knowledge], ...] = ()
    """Rooms that the answers have settled, by id."""
    mint: Mint | None = None
    """The tree; None for strategies that build none."""
    cautious: Plan | None = None
    """The best plan that succeeds whatever holds, checked against the map: flown when reasoning is not to be had."""
    explanations: tuple[GapExplanation, ...] = ()
    """Of the gaps that had not been explained before, at what they are worth now."""
    proposed: tuple[ScoredQuery, ...] = ()
    """Queries that a language model proposed and that were sound, scored, best first."""
    left_out: tuple[Message, ...] = ()
    """What bounds on the work left out, in plain sentences."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AskQuestion:
    """Put this question."""

    reasoning: Reasoning
    question: Question
    """In words by template; its id is given when it is put."""
    scored: ScoredQuery
    alternatives: tuple[ScoredQuery, ...] = ()
    bound_bits: float | None = None
    """No query whatever could tell more of the plan class than this; None: not worked out."""
    waits_s: float = float("inf")
    """How long an answer may be waited for until the cautious plan, with its reserve, must begin to fit the battery,
    seconds; infinite where there is no such plan, or no end of the battery."""
    prospects: tuple[Prospect, ...] = ()
    """What the answer may come to, the cautious plan last where there is one; empty where the drone holds meanwhile."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlyPlan:
    """Ask no more; fly this plan (None: there is none that may be flown)."""

    reasoning: Reasoning
    plan: Plan | None
    certificate: Certificate
    unsafe: bool = False
    """True only for baselines that fly through what is not known passable; refused outside a simulator."""
    left: tuple[LeftUndone, ...] = ()
    """All stops with what runs short for each, where nothing is flown."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NoPlan:
    """Nothing can be flown, whatever the answers are."""

    reason: Message
    left: tuple[LeftUndone, ...] = ()
    """All stops with what runs short for each."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlyTrajectory:
    """The next flight, checked against the map: a leg of the plan, or back out of a place that is not known free."""

    trajectory: Trajectory
    retreat: bool = False
    """True for the way back out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RefuseFlight:
    """No trajectory leads on that passes the checks."""

    reason: Message


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Explore:
    """Where the survey goes next."""

    trajectory: Trajectory | None
    """None: nowhere; the survey is over, or begins its way back."""
    retreat: bool
    """True for the way back out of a place that is not known free: it is not looked around from there yet."""
    unreachable_m: tuple[Vec3, ...]
    """Places that no checked trajectory leads to, metres."""
    inspected: Bools
    """Flags (nz, ny, nx) of surface cells that were looked at from near."""
    notes: tuple[Message, ...] = ()

    def __post_init__(self) -> None:
        frozen(self.inspected)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GoBack:
    """The way to the start, or to a place to land at, through space that is known to be free."""

    trajectory: Trajectory | None
    """None: the vehicle is there already."""
    duration_s: float
    """Of that flight, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Meanwhile:
    """What is done while a question is open (method, section 10): a flight, a stop right here, or neither."""

    trajectory: Trajectory | None = None
    """Through what is known free, to where the answer will cost less; None: no flight."""
    stop: Stop | None = None
    """What every plan does here first; None: nothing."""
    needed_s: float | None = None
    """When the cautious plan must begin from where this ends, mission clock; None: as before."""


Decision: TypeAlias = Meanwhile | AskQuestion | FlyPlan | NoPlan | FlyTrajectory | RefuseFlight | Explore | GoBack
