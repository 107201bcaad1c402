"""Small 2D worlds solved by brute force: one Dijkstra per joint hypothesis, all of them, nothing clever."""

from __future__ import annotations

import heapq
import itertools
import math
from dataclasses import dataclass, field

import numpy as np

from mintpilot.core.gap import Assumptions, Candidate, GapKind, KnowledgeGap
from mintpilot.core.geometry import GridFrame
from mintpilot.core.plan import Leg, Plan, PlanningProblem, Site, Stop, VehicleLimits
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Action

Cell = tuple[int, int]


@dataclass
class World:
    """A grid with uncertain regions, perhaps several goals of which one is meant, perhaps rooms to be looked into."""

    free: np.ndarray
    regions: dict[str, frozenset[Cell]]
    start: Cell
    goals: dict[str, Cell]
    rooms: dict[str, Cell] = field(default_factory=dict)
    priors: dict[str, tuple[float, ...]] = field(default_factory=dict)

    @property
    def gaps(self) -> tuple[KnowledgeGap, ...]:
        made = [
            KnowledgeGap(
                id=name,
                kind=GapKind.OBSTACLE,
                subject=name,
                description=f"the grey smoke {name}",
                values=("passable", "blocked"),
                prior=self.priors.get(name, (0.5, 0.5)),
                position_m=(0.0, 0.0, 0.0),
            )
            for name in self.regions
        ]
        made += [
            KnowledgeGap(
                id=name,
                kind=GapKind.PRESENCE,
                subject=name,
                description=f"the closed room {name}",
                values=("present", "absent"),
                prior=self.priors.get(name, (0.5, 0.5)),
                position_m=(0.0, 0.0, 0.0),
            )
            for name in self.rooms
        ]
        if len(self.goals) > 1:
            values = tuple(self.goals)
            candidates = tuple(
                Candidate(id=v, position_m=(c[1] + 0.5, c[0] + 0.5, 0.5), description=f"the box {v}")
                for v, c in self.goals.items()
            )
            made.append(
                KnowledgeGap(
                    id="target",
                    kind=GapKind.TARGET,
                    subject="the box",
                    description="the box",
                    values=values,
                    prior=self.priors.get("target", tuple(1 / len(values) for _ in values)),
                    position_m=(0.0, 0.0, 0.0),
                    candidates=candidates,
                )
            )
        return tuple(sorted(made, key=lambda g: g.id))

    def problem(self) -> PlanningProblem:
        """The nouns that a situation needs; the map is empty because the brute-force space does not look at it."""
        frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=1.0, shape=(1, *self.free.shape))
        return PlanningProblem(
            map=SemanticMap(frame=frame, cells=self.free.astype(np.uint8)[None]),
            start_m=(self.start[1] + 0.5, self.start[0] + 0.5, 0.5),
            stops=(),
            gaps=self.gaps,
            limits=VehicleLimits(),
        )


FAILURE_S = 600.0
"""Price of somebody in a room that is skipped, seconds."""


class BruteForce:
    """A plan space that enumerates: every joint hypothesis, every order of rooms, plain Dijkstra for every leg."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.searches = 0
        self.calls = 0
        self._legs: dict[tuple[Cell, frozenset[Cell]], dict[Cell, tuple[float, Cell | None]]] = {}
        self._plans: dict[tuple[bool, Assumptions], Plan | None] = {}

    def optimistic(self, given: Assumptions) -> Plan | None:
        self.calls += 1
        key = (True, given)
        if key not in self._plans:
            options = {g.id: given.possible(g) for g in self.world.gaps}
            open_regions = {r for r in self.world.regions if "passable" in options[r]}
            needed = [r for r in self.world.rooms if options[r] == ("present",)]
            goals = options.get("target", tuple(self.world.goals))
            self._plans[key] = self._best(open_regions, needed, goals, {g for g, v in options.items() if len(v) > 1})
        return self._plans[key]

    def cautious(self, given: Assumptions) -> Plan | None:
        self.calls += 1
        key = (False, given)
        if key not in self._plans:
            options = {g.id: given.possible(g) for g in self.world.gaps}
            known = {r for r in self.world.regions if options[r] == ("passable",)}
            needed = [r for r in self.world.rooms if "present" in options[r]]
            goals = options.get("target", tuple(self.world.goals))
            self._plans[key] = self._best(known, needed, goals, set()) if len(goals) == 1 else None
        return self._plans[key]

    def cost_under(self, truth: dict[str, str]) -> float:
        """What the omniscient planner pays; infinite where nothing can be flown."""
        plan = self.optimistic(Assumptions.exactly(truth))
        return plan.cost_s if plan else math.inf

    def _best(self, passable: set[str], rooms: list[str], goals: tuple[str, ...], open_gaps: set[str]) -> Plan | None:
        plans = [
            self._plan(passable, order, goal, open_gaps) for goal in goals for order in itertools.permutations(rooms)
        ]
        return min((p for p in plans if p), key=lambda p: (round(p.cost_s, 9), p.signature), default=None)

    def _plan(self, passable: set[str], order: tuple[str, ...], goal: str, open_gaps: set[str]) -> Plan | None:
        world, legs, here = self.world, [], self.world.start
        blocked = frozenset(c for r, cells in world.regions.items() if r not in passable for c in cells)
        for name, cell in [*((r, world.rooms[r]) for r in order), (goal, world.goals[goal])]:
            path = self._path(here, cell, blocked)
            if path is None:
                return None
            legs.append((name, path))
            here = cell
        # A diagonal step touches the two cells beside it: corners are not cut.
        cells = {c for _, path in legs for c in path}
        for _, path in legs:
            for (y, x), (v, u) in itertools.pairwise(path):
                cells |= {(y, u), (v, x)}
        enters = frozenset(r for r, region in world.regions.items() if region & cells)
        skips = frozenset(r for r in world.rooms if r not in order)
        binds = (("target", goal),) if len(world.goals) > 1 else ()
        relies = {g for g in enters | skips | {b for b, _ in binds} if g in open_gaps}
        made = tuple(_leg(name, path, name if len(world.goals) > 1 else "") for name, path in legs)
        return Plan(
            legs=made,
            cost_s=sum(leg.duration_s for leg in made),
            relies_on=frozenset(relies),
            enters=enters,
            binds=binds,
            skips=skips,
            stakes=tuple((room, "present", FAILURE_S) for room in sorted(skips)),
        )

    def _path(self, start: Cell, goal: Cell, blocked: frozenset[Cell]) -> list[Cell] | None:
        key = (start, blocked)
        if key not in self._legs:
            self.searches += 1
            self._legs[key] = self._dijkstra(start, blocked)
        tree = self._legs[key]
        if goal not in tree:
            return None
        path: list[Cell] = []
        here: Cell | None = goal
        while here is not None:
            path.append(here)
            here = tree[here][1]
        return path[::-1]

    def _dijkstra(self, start: Cell, blocked: frozenset[Cell]) -> dict[Cell, tuple[float, Cell | None]]:
        free = self.world.free

        def open_at(y: int, x: int) -> bool:
            return 0 <= y < free.shape[0] and 0 <= x < free.shape[1] and bool(free[y, x]) and (y, x) not in blocked

        if not open_at(*start):
            return {}
        done: dict[Cell, tuple[float, Cell | None]] = {}
        queue: list[tuple[float, Cell, Cell]] = [(0.0, start, start)]
        while queue:
            cost, cell, parent = heapq.heappop(queue)
            if cell in done:
                continue
            done[cell] = (cost, None if cell == start else parent)
            y, x = cell
            for dy, dx in itertools.product((-1, 0, 1), repeat=2):
                if (dy or dx) and open_at(y + dy, x + dx) and open_at(y + dy, x) and open_at(y, x + dx):
                    heapq.heappush(queue, (cost + math.hypot(dy, dx), (y + dy, x + dx), cell))
        return done


def _leg(name: str, path: list[Cell], value: str) -> Leg:
    points = np.array([(x + 0.5, y + 0.5, 0.5) for y, x in path])
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    site = Site(position_m=tuple(points[-1]), value=value)
    return Leg(
        stop=Stop(id=name, action=Action.GO, sites=(site,), dwell_s=0.0),
        site=site,
        path_m=points,
        length_m=length,
        duration_s=length,
    )


def hypotheses(world: World) -> list[tuple[dict[str, str], float]]:
    """All joint hypotheses with their prior probability."""
    made = []
    for values in itertools.product(*(range(len(g.values)) for g in world.gaps)):
        truth = {g.id: g.values[i] for g, i in zip(world.gaps, values, strict=True)}
        made.append((truth, math.prod(g.prior[i] for g, i in zip(world.gaps, values, strict=True))))
    return made


def random_world(
    rng: np.random.Generator,
    *,
    regions: int,
    shape: Cell = (7, 10),
    density: float = 0.15,
    goals: int = 1,
    rooms: int = 0,
    uneven: bool = False,
) -> World:
    """A world with obstacles, rectangular regions, goals and rooms; start at the left, goals at the right."""
    height, width = shape
    free = rng.random(shape) >= density
    start = (int(rng.integers(height)), 0)
    free[start] = True
    places = {f"g{i}": (int(rng.integers(height)), width - 1 - i) for i in range(goals)}
    closed = {f"room{i}": (int(rng.integers(height)), int(rng.integers(2, width - 3))) for i in range(rooms)}
    for cell in (*places.values(), *closed.values()):
        free[cell] = True
    made: dict[str, frozenset[Cell]] = {}
    for i in range(regions):
        y, x = int(rng.integers(height)), int(rng.integers(1, width - 2))
        tall, wide = int(rng.integers(1, 1 + height // 2)), int(rng.integers(1, 3))
        cells = {(a, b) for a in range(y, min(height, y + tall)) for b in range(x, min(width - 1, x + wide))}
        made[f"r{i}"] = frozenset(cells - {start, *places.values(), *closed.values()})
    world = World(free=free, regions={r: c for r, c in made.items() if c}, start=start, goals=places, rooms=closed)
    if uneven:
        for gap in world.gaps:
            p = rng.dirichlet([1.0] * len(gap.values))
            world.priors[gap.id] = tuple(p / p.sum())
    return world
