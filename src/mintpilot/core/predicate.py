"""Predicates over gaps: literals, how they are joined and said, and the options of a choice (method, section 4)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

import numpy as np

from mintpilot.core.errors import MissionError
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
class Option:
    """One part of a choice, with the words that name it."""

    label: str
    """Short: ``the red box``."""
    literals: tuple[Literal, ...]
    """One, or two and more joined by ``combine``."""
    combine: Combine = Combine.ALL

    def __post_init__(self) -> None:
        if not self.literals or not self.label.strip():
            raise MissionError(f"option '{self.label}': it needs a label and at least one literal")

    def holds(self, assignment: Mapping[str, str]) -> bool:
        """Whether it is true under a joint hypothesis (gap id → value)."""
        return holds(self.literals, self.combine, assignment)


Domain: TypeAlias = tuple[tuple[str, tuple[str, ...]], ...]
"""Ids of gaps with their values, one axis each."""


def holds(literals: Sequence[Literal], combine: Combine, assignment: Mapping[str, str]) -> bool:
    """Whether the joined literals are true under a joint hypothesis (gap id → value)."""
    truths = (x.holds(assignment) for x in literals)
    return all(truths) if combine is Combine.ALL else any(truths)


def truths(literals: Sequence[Literal], combine: Combine, domain: Domain) -> Bools:
    """Where the literals hold, one axis for each gap of the domain."""
    every = combine is Combine.ALL
    axes = {name: axis for axis, (name, _) in enumerate(domain)}
    table: Bools = np.full([len(values) for _, values in domain], every)
    for literal in literals:
        axis = axes[literal.gap]
        shape = [1] * table.ndim
        shape[axis] = -1
        true = np.array([v in literal.values for v in domain[axis][1]]).reshape(shape)
        table = table & true if every else table | true
    return table


def exclusive(one: Option, other: Option) -> bool:
    """Whether the two never hold at once: each way to fulfil the one rules out each way to fulfil the other."""
    return all(
        any(values.isdisjoint(second[gap]) for gap, values in first.items() if gap in second)
        for first in _ways(one)
        for second in _ways(other)
    )


def _ways(option: Option) -> Iterator[dict[str, frozenset[str]]]:
    """The ways to fulfil an option: for some gaps, the values that each must have one of."""
    if option.combine is Combine.ANY:
        yield from ({x.gap: x.values} for x in option.literals)
        return
    needed: dict[str, frozenset[str]] = {}
    for literal in option.literals:
        needed[literal.gap] = needed.get(literal.gap, literal.values) & literal.values
    yield needed


def contents(literals: Iterable[Literal], combine: Combine) -> str:
    """The joined literals as a stable name, whatever their order and however they are said."""
    named = (f"{x.gap}∈{{{','.join(sorted(x.values))}}}" for x in literals)
    return f" {'and' if combine is Combine.ALL else 'or'} ".join(sorted(named))
