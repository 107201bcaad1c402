"""The truth of a formula along a flight, from the meaning of LTLf itself: no automaton, nothing of planning."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mintpilot.core.geometry import Bools
from mintpilot.core.rule import Proposition
from mintpilot.rules.formula import And, Atom, Constant, Formula, Or, Until


def truth(formula: Formula, of: Callable[[Proposition], Bools], moments: int) -> Bools:
    """Whether the formula holds from each moment on, (moments,); the first one tells of the whole flight.

    Args:
        formula: the rule.
        of: the truth (moments,) of a proposition at each moment.
        moments: at least 1.
    """
    match formula:
        case Constant(value):
            return np.full(moments, value)
        case Atom(proposition, holds):
            true = np.asarray(of(proposition), bool)
            return true if holds else ~true
    left, right = truth(formula.left, of, moments), truth(formula.right, of, moments)
    if isinstance(formula, And):
        return left & right
    if isinstance(formula, Or):
        return left | right
    found = np.zeros(moments, bool)
    until = isinstance(formula, Until)
    later = not until
    for i in range(moments - 1, -1, -1):
        later = bool(right[i] or (left[i] and later)) if until else bool(right[i] and (left[i] or later))
        found[i] = later
    return found
