"""LTLf by its definition, word by word: shares no code with `mintpilot.rules` but the nouns of formulas' text.

A formula here is a nested tuple: ``("U", a, b)``, ``("R", a, b)``, ``("&", a, b)``, ``("|", a, b)``, ``("->", a, b)``,
``("!", a)``, ``("G", a)``, ``("F", a)``, or the name of a proposition; a trace is a sequence of sets of names.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def holds(formula, trace: Sequence[frozenset[str]], at: int = 0) -> bool:
    """Whether the formula holds on the trace from that moment on."""
    if isinstance(formula, str):
        return formula in trace[at]
    sign, *parts = formula
    later = range(at, len(trace))
    match sign:
        case "!":
            return not holds(parts[0], trace, at)
        case "&":
            return holds(parts[0], trace, at) and holds(parts[1], trace, at)
        case "|":
            return holds(parts[0], trace, at) or holds(parts[1], trace, at)
        case "->":
            return not holds(parts[0], trace, at) or holds(parts[1], trace, at)
        case "F":
            return any(holds(parts[0], trace, i) for i in later)
        case "G":
            return all(holds(parts[0], trace, i) for i in later)
        case "U":
            return any(
                holds(parts[1], trace, i) and all(holds(parts[0], trace, j) for j in range(at, i)) for i in later
            )
        case "R":
            return all(holds(parts[1], trace, i) or any(holds(parts[0], trace, j) for j in range(at, i)) for i in later)
    raise ValueError(sign)


def text(formula, about=None) -> str:
    """As `mintpilot.rules.parsing.parse` reads it; proposition ``a`` is ``at(a)``, or as ``about`` says."""
    if isinstance(formula, str):
        return f"{(about or {}).get(formula, 'at')}({formula})"
    sign, *parts = formula
    if len(parts) == 1:
        return f"{sign}({text(parts[0], about)})"
    return f"(({text(parts[0], about)}) {sign} ({text(parts[1], about)}))"


def drawn(rng: np.random.Generator, names: Sequence[str], depth: int):
    """A random formula."""
    if depth == 0 or rng.random() < 0.15:
        return str(rng.choice(list(names)))
    sign = str(rng.choice(["!", "G", "F", "&", "|", "->", "U", "R", "U", "R"]))
    count = 1 if sign in "!GF" else 2
    return (sign, *(drawn(rng, names, depth - 1) for _ in range(count)))


def progressed(formula, moment: frozenset[str]):
    """What is left to be kept after one moment, by rewriting: True, False, or a formula with ``now`` where it is new.

    Only conjunctions and disjunctions that became constant are made simpler, so that few formulas come of one.
    """
    if formula is True or formula is False:
        return formula
    if isinstance(formula, str):
        return formula in moment
    sign, *parts = formula
    match sign:
        case "now":
            return progressed(parts[0], moment)
        case "!":
            inner = progressed(parts[0], moment)
            return (not inner) if isinstance(inner, bool) else ("!", inner)
        case "&" | "and":
            return _all([progressed(p, moment) for p in parts])
        case "|":
            return _not(_all([_not(progressed(p, moment)) for p in parts]))
        case "->":
            return _not(_all([progressed(parts[0], moment), _not(progressed(parts[1], moment))]))
        case "G":
            return _all([progressed(parts[0], moment), formula])
        case "F":
            return _not(_all([_not(progressed(parts[0], moment)), _not(formula)]))
        case "U":
            later = _all([progressed(parts[0], moment), formula])
            return _not(_all([_not(progressed(parts[1], moment)), _not(later)]))
        case "R":
            later = _not(_all([_not(progressed(parts[0], moment)), _not(formula)]))
            return _all([progressed(parts[1], moment), later])
    raise ValueError(sign)


def _not(formula):
    if isinstance(formula, bool):
        return not formula
    return formula[1] if formula[0] == "!" else ("!", formula)


def _all(parts):
    flat = []
    for part in parts:
        flat += part[1:] if isinstance(part, tuple) and part[0] == "and" else [part]
    if any(p is False for p in flat):
        return False
    left = sorted({p for p in flat if p is not True}, key=repr)
    if any(_not(p) in left for p in left):
        return False
    return True if not left else left[0] if len(left) == 1 else ("and", *left)


def may_end(formula) -> bool:
    """Whether what is left is kept by a flight that ends now."""
    if isinstance(formula, bool):
        return formula
    sign, *parts = formula
    match sign:
        case "!":
            return not may_end(parts[0])
        case "and":
            return all(may_end(p) for p in parts)
        case "G" | "R":
            return True
        case "F" | "U":
            return False
    raise ValueError(formula)
