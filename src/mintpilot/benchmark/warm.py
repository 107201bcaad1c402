"""Plans that several methods share, since they fly in the same world and begin with the same problem."""

from __future__ import annotations

from collections.abc import Hashable

from mintpilot.core.plan import PlanningProblem
from mintpilot.core.ports import Planner, PlanSpace


class WarmPlanner(Planner):
    """Gives the plan space that was opened for an equal problem before, instead of a new one.

    Equal problems have equal plans (contract of `Planner`), so only the time changes. Keep one for each world: maps are
    told apart by their voxel array, which worlds share with all maps that answers make of theirs.

    Args:
        planner: makes the plan spaces.
    """

    def __init__(self, planner: Planner) -> None:
        self._planner = planner
        self._spaces: dict[Hashable, tuple[PlanningProblem, PlanSpace]] = {}

    def open(self, problem: PlanningProblem) -> PlanSpace:
        """As the planner inside."""
        key = _key(problem)
        if key not in self._spaces:
            # The problem is kept too: its arrays must outlive their ids in the key.
            self._spaces[key] = (problem, self._planner.open(problem))
        return self._spaces[key][1]


def _key(problem: PlanningProblem) -> Hashable:
    regions = tuple((r.id, r.passable, id(r.cells)) for r in problem.map.regions)
    rooms = tuple((r.id, r.occupied, r.searched) for r in problem.map.rooms)
    gaps = tuple((g.id, g.kind, g.subject, g.values) for g in problem.gaps)
    return (
        id(problem.map.cells),
        regions,
        rooms,
        gaps,
        problem.start_m,
        problem.stops,
        problem.limits,
        problem.finished,
        problem.home_m,
    )
