"""Where to fly while a question is open: to where the answer will cost least (method, section 10)."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from mintpilot.core.decisions import Meanwhile
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import obstacle_id
from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.plan import Leg, Plan, Prospect, Stop, VehicleLimits
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.core.task import Action
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.trajectory import Trajectory, VehicleState
from mintpilot.planning.checks import check_trajectory
from mintpilot.planning.flyable import flyable_cells, known_flyable, region_reach
from mintpilot.planning.grid_search import GridSearch
from mintpilot.planning.legs import Cell3
from mintpilot.planning.terrain import start_cell
from mintpilot.planning.trajectory import plan_trajectory

MAX_FIELDS = 24
"""With more distance fields than this the drone holds: a bound on the work."""
MAX_CELLS = 1 << 25
"""The same for the cells of all prospects' costs together."""
MAX_FREE_ORDER = 3
"""Up to so many stops may be done in another order than the plan's."""
SETTLING_S = 0.5
"""Besides braking, so much is kept for setting out anew from between two cells, seconds."""
CURVE_S = 0.3
"""By so much the costs along a smooth flight may be above those of its cells, seconds."""
HERE_M = 0.3
"""A stop is done from within this distance of the place where its leg ends, metres."""

_Key: TypeAlias = tuple[Cell3, frozenset[str]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Wait:
    """An open question, as far as it matters for what is done meanwhile."""

    prospects: tuple[Prospect, ...]
    asked_s: float
    """When the prospects' spare times began to run, mission clock."""
    until_s: float
    """When the person's patience is over, mission clock."""
    now_s: float
    finished: frozenset[str]
    """Stops that were done since."""


def meanwhile(wait: Wait, map: SemanticMap, limits: VehicleLimits, vehicle: VehicleState) -> Meanwhile:
    """What to do next while the question stays open; nothing where holding is as good.

    The flight leads through what is known free, to the place of least expected cost among those that can be reached by
    places that are none dearer than this one. No plan is lost by it that holding would keep: as long as holding keeps a
    plan, it fits the battery from each place on the way, and the flight ends where it costs no more than here, or where
    the patience is over before the battery.

    Args:
        wait: the question.
        map: what is known.
        limits: of the vehicle.
        vehicle: where it is, at rest.
    """
    stop = _stop_here(wait, vehicle)
    if stop is not None:
        return Meanwhile(stop=stop)
    known = known_flyable(map, limits)
    try:
        z, y, x = (int(i) for i in start_cell(map, limits, known, vehicle.position_m))
    except InfeasibleError:
        return Meanwhile()
    here: Cell3 = (z, y, x)
    costs = _Costs(wait, map, limits).of_prospects()
    if costs is None:
        return Meanwhile()
    outlook = _Outlook(wait, costs, here, limits)
    if not np.isfinite(outlook.expected[here]):
        return Meanwhile()
    edge_s = map.frame.resolution_m / limits.cruise_mps
    when_s = GridSearch(known).distances(here) * edge_s + wait.now_s + outlook.braking_s
    allowed = known & (outlook.expected <= outlook.expected[here] + TOLERANCE) & outlook.fits(when_s)
    allowed[here] = True
    search = GridSearch(allowed)
    away = search.distances(here)
    worth = np.where(np.isfinite(away) & outlook.may_rest(when_s), outlook.expected, np.inf)
    least = float(worth.min())
    if not outlook.expected[here] - least > outlook.braking_s:
        return Meanwhile()
    best = np.argwhere(worth <= least + TOLERANCE)
    goal = best[int(np.argmin(away[tuple(best.T)]))]
    found = search.shortest_path(here, goal)
    assert found is not None, "the goal was reached by the field"
    path = np.vstack([np.asarray([vehicle.position_m], float), map.frame.centres_of(found[1])])
    return _flight(path, outlook, map, limits, vehicle)


def _flight(
    path: Floats, outlook: _Outlook, map: SemanticMap, limits: VehicleLimits, vehicle: VehicleState
) -> Meanwhile:
    """The path as a checked motion, as much of it as keeps what its cells promise once it is smoothed."""
    for share in (1.0, 0.5, 0.25):
        part = path[: max(2, int(np.ceil(share * len(path))))]
        try:
            trajectory = plan_trajectory(part, map=map, limits=limits, start_yaw_rad=vehicle.yaw_rad)
        except InfeasibleError:
            return Meanwhile()
        if check_trajectory(trajectory, map, limits):
            return Meanwhile()
        cells = map.frame.cells_of(trajectory.position_m)
        if map.frame.is_flat:
            cells[:, 0] = 0
        if outlook.keeps_to(trajectory, tuple(cells.T)):
            z, y, x = (int(i) for i in cells[-1])
            return Meanwhile(trajectory=trajectory, needed_s=outlook.needed_s((z, y, x)))
    return Meanwhile()


class _Outlook:
    """Costs of all prospects from everywhere, and what they allow."""

    def __init__(self, wait: Wait, costs: Floats, here: Cell3, limits: VehicleLimits) -> None:
        self._wait, self._costs = wait, costs
        self.braking_s = limits.cruise_mps / limits.max_acceleration_mps2
        weights = np.array([p.probability for p in wait.prospects])
        likely = weights > 0  # what has no weight may lie beyond every way
        self.expected: Floats = np.tensordot(weights[likely] / weights.sum(), costs[likely], 1)
        self._start_s = float(self.expected[here])
        self._here_s = costs[(slice(None), *here)]
        self._lost_s = np.array([wait.asked_s + p.spare_s for p in wait.prospects])
        self._lost_s[weights == 0] = np.inf  # the cautious plan is kept as long as the question is open
        """When holding where it was asked loses each prospect."""
        self._ends_s = np.array([wait.asked_s + p.spare_s + p.plan.cost_s for p in wait.prospects])
        """When each prospect's flight must be over."""

    def _kept(self) -> Iterator[tuple[int, Floats]]:
        """The prospects that holding still keeps, with their costs."""
        for i, cost in enumerate(self._costs):
            if self._lost_s[i] > self._wait.now_s:
                yield i, cost

    def fits(self, when_s: Floats) -> Bools:
        """Where the drone may be at those times: every prospect fits that holding keeps until then."""
        fits = np.ones(when_s.shape, bool)
        for i, cost in self._kept():
            fits &= (when_s + cost + SETTLING_S <= self._ends_s[i]) | (when_s > self._lost_s[i])
        return fits

    def may_rest(self, when_s: Floats) -> Bools:
        """Where it may stay from those times on."""
        may = np.ones(when_s.shape, bool)
        for i, cost in self._kept():
            may &= (
                (when_s > self._lost_s[i])
                | (cost <= self._here_s[i] + TOLERANCE)
                | (cost <= self._ends_s[i] - self._wait.until_s - self.braking_s)
            )
        return may

    def keeps_to(self, trajectory: Trajectory, cells: tuple[np.ndarray, ...]) -> bool:
        """Whether a smooth flight through those cells, one for each sample, is as good as its path.

        Where it passes between flyable cells nothing is known of the costs; there they hardly differ from those beside.
        """
        expected = self.expected[cells]
        between = ~np.isfinite(expected)
        if between[-1]:
            return False
        when_s = self._wait.now_s + trajectory.time_s
        if (
            not (between | (expected <= self._start_s + CURVE_S)).all()
            or not expected[-1] < self._start_s - self.braking_s
        ):
            return False
        for i, cost in self._kept():
            along = cost[cells]
            fine = between | (when_s + along + self.braking_s <= self._ends_s[i]) | (when_s > self._lost_s[i])
            if not fine.all():
                return False
        return True

    def needed_s(self, cell: Cell3) -> float | None:
        """When the cautious plan must begin from there, mission clock; None where there is no such plan."""
        if self._wait.prospects[-1].probability > 0:
            return None
        return float(self._ends_s[-1] - self._costs[(-1, *cell)] - self.braking_s - SETTLING_S)


class _Costs:
    """Flight seconds of each prospect from every cell, by distance fields from its stops."""

    def __init__(self, wait: Wait, map: SemanticMap, limits: VehicleLimits) -> None:
        self._wait, self._map = wait, map
        self._edge_s = map.frame.resolution_m / limits.cruise_mps
        self._flyable = flyable_cells(map, limits)
        self._reach = {
            obstacle_id(r.id): region_reach(map, r, limits) for r in map.regions if r.passable is not Knowledge.YES
        }
        self._fields: dict[_Key, Floats] = {}

    def of_prospects(self) -> Floats | None:
        """Shape (prospects, nz, ny, nx), infinite where there is no way; None beyond the bound on fields."""
        places = {(cell, p.free) for p in self._wait.prospects for _, cell in self._left(p)}
        if len(places) > MAX_FIELDS or len(self._wait.prospects) * self._flyable.size > MAX_CELLS:
            return None
        return np.stack([self._of(prospect) for prospect in self._wait.prospects])

    def _of(self, prospect: Prospect) -> Floats:
        left = self._left(prospect)
        if not left:
            return np.zeros(self._flyable.shape)
        best: Floats = np.full(self._flyable.shape, np.inf)
        for order in _orders(left, prospect.plan):
            rest_s = sum(leg.stop.dwell_s for leg, _ in order)
            rest_s += sum(float(self._field(b, prospect.free)[a]) for (_, a), (_, b) in itertools.pairwise(order))
            best = np.minimum(best, self._field(order[0][1], prospect.free) + rest_s)
        return best

    def _left(self, prospect: Prospect) -> list[tuple[Leg, Cell3]]:
        """The legs whose stops are not done, with the cells where they end."""
        return [(leg, _cell(self._map, leg)) for leg in prospect.plan.legs if leg.stop.id not in self._wait.finished]

    def _field(self, cell: Cell3, free: frozenset[str]) -> Floats:
        key = (cell, free)
        if key not in self._fields:
            passable = self._flyable.copy()
            for gap, reach in self._reach.items():
                if gap not in free:
                    passable.ravel()[reach] = False
            self._fields[key] = GridSearch(passable).distances(cell) * self._edge_s
        return self._fields[key]


def _orders(left: Sequence[tuple[Leg, Cell3]], plan: Plan) -> Iterator[Sequence[tuple[Leg, Cell3]]]:
    """Orders in which the stops may be done: the plan's own; of few, all in which those with an order keep it.

    Where the way home counts, the plan's own only: it was reckoned from its last stop.
    """
    if len(left) > MAX_FREE_ORDER or plan.home_s > 0:
        yield left
        return
    fixed = [leg.stop.id for leg, _ in left if not leg.stop.optional]
    for order in itertools.permutations(left):
        if [leg.stop.id for leg, _ in order if not leg.stop.optional] == fixed:
            yield order


def _stop_here(wait: Wait, vehicle: VehicleState) -> Stop | None:
    """A place to be reached that every prospect may do first, and where the drone is."""
    found: Stop | None = None
    for prospect in wait.prospects:
        left = [leg for leg in prospect.plan.legs if leg.stop.id not in wait.finished]
        fixed = [leg for leg in left if not leg.stop.optional]
        if not fixed or fixed[0].stop.action is not Action.GO or (prospect.plan.home_s > 0 and left[0] is not fixed[0]):
            return None
        if found is not None and fixed[0].stop.id != found.id:
            return None
        if float(np.linalg.norm(fixed[0].path_m[-1] - vehicle.position_m)) > HERE_M:
            return None
        found = fixed[0].stop
    return found


def _cell(map: SemanticMap, leg: Leg) -> Cell3:
    z, y, x = (int(i) for i in map.frame.cells_of(leg.path_m[-1:])[0])
    return (0 if map.frame.is_flat else z, y, x)
