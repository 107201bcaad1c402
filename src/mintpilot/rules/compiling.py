"""Formula → minimal automaton by progression; several rules → one automaton.

What is still to be kept after some moments is a choice (or) of sets (and) of ``until`` and ``release`` formulas, kept
free of sets that hold another one: so equal demands are equal values, and there are finitely many.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TypeAlias

import numpy as np

from mintpilot.core.errors import LimitError
from mintpilot.core.geometry import Bools, Ints
from mintpilot.core.rule import Automaton, Proposition, Rule
from mintpilot.rules.formula import And, Atom, Constant, Formula, Or, Release, Until, propositions_of
from mintpilot.rules.parsing import parse

MAX_PROPOSITIONS = 12
"""One automaton has at most 2 to this power letters."""
MAX_STATES = 256
"""Larger automata are refused: planning takes time in proportion."""

_Demand: TypeAlias = frozenset[frozenset[Until | Release]]
_TRUE: _Demand = frozenset({frozenset()})
_FALSE: _Demand = frozenset()


def compile_formula(formula: Formula) -> Automaton:
    """The minimal automaton that accepts the missions on which the formula holds.

    A mission has at least one moment; whether the empty one counts makes the automaton smallest.

    Raises:
        LimitError: more than `MAX_PROPOSITIONS` propositions or `MAX_STATES` states.
    """
    names = tuple(sorted(propositions_of(formula)))
    _few(len(names))
    letters = [frozenset(p for i, p in enumerate(names) if letter >> i & 1) for letter in range(1 << len(names))]
    first: list[_Demand] = [_progressed(formula, true) for true in letters]
    numbers: dict[_Demand, int] = {}
    rows: list[list[int]] = []

    def number(demand: _Demand) -> int:
        if demand not in numbers:
            if len(numbers) >= 4 * MAX_STATES:
                raise _large()
            numbers[demand] = len(numbers) + 1
        return numbers[demand]

    rows.append([number(demand) for demand in first])
    waiting = 0
    while waiting < len(numbers):
        demand = list(numbers)[waiting]
        waiting += 1
        rows.append([number(_all_progressed(demand, true)) for true in letters])
    following = np.array(rows, np.int64)
    accepting = np.array([False, *(_kept(demand) for demand in numbers)])
    choices = [_minimal(names, following, np.concatenate([[empty], accepting[1:]])) for empty in (False, True)]
    return _bounded(min(choices, key=lambda one: one.size))


@lru_cache(maxsize=64)
def compile_rules(rules: tuple[Rule, ...]) -> Automaton:
    """One minimal automaton for several rules together. Raises as `compile_formula` and `parse`."""
    return together([compile_formula(parse(rule.formula)) for rule in rules])


def together(automata: Sequence[Automaton]) -> Automaton:
    """The minimal automaton that accepts what all of them do."""
    names = tuple(sorted({p for one in automata for p in one.propositions}))
    _few(len(names))
    letters = np.arange(1 << len(names))
    seen = [_projected(letters, names, one.propositions) for one in automata]
    numbers: dict[tuple[int, ...], int] = {(0,) * len(automata): 0}
    rows: list[Ints] = []
    while len(rows) < len(numbers):
        states = list(numbers)[len(rows)]
        pieces = [one.following[state, seen[i]] for i, (one, state) in enumerate(zip(automata, states, strict=True))]
        coming = np.stack(pieces, axis=1) if pieces else np.zeros((len(letters), 0), np.int64)
        distinct, where = np.unique(coming, axis=0, return_inverse=True) if pieces else (coming[:1], np.zeros(1, int))
        ids = np.array([numbers.setdefault(tuple(row.tolist()), len(numbers)) for row in distinct])
        rows.append(ids[where.ravel()])
        if len(numbers) > 16 * MAX_STATES:
            raise _large()
    accepting = [all(one.accepting[s] for one, s in zip(automata, states, strict=True)) for states in numbers]
    return _bounded(_minimal(names, np.array(rows, np.int64), np.array(accepting)))


def _progressed(formula: Formula, true: frozenset[Proposition]) -> _Demand:
    """What is to hold from the next moment on for the formula to hold now."""
    match formula:
        case Constant(value):
            return _TRUE if value else _FALSE
        case Atom(proposition, holds):
            return _TRUE if (proposition in true) == holds else _FALSE
        case And(left, right):
            return _both(_progressed(left, true), _progressed(right, true))
        case Or(left, right):
            return _shortest(_progressed(left, true) | _progressed(right, true))
        case Until(left, right):
            again = _both(_progressed(left, true), frozenset({frozenset({formula})}))
            return _shortest(_progressed(right, true) | again)
        case Release(left, right):
            later = _shortest(_progressed(left, true) | frozenset({frozenset({formula})}))
            return _both(_progressed(right, true), later)


def _all_progressed(demand: _Demand, true: frozenset[Proposition]) -> _Demand:
    found: _Demand = _FALSE
    for choice in demand:
        one = _TRUE
        for formula in choice:
            one = _both(one, _progressed(formula, true))
        found = _shortest(found | one)
    return found


def _both(one: _Demand, other: _Demand) -> _Demand:
    return _shortest(frozenset(a | b for a in one for b in other))


def _shortest(demand: _Demand) -> _Demand:
    if len(demand) > MAX_STATES:
        raise _large()
    return frozenset(one for one in demand if not any(other < one for other in demand))


def _kept(demand: _Demand) -> bool:
    """Whether the mission may end here: no ``until`` is left to come."""
    return any(all(isinstance(formula, Release) for formula in choice) for choice in demand)


def _minimal(names: tuple[Proposition, ...], following: Ints, accepting: Bools) -> Automaton:
    """The same language with the fewest states, numbered from the start in the order in which they are reached."""
    blocks = accepting.astype(np.int64)
    while True:
        rows = np.concatenate([blocks[:, None], blocks[following]], axis=1)
        _, finer = np.unique(rows, axis=0, return_inverse=True)
        finer = finer.ravel()
        if finer.max(initial=0) == blocks.max(initial=0) and len(np.unique(finer)) == len(np.unique(blocks)):
            break
        blocks = finer
    order: list[int] = [int(blocks[0])]
    member = {int(block): int(np.argmax(blocks == block)) for block in np.unique(blocks)}
    for block in order:
        order += [b for b in dict.fromkeys(blocks[following[member[block]]].tolist()) if b not in order]
    index = np.full(int(blocks.max(initial=0)) + 1, -1, np.int64)
    index[order] = np.arange(len(order))
    states = [member[block] for block in order]
    table = index[blocks[following[states]]]
    ends = accepting[states]
    alive = ends.copy()
    while True:
        wider = alive | alive[table].any(axis=1)
        if (wider == alive).all():
            break
        alive = wider
    return Automaton(propositions=names, following=table, accepting=ends, alive=alive)


def _projected(letters: Ints, names: tuple[Proposition, ...], own: tuple[Proposition, ...]) -> Ints:
    """Letters over ``names`` as letters over ``own``."""
    found = np.zeros(len(letters), np.int64)
    for bit, name in enumerate(own):
        found |= (letters >> names.index(name) & 1) << bit
    return found


def _few(count: int) -> None:
    if count > MAX_PROPOSITIONS:
        raise LimitError(
            f"the rules speak of {count} different things, more than the {MAX_PROPOSITIONS} that are weighed together: "
            "leave out rules, or use one region for several"
        )


def _bounded(automaton: Automaton) -> Automaton:
    if automaton.size > MAX_STATES:
        raise _large()
    return automaton


def _large() -> LimitError:
    return LimitError(
        f"the rules need an automaton of more than {MAX_STATES} states: leave out rules, or make them simpler"
    )
