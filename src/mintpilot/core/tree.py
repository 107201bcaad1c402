"""The Minimal Information Neuro-Symbolic Tree [T] and the reasons for asking or not."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mintpilot.core.gap import Assumptions, Joint
from mintpilot.core.geometry import Ints, frozen
from mintpilot.core.message import NOTHING, Message
from mintpilot.core.plan import Plan
from mintpilot.core.query import YES_PART, Query


class LeafReason(StrEnum):
    """Why a node was not branched any further (method, section 3)."""

    RELIES_ON_NOTHING = "relies-on-nothing"
    """The optimistic plan depends on no open gap: fly it."""
    CAUTIOUS_IS_GOOD_ENOUGH = "cautious-is-good-enough"
    """The plan that succeeds whatever holds is within the tolerances: fly that one."""
    TARGET_IS_CLEAR_ENOUGH = "target-is-clear-enough"
    """What is left are target gaps with entropy at or under the threshold: fly to the likeliest."""
    INFEASIBLE = "infeasible"
    """Nothing can be flown here, whatever the open gaps turn out to be."""
    NOT_EXPANDED = "not-expanded"
    """The bound on nodes was reached: the cautious plan, if any."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Node:
    """One node of the tree."""

    given: Assumptions
    """What is assumed here."""
    probability: float
    """Of the assumptions, under the belief that the tree was built for."""
    optimistic: Plan | None
    cautious: Plan | None
    divergence_m: float | None = None
    """Distance between the two paths, metres, where both exist."""
    entropy_bits: float | None = None
    """Goal entropy of the target gap that was looked at here, if any."""
    branch_on: str = ""
    """Id of the gap that the children differ in; empty for a leaf."""
    children: tuple[Node, ...] = ()
    leaf: LeafReason | None = None
    plan: Plan | None = None
    """For a leaf: the plan to fly; None when there is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanClass:
    """All joint hypotheses that lead to the same plan."""

    plan: Plan | None
    """None: under these hypotheses nothing can be flown."""
    probability: float
    given: tuple[Assumptions, ...]
    """Which hypotheses: one entry per leaf."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mint:
    """The tree with its leaves sorted into plan classes."""

    root: Node
    belief: Joint
    """What the tree was built for. Its axes are the gaps that the tree branches on; the others, whatever they turn out
    to be, change no plan by more than the tolerances."""
    classes: tuple[PlanClass, ...]
    """Sorted by falling probability, then by cost."""
    class_of: Ints
    """Index into ``classes`` for each joint hypothesis; the shape of ``belief.probability``; -1 for those that were
    left out of the tree because they are impossible or below the floor."""
    nodes: int
    """Number of nodes."""
    not_expanded: int = 0
    """Leaves that the bound on nodes left unexpanded."""

    def __post_init__(self) -> None:
        frozen(self.class_of)

    @property
    def support(self) -> Ints:
        """Flat indices (n,), ascending, of the joint hypotheses that the tree holds and that have some probability."""
        held: Ints = np.flatnonzero((self.class_of.ravel() >= 0) & (self.belief.probability.ravel() > 0))
        return held


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoredQuery:
    """A candidate query with its worth."""

    query: Query
    score: float
    """By the objective that chose it; higher is better."""
    gain_bits: float
    """Mutual information of the answer and the plan class, bits."""
    regret_saved_s: float
    """Expected seconds of regret that the answer saves."""
    reply_probabilities: tuple[float, ...]
    """With which each part of the query will be named in answer, wrong answers included; they sum to one."""
    proposed_by: str = "enumeration"
    """Who proposed it: the enumeration, or a language model by name."""

    @property
    def yes_probability(self) -> float:
        """Of a yes/no query: with which probability the answer will be yes."""
        return self.reply_probabilities[YES_PART]


class StopReason(StrEnum):
    """Why no (further) question is asked (method, section 5)."""

    NO_GAPS = "no-gaps"
    """Nothing is unknown that bears on the task."""
    ONE_CLASS = "one-class"
    """One plan class holds at least 1 - alpha of the mass."""
    GOOD_FOR_ALL = "good-for-all"
    """A plan succeeds within delta_c of the best under every joint hypothesis above the floor."""
    NO_GAIN = "no-gain"
    """No query that is left has a gain on the plan, or none is worth its price."""
    BUDGET = "budget"
    """The number of questions allowed is spent."""
    SILENCE = "silence"
    """The operator does not answer."""
    INFEASIBLE = "infeasible"
    """No plan exists under any hypothesis that is left."""
    PRICE = "price"
    """No policy of asking on is worth its questions' price."""
    WAITING = "waiting"
    """Waiting for an answer may lose more than the answer gives: the battery runs meanwhile."""
    LOOK = "look"
    """A look tells more a second than any question: what follows is decided after it."""
    NEVER_ASKS = "never-asks"
    """The strategy does not ask."""
    LIMIT = "limit"
    """A bound on the work was met: the cautious plan is flown."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """The stop reason with its numbers: no further answer would have changed the flight by more than ``bound_s``."""

    reason: StopReason
    top_class_probability: float
    """Mass of the likeliest plan class."""
    entropy_bits: float
    """Of the plan-class distribution."""
    best_gain_bits: float
    """Of the best query that was left."""
    bound_s: float
    """Largest cost of the chosen plan above the best one, over the hypotheses still above the floor, seconds; infinite
    where the chosen plan may fail or nothing is flown though something might have been."""
    text: Message
    """The same in one plain sentence."""
    mass_outside: float = 0.0
    """Probability that the chosen plan fails, or is dearer than the best one by more than ``delta_c_s``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GapExplanation:
    """For one gap: asked or not, and why, in figures."""

    gap_id: str
    description: str
    kind: str
    asked: bool
    """Whether the operator was asked about it."""
    relevant: bool
    """Whether any best plan depends on it."""
    why: Message
    """One plain sentence with the figures that decided."""
    figures: Message = NOTHING
    """What hangs on it, as a clause; empty where nothing can be flown whatever it is."""
    set_aside: Message = NOTHING
    """Why it was left alone where no plan depends on it; follows the figures."""
    cost_if_favourable_s: float | None = None
    """Cost of the best plan if the gap has its best value (for obstacle gaps: passable), seconds."""
    cost_if_unfavourable_s: float | None = None
    """Cost of the best plan if it has its worst, seconds; None where none exists."""
    divergence_m: float | None = None
    """Distance between those two paths, metres."""
    entropy_bits: float = 0.0
    """Of the gap's own belief."""
    gain_bits: float = 0.0
    """Of the best query about it alone, at the time of the first deliberation."""
    regret_saved_s: float = 0.0
    """Expected seconds that knowing it saves, at the time of the first deliberation."""
