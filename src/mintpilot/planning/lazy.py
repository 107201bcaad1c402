"""Lazy branching: all plan classes of a planner that is a black box.

A way is planned as if every open region were passable. The regions that it enters are what it relies on; only on those
does the search branch (method, section 2). The number of searches follows the number of nodes, not 2^k.
"""

from __future__ import annotations

from typing import Protocol, TypeVar

from mintpilot.planning.decision_list import DecisionList, ParetoPath, sorted_paths

P = TypeVar("P")
P_co = TypeVar("P_co", covariant=True)


class PathPlanner(Protocol[P_co]):
    """A planner between two fixed places, of which nothing else is known."""

    def path(self, blocked: frozenset[int]) -> tuple[float, P_co, frozenset[int]] | None:
        """The best path while those regions are blocked, as (cost, path, regions entered); None where there is none.

        Must be exact and never enter a blocked region.
        """
        ...


def lazy_paths(planner: PathPlanner[P], *, max_searches: int = 4096) -> DecisionList[P]:
    """The decision list of a black box, by branching on the regions that its paths enter.

    Args:
        planner: asked once for each set of blocked regions that matters.
        max_searches: bound on those; beyond it the list is marked incomplete.
    """
    found: dict[frozenset[int], tuple[float, P, frozenset[int]] | None] = {}
    paths: list[ParetoPath[P]] = []
    todo: list[tuple[frozenset[int], frozenset[int]]] = [(frozenset(), frozenset())]
    not_expanded = 0
    while todo:
        blocked, passable = todo.pop()
        if blocked not in found:
            if len(found) >= max_searches:
                not_expanded += 1
                continue
            found[blocked] = planner.path(blocked)
            if (new := found[blocked]) is not None:
                paths.append(ParetoPath(cost=new[0], mask=sum(1 << r for r in new[2]), path=new[1]))
        plan = found[blocked]
        if plan is None:
            continue
        if open_regions := plan[2] - passable:
            region = min(open_regions)
            todo.append((blocked | {region}, passable))
            todo.append((blocked, passable | {region}))
    return DecisionList(paths=sorted_paths(paths), complete=not_expanded == 0, not_expanded=not_expanded)
