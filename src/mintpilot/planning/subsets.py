"""Which stops in which order: costs of the best route through every set of up to 12 stops (method, section 9)."""

from __future__ import annotations

import numpy as np

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools, Floats, Ints

MAX_STOPS = 12
"""Up to so many stops every set of them is weighed; the tables have 2 to this power rows."""
TIE_S = 1e-6
"""Costs that differ by less, seconds, are equal."""


def set_costs(apart_s: Floats, start_s: Floats, later: Ints, needs: Ints) -> Floats:
    """Seconds of the best route through each set of stops, by the stop that it ends at.

    Args:
        apart_s: (n, n) from each stop to each other, the stay at the latter included; infinite: no way.
        start_s: (n,) from the start, the stay included.
        later: (n,) bit sets of the stops that must not have been visited before this one.
        needs: (n,) bit sets of the stops that must have been.

    Returns:
        (2^n, n), infinite where no route exists.
    """
    best = np.full((1 << len(start_s), len(start_s)), np.inf)
    _fill(best, apart_s, start_s, later, needs)
    return best


@compiled(error_model="numpy")
def _fill(best: Floats, apart_s: Floats, start_s: Floats, later: Ints, needs: Ints) -> None:
    count = start_s.size
    for i in range(count):
        if needs[i] == 0:
            best[1 << i, i] = start_s[i]
    for done in range(1, 1 << count):
        for last in range(count):
            if best[done, last] == np.inf:
                continue
            for i in range(count):
                if done >> i & 1 or done & later[i] or needs[i] & ~done:
                    continue
                cost = best[done, last] + apart_s[last, i]
                if cost < best[done | 1 << i, i]:
                    best[done | 1 << i, i] = cost


def members(count: int) -> Bools:
    """Which stops are in each set, (2^n, n)."""
    flags: Bools = (np.arange(1 << count)[:, None] >> np.arange(count) & 1).astype(bool)
    return flags


def best_set(flight_s: Floats, inside: Bools, weights_s: Floats, supposed: Bools) -> int | None:
    """The set of stops with the lowest flight and prices of what it leaves out, never the empty one.

    At equal prices somebody seen goes before somebody supposed: among the sets that leave out as much by price as the
    best one, that which leaves out least of what is not merely supposed, then the shortest.

    Args:
        flight_s: (2^n,) of the best route through each set; infinite where it does not fit.
        inside: (2^n, n) from `members`.
        weights_s: (n,) prices.
        supposed: (n,) stops for somebody who was not seen.

    Returns:
        The bit set, None where not one stop can be done.
    """
    left_s = (~inside) @ weights_s
    fits = np.isfinite(flight_s)
    fits[0] = False
    if not fits.any():
        return None
    total = np.where(fits, flight_s + left_s, np.inf)
    chosen = int(np.argmin(np.round(total, 6)))
    alike = np.flatnonzero(fits & (np.abs(left_s - left_s[chosen]) <= TIE_S))
    seen_s = (~inside) @ np.where(supposed, 0.0, weights_s)
    order = np.lexsort((alike, np.round(flight_s[alike], 6), np.round(seen_s[alike], 6)))
    return int(alike[order[0]])
