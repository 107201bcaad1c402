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


def text(formula) -> str:
    """As `mintpilot.rules.parsing.parse` reads it; proposition ``a`` is ``at(a)``."""
    if isinstance(formula, str):
        return f"at({formula})"
    sign, *parts = formula
    if len(parts) == 1:
        return f"{sign}({text(parts[0])})"
    return f"(({text(parts[0])}) {sign} ({text(parts[1])}))"


def drawn(rng: np.random.Generator, names: Sequence[str], depth: int):
    """A random formula."""
    if depth == 0 or rng.random() < 0.15:
        return str(rng.choice(list(names)))
    sign = str(rng.choice(["!", "G", "F", "&", "|", "->", "U", "R", "U", "R"]))
    count = 1 if sign in "!GF" else 2
    return (sign, *(drawn(rng, names, depth - 1) for _ in range(count)))
