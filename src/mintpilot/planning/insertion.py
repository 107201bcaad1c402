"""One more stop put into an order of stops, where it costs least."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from mintpilot.core.geometry import Floats


def insert(
    order: Sequence[int],
    stop: int,
    start_s: Floats,
    apart_s: Floats,
    home_s: Floats,
    battery_s: float,
    *,
    later: Sequence[int],
    needs: Sequence[int],
) -> tuple[int | None, float, float]:
    """Where a stop costs least in an order.

    Args:
        order: numbers of the stops, not empty.
        stop: the number of the one to be put in.
        start_s: (n,) from the start to each, the stay included, seconds.
        apart_s: (n, n) from each to each other, the stay included, seconds.
        home_s: (n,) from each home, seconds.
        battery_s: flight time in all, seconds.
        later: for each stop, a bit set of those that must not come before it.
        needs: for each stop, a bit set of those that must.

    Returns:
        (its place in the order, None where it may stand nowhere; the seconds that it adds, infinite then; the seconds
        that the battery has left without it).
    """

    def seconds(way: Sequence[int]) -> float:
        total = float(start_s[way[0]] + home_s[way[-1]])
        return total + sum(float(apart_s[a, b]) for a, b in pairwise(way))

    def allowed(way: Sequence[int]) -> bool:
        seen = 0
        for i in way:
            if seen & later[i] or needs[i] & ~seen:
                return False
            seen |= 1 << i
        return True

    now_s = seconds(order)
    best: tuple[float, int] | None = None
    for place in range(len(order) + 1):
        way = [*order[:place], stop, *order[place:]]
        if allowed(way) and (best is None or seconds(way) < best[0]):
            best = (seconds(way), place)
    if best is None:
        return None, float("inf"), battery_s - now_s
    return best[1], best[0] - now_s, battery_s - now_s
