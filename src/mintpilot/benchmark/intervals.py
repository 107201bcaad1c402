"""Intervals of confidence, 95 %."""

from __future__ import annotations

import math
from collections.abc import Sequence

from scipy import stats

Z = 1.959963984540054
"""Of the normal distribution, two-sided 95 %."""


def wilson(successes: int, n: int) -> tuple[float, float]:
    """Wilson's interval of a share; the whole range where nothing was tried."""
    if n == 0:
        return (0.0, 1.0)
    share, z2 = successes / n, Z * Z
    middle = (share + z2 / (2 * n)) / (1 + z2 / n)
    half = Z / (1 + z2 / n) * math.sqrt(share * (1 - share) / n + z2 / (4 * n * n))
    # At the ends the exact bounds are 0 and 1; rounding must not miss them.
    return (0.0 if successes == 0 else middle - half, 1.0 if successes == n else middle + half)


def student(values: Sequence[float]) -> tuple[float, float] | None:
    """Student's t interval of a mean; None for fewer than two values."""
    n = len(values)
    if n < 2:
        return None
    mean = math.fsum(values) / n
    spread = math.sqrt(math.fsum((v - mean) ** 2 for v in values) / (n - 1))
    half = float(stats.t.ppf(0.975, n - 1)) * spread / math.sqrt(n)
    return (mean - half, mean + half)


def clopper_pearson_upper(successes: int, n: int) -> float:
    """The exact one-sided 95 % upper bound of a share; 1 where nothing was tried."""
    return 1.0 if successes >= n else float(stats.beta.ppf(0.95, successes + 1, n - successes))


def clopper_pearson(successes: int, n: int) -> tuple[float, float]:
    """The exact two-sided 95 % interval of a share; the whole range where nothing was tried."""
    if n == 0:
        return (0.0, 1.0)
    low = 0.0 if successes == 0 else float(stats.beta.ppf(0.025, successes, n - successes + 1))
    high = 1.0 if successes == n else float(stats.beta.ppf(0.975, successes + 1, n - successes))
    return (low, high)
