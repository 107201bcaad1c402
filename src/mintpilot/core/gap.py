"""Knowledge gaps [u], what may be assumed of them, and what is believed of them jointly."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mintpilot.core.errors import MissionError
from mintpilot.core.geometry import Floats, Vec3, frozen
from mintpilot.core.observation import Attribute
from mintpilot.core.threshold import Threshold
from mintpilot.core.tolerances import SUM_TOLERANCE

PASSABLE = "passable"
BLOCKED = "blocked"
PRESENT = "present"
ABSENT = "absent"
NONE_OF_THEM = "none of them"
NOT_YET_SEEN = "not yet seen"
NOWHERE = (NONE_OF_THEM, NOT_YET_SEEN)
"""Values of a target gap that are no candidates: the phrase means nothing that was seen, or it is in no picture yet."""
NOT_HERE = "not here"
"""Value of a gap that asks in which zone of unseen space something is: in none of them."""
NO_THING = (*NOWHERE, NOT_HERE)
"""Values of a target gap that name no candidate."""
FLY = "fly"
STAY = "stay"


class GapKind(StrEnum):
    """What kind of thing is not known (method, section 1)."""

    OBSTACLE = "obstacle"
    """Is this region passable? Values: `PASSABLE`, `BLOCKED`."""
    TARGET = "target"
    """Which object does this phrase mean? Values: ids of the candidates; where names are in doubt, `NOWHERE` too.
    Of something that was not seen: in which zone of unseen space is it? Values: ids of the zones, and `NOT_HERE`."""
    PRESENCE = "presence"
    """Is somebody in this place? Values: `PRESENT`, `ABSENT`."""
    VALUE = "value"
    """An ordered quantity. Values: numbers in ascending order, as text."""
    GO = "go"
    """May the mission be flown as it was understood? Values: `FLY`, `STAY`. Asked before take-off only."""


_SEPARATOR = ":"


def obstacle_id(region: str) -> str:
    """Id of the gap that asks whether that region is passable."""
    return f"{GapKind.OBSTACLE}{_SEPARATOR}{region}"


def presence_id(room: str) -> str:
    """Id of the gap that asks whether somebody is in that room."""
    return f"{GapKind.PRESENCE}{_SEPARATOR}{room}"


def target_id(number: int, phrase: str) -> str:
    """Id of the gap that asks which object a phrase means.

    Args:
        number: of the step of the task that has the phrase, from 1.
        phrase: in letters, digits and hyphens: ``red-box``.
    """
    return f"{GapKind.TARGET}{_SEPARATOR}{number}{_SEPARATOR}{phrase}"


def kind_of(gap_id: str) -> GapKind | None:
    """The kind of gap that an id names; None for what is no gap id."""
    head, separator, _ = gap_id.partition(_SEPARATOR)
    return GapKind(head) if separator and head in set(GapKind) else None


def region_of(gap_id: str) -> str:
    """The region that an obstacle gap asks about. Raises `MissionError` for another id."""
    if kind_of(gap_id) is not GapKind.OBSTACLE:
        raise MissionError(f"gap '{gap_id}' is about no region: ids of such gaps look like '{obstacle_id('smoke-1')}'")
    return gap_id.partition(_SEPARATOR)[2]


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """One object that a phrase may mean; its id is the value of the target gap."""

    id: str
    position_m: Vec3
    attributes: tuple[Attribute, ...] = ()
    size_m: Vec3 = (0.0, 0.0, 0.0)
    description: str = ""
    """In plain words, e.g. ``the small red box``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KnowledgeGap:
    """One unknown variable with a finite domain and a prior."""

    id: str
    """Stable name; the same gap keeps it when the map is updated, e.g. ``obstacle:smoke-1``."""
    kind: GapKind
    subject: str
    """Id of the region or room, or the phrase of the instruction, that it is about."""
    description: str
    """The subject as the operator can see it, with its article: ``the grey smoke near the gate``."""
    values: tuple[str, ...]
    """The domain: at least one value, none twice. The order has no meaning except for `GapKind.VALUE`."""
    prior: tuple[float, ...]
    """Probability of each value; sums to one."""
    position_m: Vec3
    """Where its subject is (for a target gap: the middle of the candidates)."""
    candidates: tuple[Candidate, ...] = ()
    """For a target gap: one per value that is a thing, in the same order."""
    is_thing: bool = False
    """For a presence gap: its subject is a thing that may be somebody, not a place that may hold somebody."""
    threshold: Threshold | None = None
    """For an obstacle gap: it is passable exactly where an ordered value is at least this."""

    def __post_init__(self) -> None:
        if not self.values or len(set(self.values)) != len(self.values):
            raise MissionError(f"gap '{self.id}': values {self.values} must be one or more, none twice")
        if len(self.prior) != len(self.values):
            raise MissionError(f"gap '{self.id}': {len(self.prior)} probabilities for {len(self.values)} values")
        if any(not 0 <= p <= 1 for p in self.prior) or not math.isclose(sum(self.prior), 1, abs_tol=SUM_TOLERANCE):
            raise MissionError(f"gap '{self.id}': prior {self.prior} must be from 0 to 1 each and sum to 1")
        things = tuple(v for v in self.values if v not in NO_THING)
        if self.candidates and tuple(c.id for c in self.candidates) != things:
            raise MissionError(f"gap '{self.id}': the candidates' ids must be its values, in order")

    @property
    def spots(self) -> tuple[tuple[str, str, Vec3], ...]:
        """(id, words, place) of each thing that it is about; none where it is about the flight itself."""
        if self.kind is GapKind.GO:
            return ()
        found = tuple((one.id, one.description or one.id, one.position_m) for one in self.candidates)
        return found or ((self.subject, self.description, self.position_m),)

    @property
    def in_doubt(self) -> bool:
        """Whether a phrase may mean none of its candidates."""
        return any(v in NO_THING for v in self.values)

    @property
    def is_search(self) -> bool:
        """Whether it asks in which zone of unseen space something is (method, section 9)."""
        return NOT_HERE in self.values


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrelationGroup:
    """Gaps whose priors do not multiply, e.g. two clouds from one fire."""

    gaps: tuple[str, ...]
    """Ids of two or more gaps; a gap is in one group at most."""
    joint: tuple[tuple[tuple[str, ...], float], ...]
    """Probability of each combination of values (in the order of ``gaps``); those not named have none. Sums to one
    and replaces the members' own priors."""


@dataclass(frozen=True, slots=True)
class Assumptions:
    """What a plan may take for granted [A]: for some gaps, the values that are still possible.

    A gap that is not named is open with all its values. Equal contents make equal, hashable assumptions.
    """

    items: tuple[tuple[str, frozenset[str]], ...] = ()
    """(gap id, values still possible), sorted by gap id."""

    @classmethod
    def of(cls, possible: Mapping[str, Iterable[str]]) -> Assumptions:
        """From a mapping of gap ids to their possible values."""
        return cls(tuple(sorted((gap, frozenset(values)) for gap, values in possible.items())))

    @classmethod
    def exactly(cls, values: Mapping[str, str]) -> Assumptions:
        """One value for each named gap: a joint hypothesis when all gaps are named."""
        return cls.of({gap: (value,) for gap, value in values.items()})

    def possible(self, gap: KnowledgeGap) -> tuple[str, ...]:
        """The values of the gap that are still possible, in the gap's own order."""
        for name, values in self.items:
            if name == gap.id:
                return tuple(v for v in gap.values if v in values)
        return gap.values

    def is_open(self, gap: KnowledgeGap) -> bool:
        """True while more than one value is possible."""
        return len(self.possible(gap)) > 1

    def assume(self, gap_id: str, values: Iterable[str]) -> Assumptions:
        """These assumptions with the gap's values replaced."""
        return Assumptions.of({**dict(self.items), gap_id: values})


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Joint:
    """Joint distribution over the values of a few gaps: one axis per gap, in the order of ``gaps``."""

    gaps: tuple[KnowledgeGap, ...]
    """Sorted by id, so that the order in the input never matters."""
    probability: Floats
    """Shape (number of values of each gap …); sums to one. With no gaps: shape (), the value 1."""

    def __post_init__(self) -> None:
        if tuple(g.id for g in self.gaps) != tuple(sorted({g.id for g in self.gaps})):
            raise MissionError("the gaps of a joint distribution must be sorted by id, none twice")
        if self.probability.shape != tuple(len(g.values) for g in self.gaps):
            raise MissionError(
                f"a joint of shape {self.probability.shape} over gaps with {[len(g.values) for g in self.gaps]} values"
            )
        frozen(self.probability)

    def axis(self, gap_id: str) -> int:
        """The axis of that gap. Raises `KeyError` for an unknown one."""
        for index, gap in enumerate(self.gaps):
            if gap.id == gap_id:
                return index
        raise KeyError(gap_id)

    def marginal(self, gap_id: str) -> Floats:
        """Probability of each value of that gap, shape (n,)."""
        axis = self.axis(gap_id)
        others = tuple(i for i in range(len(self.gaps)) if i != axis)
        marginal: Floats = np.asarray(self.probability.sum(axis=others), float)
        return marginal

    def probability_of(self, gap_id: str, value: str) -> float:
        """Probability of one value of that gap."""
        return float(self.marginal(gap_id)[self.gaps[self.axis(gap_id)].values.index(value)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Belief:
    """What is believed of all open gaps: independent factors, each a joint distribution over a few gaps.

    Thirty independent gaps are thirty small factors, not one tensor of 2^30 cells. Correlation groups, and answers that
    speak of several gaps at once, join the factors that they couple.
    """

    factors: tuple[Joint, ...]
    """No gap is in two of them; sorted by the id of their first gap. Each has at least one gap."""

    def __post_init__(self) -> None:
        if any(not f.gaps for f in self.factors):
            raise MissionError("a factor of a belief needs at least one gap")
        ids = [g.id for f in self.factors for g in f.gaps]
        if len(set(ids)) != len(ids):
            raise MissionError("a gap of a belief may be in one factor only")
        firsts = [f.gaps[0].id for f in self.factors]
        if firsts != sorted(firsts):
            raise MissionError("the factors of a belief must be sorted by the id of their first gap")

    @property
    def gaps(self) -> tuple[KnowledgeGap, ...]:
        """All gaps, sorted by id, so that the order in the input never matters."""
        return tuple(sorted((g for f in self.factors for g in f.gaps), key=lambda g: g.id))

    def factor(self, gap_id: str) -> Joint:
        """The factor that holds that gap. Raises `KeyError` for an unknown one."""
        for factor in self.factors:
            if any(g.id == gap_id for g in factor.gaps):
                return factor
        raise KeyError(gap_id)

    def marginal(self, gap_id: str) -> Floats:
        """Probability of each value of that gap, shape (n,). Raises `KeyError` for an unknown one."""
        return self.factor(gap_id).marginal(gap_id)

    def probability_of(self, gap_id: str, value: str) -> float:
        """Probability of one value of that gap. Raises `KeyError` for an unknown one."""
        return self.factor(gap_id).probability_of(gap_id, value)
