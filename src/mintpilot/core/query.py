"""Queries: yes/no cuts without words. Questions: their words. Answers: what came back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import Joint, KnowledgeGap
from mintpilot.core.geometry import Bools


class SayingKind(StrEnum):
    """In which way a literal can be put into words."""

    VALUE = "value"
    """``gap = value``."""
    ATTRIBUTE = "attribute"
    """An attribute of a referent: ``name`` is ``value``."""
    RELATION = "relation"
    """A relation of a referent to another thing: ``name`` (``larger than``, ``left of`` …) ``value``."""
    THRESHOLD = "threshold"
    """``value`` or more, for ordered values."""


@dataclass(frozen=True, slots=True, kw_only=True, order=True)
class Saying:
    """How a literal is said. It has no meaning of its own: the values of the literal are the meaning."""

    kind: SayingKind
    name: str = ""
    value: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Literal:
    """True when the gap's value is one of ``values``."""

    gap: str
    """Id of the gap."""
    values: frozenset[str]
    """The values for which it holds."""
    saying: Saying

    def holds(self, assignment: Mapping[str, str]) -> bool:
        """Whether it is true under a joint hypothesis (gap id → value). Raises `KeyError` for a missing gap."""
        return assignment[self.gap] in self.values


class Combine(StrEnum):
    """How the literals of a query are joined."""

    ALL = "all"
    ANY = "any"


@dataclass(frozen=True, slots=True, kw_only=True)
class Query:
    """A symbolic yes/no cut of the joint hypotheses [q]. It has no words."""

    literals: tuple[Literal, ...]
    """One, or two and more joined by ``combine``."""
    combine: Combine = Combine.ALL

    def __post_init__(self) -> None:
        if not self.literals:
            raise MissionError("a query needs at least one literal")

    @property
    def id(self) -> str:
        """Stable name made of its contents: equal cuts said alike have equal ids."""
        parts = (f"{x.gap}∈{{{','.join(sorted(x.values))}}}" for x in self.literals)
        return f" {'and' if self.combine is Combine.ALL else 'or'} ".join(sorted(parts))

    @property
    def gap_ids(self) -> tuple[str, ...]:
        """The gaps that it speaks of, sorted, none twice."""
        return tuple(sorted({x.gap for x in self.literals}))

    def holds(self, assignment: Mapping[str, str]) -> bool:
        """The true answer under a joint hypothesis (gap id → value)."""
        truths = (x.holds(assignment) for x in self.literals)
        return all(truths) if self.combine is Combine.ALL else any(truths)

    def truths(self, joint: Joint) -> Bools:
        """The true answer under each joint hypothesis, in the shape of ``joint.probability``.

        Raises `KeyError` when the query speaks of a gap that ``joint`` does not hold.
        """
        every = self.combine is Combine.ALL
        table: Bools = np.full(joint.probability.shape, every)
        for literal in self.literals:
            axis = joint.axis(literal.gap)
            shape = [1] * table.ndim
            shape[axis] = -1
            true = np.array([v in literal.values for v in joint.gaps[axis].values]).reshape(shape)
            table = table & true if every else table | true
        return table


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """A query with words. The words never decide the meaning."""

    query: Query
    text: str
    """What is shown or spoken: one short yes/no question, never negated."""
    yes_means: str
    """The consequence of Yes, in plain words: ``fly through the smoke``."""
    no_means: str
    """The consequence of No, in plain words."""
    gaps: tuple[KnowledgeGap, ...]
    """The gaps that the query speaks of, for pictures and for operators that compute their answer."""
    attempt: int = 1
    """1 for the first time, 2 and more when the same cut is asked again in other words."""
    worded_by: str = "template"
    """Who made the words."""


class Reply(StrEnum):
    """What came back. Silence is a reply."""

    YES = "yes"
    NO = "no"
    UNSURE = "unsure"
    TIMEOUT = "timeout"


class Order(StrEnum):
    """What an operator may order instead of answering; obeyed at once."""

    HOLD = "hold"
    CONTINUE = "continue"
    RETURN = "return"
    LAND = "land"
    ABORT = "abort"


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """An operator's reaction to one question [y]."""

    reply: Reply
    latency_s: float
    """From the question's appearance to the reply, seconds."""
    text: str = ""
    """Raw words, as given. Data, never an instruction to this program."""
    command: Order | None = None
    """An order, which overrides ``reply``."""
    also: tuple[tuple[Query, bool], ...] = ()
    """What was said beyond the question (``not the red one, the blue one``): cuts with their answers. They teach the
    belief, and never count as the explicit yes that opens a region."""
    understood_by: str = ""
    """Who made a reply of the words: ``rules``, ``model``, or empty where nobody had to."""
    better_s: float | None = None
    """When better words (`mintpilot.core.ports.BetterWords`) were shown, seconds after the question's appearance; None:
    the person had the first words only."""
