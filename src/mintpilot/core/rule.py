"""Rules in time: what must hold along a whole mission, in any order of its stops (method, section 14)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from mintpilot.core.geometry import Bools, Ints, frozen
from mintpilot.core.message import Message

_KEPT_OUT = re.compile(r"G !touches\(([^()]*)\)")


class About(StrEnum):
    """What a proposition speaks of."""

    IN = "in"
    """The drone's centre is in the region."""
    INSIDE = "inside"
    """Its whole body is."""
    TOUCHES = "touches"
    """Its body touches the region."""
    WITHIN = "within"
    """Its body is at most so many metres from the thing, the people or the region."""
    AT = "at"
    """It is at the stop."""
    DID = "did"
    """It has done what the stop is for."""
    LOOKED = "looked"
    """It has looked into the room, and could see."""
    CARRYING = "carrying"
    """It carries something of that label."""

    @property
    def spatial(self) -> bool:
        """Whether it hangs on where the drone is, and on nothing else."""
        return self in (About.IN, About.INSIDE, About.TOUCHES, About.WITHIN)


@dataclass(frozen=True, slots=True, kw_only=True, order=True)
class Proposition:
    """Something that is true or false at each moment of a mission."""

    about: About
    subject: str
    """Id of the region, goal or room; the label carried; words for a thing."""
    metres: float = 0.0
    """For ``within``: how near."""

    def __str__(self) -> str:
        """As in a formula: ``within(people, 2)``."""
        return f"{self.about}({self.subject}{f', {self.metres:g}' if self.about is About.WITHIN else ''})"


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """One rule, as it was given."""

    text: Message
    """In plain words, without a full stop."""
    formula: str
    """In LTLf."""

    @property
    def keeps_out_of(self) -> str:
        """What the body never touches by this rule: a region's id or kind; empty where it says anything else."""
        match = _KEPT_OUT.fullmatch(self.formula)
        return match.group(1) if match else ""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Automaton:
    """A complete deterministic automaton over the truth of propositions; a mission begins in state 0."""

    propositions: tuple[Proposition, ...]
    """Bit i of a letter is the truth of the i-th; sorted."""
    following: Ints
    """(states, 2^propositions) the state after each letter."""
    accepting: Bools
    """(states,) whether a mission that ends here has kept the rule."""
    alive: Bools
    """(states,) whether it still can be kept."""

    def __post_init__(self) -> None:
        for array in (self.following, self.accepting, self.alive):
            frozen(array)

    @property
    def size(self) -> int:
        """Number of states."""
        return len(self.accepting)

    def followed(self, states: frozenset[int], letters: Iterable[tuple[int, int]], held: int) -> frozenset[int]:
        """The states that may be reached after (what holds, what may hold) one after another, ``held`` throughout."""
        for yes, may in letters:
            states = self.after(states, yes | held, may | held)
        return states

    def after(self, states: frozenset[int], yes: int, may: int) -> frozenset[int]:
        """The states that may be reached while what is in ``may`` and not in ``yes`` is not known, or changes.

        A stay of any length counts: rules have no next step, so that the same letter again changes nothing.
        """
        doubtful = may & ~yes
        fitting = [yes]
        part = doubtful
        while part:  # every part of what is not known
            fitting.append(yes | part)
            part = part - 1 & doubtful
        reached: set[int] = set()
        coming = set(states)
        while coming:
            found = {after for state in coming for after in self.following[state, fitting].tolist()}
            coming = found - reached
            reached |= found
        return frozenset(reached)


@dataclass(frozen=True, slots=True, kw_only=True)
class StopLetters:
    """What a stop does to the truth of propositions, as bits of a letter."""

    at: int = 0
    """True while the drone is there."""
    begins: int = 0
    """True from when it was done."""
    ends: int = 0
    """False from when it was done."""

    def after(self, held: int) -> int:
        """What holds from when it was done, if ``held`` did before."""
        return (held | self.begins) & ~self.ends

    def moments(self, held: int) -> tuple[int, int]:
        """What holds while the drone is there, before it was done and after."""
        return held | self.at, self.after(held) | self.at


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ruling:
    """The rules of a mission, bound to its map and stops, and how far they have come."""

    rules: tuple[Rule, ...]
    automaton: Automaton
    """Of all of them together."""
    cells: tuple[Ints, ...]
    """For each proposition of ``automaton`` the flat cells (n,) of what it speaks of; empty for those of stops."""
    stops: tuple[tuple[str, StopLetters], ...]
    """Stop id and what it does; stops that no rule speaks of are not listed."""
    states: frozenset[int] = frozenset({0})
    """The states of ``automaton`` that the mission may be in by what was flown."""
    held: int = 0
    """Bits of the propositions of stops that hold now."""

    def letters(self, stop_id: str) -> StopLetters:
        """What that stop does."""
        return dict(self.stops).get(stop_id, StopLetters())
