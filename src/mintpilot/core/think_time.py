"""How long a person thinks about a question."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import InputError


@dataclass(frozen=True, slots=True)
class ThinkTime:
    """Seconds that a person takes for an answer: always the same, or drawn evenly between two bounds.

    Raises:
        InputError: a bound is negative, not finite, or above the other.
    """

    least_s: float = 0.0
    most_s: float = 0.0

    def __post_init__(self) -> None:
        if not (0 <= self.least_s <= self.most_s < math.inf):
            raise InputError(f"think '{self}': must be seconds from 0 on, the lower bound first: 5, or 2..8")

    def __str__(self) -> str:
        return f"{self.least_s:g}" if self.least_s == self.most_s else f"{self.least_s:g}..{self.most_s:g}"

    @property
    def mean_s(self) -> float:
        """On average, seconds."""
        return (self.least_s + self.most_s) / 2

    def draw(self, rng: np.random.Generator) -> float:
        """One time, seconds. Nothing is drawn where it is always the same."""
        return self.least_s if self.least_s == self.most_s else float(rng.uniform(self.least_s, self.most_s))


def think_time(words: str | float) -> ThinkTime:
    """Reads ``5`` or ``2..8``, seconds.

    Raises:
        InputError: it is neither.
    """
    least, dots, most = str(words).strip().partition("..")
    try:
        low = float(least)
        high = float(most) if dots else low
    except ValueError as error:
        raise InputError(f"think '{words}': write seconds, e.g. 5, or two bounds, e.g. 2..8") from error
    return ThinkTime(low, high)
