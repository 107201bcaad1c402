"""The grid that a learned policy knows: its cells, its regions of unknown passability, the places it flies to."""

from __future__ import annotations

from dataclasses import dataclass

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Bools, Ints, frozen
from mintpilot.core.plan import PlanningProblem
from mintpilot.core.policy import GridCell, PolicyTask
from mintpilot.planning.itinerary import itinerary_of
from mintpilot.planning.terrain import terrain_of

MAX_REGIONS = 8
"""Regions that a policy may be learned for: each doubles the tasks."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PolicyGrid:
    """What a policy was learned on. A *mask* is a joint hypothesis: bit r is set when region r is blocked."""

    free: Bools
    """Cells that may be flown with every region passable (nz, ny, nx)."""
    regions: tuple[Ints, ...]
    """Flat cells of each region; they may overlap."""
    goals: tuple[GridCell, ...]
    """The places that it can fly to."""

    def __post_init__(self) -> None:
        frozen(self.free)

    @property
    def masks(self) -> int:
        """Number of joint hypotheses."""
        return 1 << len(self.regions)

    def under(self, mask: int) -> Bools:
        """The cells that may be flown under a joint hypothesis (nz, ny, nx)."""
        free = self.free.copy()
        for r, cells in enumerate(self.regions):
            if mask >> r & 1:
                free.ravel()[cells] = False
        return free

    def place(self, task: PolicyTask) -> tuple[int, int]:
        """Which of its joint hypotheses and goals a task is, as (mask, index of the goal).

        Raises:
            InputError: the task is of another grid, under none of its joint hypotheses, or flies to another place.
        """
        if task.free.shape != self.free.shape:
            raise InputError(
                f"the policy was made for a grid of {self.free.shape} cells (z, y, x), this one has {task.free.shape}. "
                "Learn it for this mission, or fly by another."
            )
        flat = task.free.ravel()
        mask = sum(1 << r for r, cells in enumerate(self.regions) if not flat[cells].any())
        differ = int((self.under(mask) != task.free).sum())
        if differ:
            raise InputError(
                f"the policy was made for another grid of this size: {differ} cells are free in one and not in the "
                "other. Learn it for this mission, or fly by another."
            )
        if task.goal not in self.goals:
            raise InputError(
                f"the policy was made for flights to {self.goals}, not to {task.goal}. Learn it for this mission, or "
                "fly by another."
            )
        return mask, self.goals.index(task.goal)


def grid_of(problem: PlanningProblem) -> PolicyGrid:
    """The grid of a mission, with every place that it may fly to, the way home included.

    Raises:
        InfeasibleError: nothing can be reached under any hypothesis.
        InputError: it has more regions than a policy can be learned for.
    """
    terrain = terrain_of(problem)
    if len(terrain.regions) > MAX_REGIONS:
        raise InputError(
            f"{len(terrain.regions)} regions of unknown passability: a policy is learned for at most {MAX_REGIONS}, "
            "since each doubles the joint hypotheses. Plan with --planner grid."
        )
    itinerary = itinerary_of(problem, terrain)
    places = {place for place in (*itinerary.places.values(), itinerary.home) if place is not None}
    return PolicyGrid(free=terrain.free, regions=terrain.regions, goals=tuple(sorted(places)))
