"""Formulas of LTLf without X, with ``not`` in front of propositions only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from mintpilot.core.rule import Proposition


@dataclass(frozen=True, slots=True)
class Constant:
    """True or false."""

    value: bool

    def __str__(self) -> str:
        return "true" if self.value else "false"


@dataclass(frozen=True, slots=True)
class Atom:
    """A proposition, or that it does not hold."""

    proposition: Proposition
    holds: bool = True

    def __str__(self) -> str:
        return f"{'' if self.holds else '!'}{self.proposition}"


@dataclass(frozen=True, slots=True)
class And:
    """Both."""

    left: Formula
    right: Formula

    def __str__(self) -> str:
        return f"({self.left} & {self.right})"


@dataclass(frozen=True, slots=True)
class Or:
    """One of them at least."""

    left: Formula
    right: Formula

    def __str__(self) -> str:
        return f"({self.left} | {self.right})"


@dataclass(frozen=True, slots=True)
class Until:
    """The right one comes, and the left one holds at every moment before."""

    left: Formula
    right: Formula

    def __str__(self) -> str:
        return f"F {self.right}" if self.left == TRUE else f"({self.left} U {self.right})"


@dataclass(frozen=True, slots=True)
class Release:
    """The right one holds up to and with the moment at which the left one does, or to the end."""

    left: Formula
    right: Formula

    def __str__(self) -> str:
        return f"G {self.right}" if self.left == FALSE else f"({self.left} R {self.right})"


Formula: TypeAlias = Constant | Atom | And | Or | Until | Release

TRUE = Constant(True)
FALSE = Constant(False)


def negated(formula: Formula) -> Formula:
    """What holds exactly where the formula does not."""
    match formula:
        case Constant(value):
            return Constant(not value)
        case Atom(proposition, holds):
            return Atom(proposition, not holds)
        case And(left, right):
            return Or(negated(left), negated(right))
        case Or(left, right):
            return And(negated(left), negated(right))
        case Until(left, right):
            return Release(negated(left), negated(right))
        case Release(left, right):
            return Until(negated(left), negated(right))


def eventually(formula: Formula) -> Formula:
    """It holds now or later."""
    return Until(TRUE, formula)


def always(formula: Formula) -> Formula:
    """It holds now and to the end."""
    return Release(FALSE, formula)


def propositions_of(formula: Formula) -> frozenset[Proposition]:
    """All that it speaks of."""
    match formula:
        case Constant():
            return frozenset()
        case Atom(proposition, _):
            return frozenset({proposition})
        case _:
            return propositions_of(formula.left) | propositions_of(formula.right)
