"""Oracle of learned policies on flat grids: plain Dijkstra for every set of blocked regions.

Shares no code with what it judges: its own moves, its own search, its own recursion over answers. Tests use it too.
"""

from __future__ import annotations

import heapq
import itertools
import math
from functools import cache

import numpy as np

ROOT2 = math.sqrt(2.0)


def shortest(free: np.ndarray, start: tuple[int, int], goal: tuple[int, int]) -> float:
    """Length of the shortest path in cell edges, 8-connected, no corner cut; infinite where there is none."""
    return costs_to(free, goal).get(start, math.inf)


def costs_to(free: np.ndarray, goal: tuple[int, int]) -> dict[tuple[int, int], float]:
    """Length of the shortest path from each cell from which there is one."""

    def is_free(y: int, x: int) -> bool:
        return 0 <= y < free.shape[0] and 0 <= x < free.shape[1] and bool(free[y, x])

    done: dict[tuple[int, int], float] = {}
    queue = [(0.0, goal)] if is_free(*goal) else []
    while queue:
        cost, (y, x) = heapq.heappop(queue)
        if (y, x) in done:
            continue
        done[y, x] = cost
        for dy, dx in itertools.product((-1, 0, 1), repeat=2):
            if (dy or dx) and is_free(y + dy, x + dx) and is_free(y + dy, x) and is_free(y, x + dx):
                heapq.heappush(queue, (cost + (ROOT2 if dy and dx else 1.0), (y + dy, x + dx)))
    return done


def critical_regions(
    free: np.ndarray, regions: list[set[tuple[int, int]]], start: tuple[int, int], goal: tuple[int, int], delta: float
) -> set[int]:
    """Numbers of the regions that some answer to the others leaves worth a question, costs in cell edges.

    A region is branched on where the best path of all that may be passable leans on it, and keeping out of everything
    open costs more than ``delta`` above that path.
    """

    @cache
    def cost(shut: frozenset[int]) -> float:
        left = free.copy()
        for number in shut:
            for cell in regions[number]:
                left[cell] = False
        return shortest(left, start, goal)

    critical: set[int] = set()

    def judge(shut: frozenset[int], open_: frozenset[int]) -> None:
        best = cost(shut)
        if best == math.inf:
            return
        sets = (frozenset(s) for n in range(len(open_) + 1) for s in itertools.combinations(sorted(open_), n))
        needed = next(s for s in sets if cost(shut | (open_ - s)) <= best + 1e-9)
        if not needed or cost(shut | open_) - best <= delta + 1e-9:
            return
        region = min(needed)
        critical.add(region)
        judge(shut | {region}, open_ - {region})
        judge(shut, open_ - {region})

    judge(frozenset(), frozenset(range(len(regions))))
    return critical


def flown_length(
    free: np.ndarray, path: list[tuple[int, int]], start: tuple[int, int], goal: tuple[int, int]
) -> float | None:
    """Length of a path of cells in edges; None where it is no way from start to goal through free cells."""
    if not path or path[0] != start or path[-1] != goal or not all(free[cell] for cell in path):
        return None
    length = 0.0
    for (y, x), (v, u) in itertools.pairwise(path):
        if max(abs(y - v), abs(x - u)) != 1 or not (free[y, u] and free[v, x]):
            return None
        length += ROOT2 if y != v and x != u else 1.0
    return length
