"""Random worlds and the exact expectation of a way of asking over everything that may be true in them."""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mintpilot.assembly.registry import load
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import BLOCKED, PASSABLE, Assumptions, Candidate, GapKind, KnowledgeGap, obstacle_id, target_id
from mintpilot.core.geometry import GridFrame, Vec3
from mintpilot.core.mission import AskingSettings
from mintpilot.core.observation import Attribute, RegionKind
from mintpilot.core.plan import PlanningProblem, Site, Stop, VehicleLimits
from mintpilot.core.ports import Ask, Fly, PlanSpace, Situation, Strategy
from mintpilot.core.query import Query, answer_for
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.core.task import Action
from mintpilot.mission.belief_state import BeliefState, update
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.reasoning.belief import prior_belief

SHAPE = (24, 40)
LIMITS = VehicleLimits(radius_m=0.01, margin_m=0.0, cruise_mps=1.0)
TOLERANCE_S = 1e-6
BOX = target_id(1, "box")
COLOURS = ("red", "blue", "green", "white")


@dataclass(frozen=True, kw_only=True)
class Expectation:
    """What to expect of one way of asking in one world."""

    questions: float
    effort: float
    """The operator's time, in units of a yes or no."""
    worse: float
    """Probability of flying a plan that costs more than delta_c above the omniscient planner's."""


def random_problem(rng: np.random.Generator, regions: int, *, boxes: int = 1) -> PlanningProblem:
    """A hall with scattered obstacles, uncertain regions, and boxes of which one is meant, each as likely.

    It is drawn again until it can be flown.
    """
    while True:
        problem = _draw(rng, regions, boxes)
        try:
            GridPlanner().open(problem)
        except InfeasibleError:
            continue
        return problem


def first_situation(problem: PlanningProblem, settings: AskingSettings) -> Situation:
    """Before the first question."""
    return Situation(
        problem=problem,
        space=GridPlanner().open(problem),
        belief=prior_belief(problem.gaps),
        confirmed=frozenset(),
        withdrawn=frozenset(),
        asked=(),
        silent=False,
        settings=settings,
        metric=load("metric", settings.impact_metric)(),
        objective=load("objective", settings.objective)(),
    )


def expectation(strategy: Strategy, situation: Situation) -> Expectation:
    """Follows every answer, weighted by its probability; answers are true."""
    gaps = situation.problem.gaps
    truths = []
    for values in itertools.product(*(g.values for g in gaps)):
        p = math.prod(g.prior[g.values.index(v)] for g, v in zip(gaps, values, strict=True))
        truths.append((dict(zip((g.id for g in gaps), values, strict=True)), p))
    return _follow(strategy, situation, truths)


def answered(situation: Situation, query: Query, part: int) -> Situation:
    """The situation after an answer that names that part of the query, by the update that missions use."""
    before = BeliefState(
        map=situation.problem.map,
        belief=situation.belief,
        confirmed=situation.confirmed,
        withdrawn=situation.withdrawn,
        asked=situation.asked,
    )
    after = update(before, query, answer_for(query, part), situation.settings).state
    return replace(
        situation, belief=after.belief, confirmed=after.confirmed, withdrawn=after.withdrawn, asked=after.asked
    )


def _follow(strategy: Strategy, situation: Situation, truths: Sequence[tuple[Mapping[str, str], float]]) -> Expectation:
    decision = strategy.decide(situation)
    if isinstance(decision, Fly):
        worse = sum(p for truth, p in truths if _is_worse(decision, situation.space, truth, situation.settings))
        return Expectation(questions=0.0, effort=0.0, worse=worse)
    assert isinstance(decision, Ask)
    query = decision.scored.query
    asked = sum(p for _, p in truths)
    total = Expectation(questions=asked, effort=asked * query.effort, worse=0.0)
    for part in range(query.part_count):
        left = [(truth, p) for truth, p in truths if query.part_of(truth) == part]
        if left:
            # Some ways of asking remember what they found: each branch goes on with its own memory.
            below = _follow(copy.deepcopy(strategy), answered(situation, query, part), left)
            total = Expectation(
                questions=total.questions + below.questions,
                effort=total.effort + below.effort,
                worse=total.worse + below.worse,
            )
    return total


def _is_worse(decision: Fly, space: PlanSpace, truth: Mapping[str, str], settings: AskingSettings) -> bool:
    best = space.optimistic(Assumptions.exactly(truth))
    if decision.plan is None or best is None:
        return best is not None
    return decision.plan.cost_s > best.cost_s + settings.delta_c_s + TOLERANCE_S


def _draw(rng: np.random.Generator, count: int, boxes: int) -> PlanningProblem:
    height, width = SHAPE
    cells = np.where(rng.random((1, *SHAPE)) < 0.15, Cell.OCCUPIED, Cell.FREE).astype(np.uint8)
    start, goal = (0, int(rng.integers(height)), 0), (0, int(rng.integers(height)), width - 1)
    cells[start] = cells[goal] = Cell.FREE
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=1.0, shape=(1, *SHAPE))
    regions, gaps = [], []
    for i in range(count):
        tall, wide = int(rng.integers(4, 15)), int(rng.integers(2, 4))
        y, x = int(rng.integers(height - tall + 1)), int(rng.integers(2, width - 2 - wide))
        inside = np.zeros((1, *SHAPE), bool)
        inside[0, y : y + tall, x : x + wide] = True
        regions.append(Region(id=f"r{i}", kind=RegionKind.SMOKE, cells=np.flatnonzero(inside).astype(np.int64)))
        gaps.append(
            KnowledgeGap(
                id=obstacle_id(f"r{i}"),
                kind=GapKind.OBSTACLE,
                subject=f"r{i}",
                description=f"the grey smoke number {i + 1}",
                values=(PASSABLE, BLOCKED),
                prior=(0.5, 0.5),
                position_m=(x + wide / 2, y + tall / 2, 0.5),
            )
        )
    goals = [goal, *((0, int(rng.integers(height)), int(rng.integers(width // 2, width))) for _ in range(boxes - 1))]
    for cell in goals:
        cells[cell] = Cell.FREE
    (ax, ay, az), *places = (tuple(frame.centres_of([cell])[0].tolist()) for cell in (start, *goals))
    if boxes > 1:
        gaps.append(_which_box(places))
    sites = tuple(
        Site(position_m=place, reach_m=0.1, value=f"b{i}" if boxes > 1 else "") for i, place in enumerate(places)
    )
    stop = Stop(id="go", action=Action.GO, sites=sites, gap=BOX if boxes > 1 else "", dwell_s=0.0)
    return PlanningProblem(
        map=SemanticMap(frame=frame, cells=cells, regions=tuple(regions)),
        start_m=(ax, ay, az),
        stops=(stop,),
        gaps=tuple(gaps),
        limits=LIMITS,
    )


def _which_box(places: Sequence[Vec3]) -> KnowledgeGap:
    """Which box is meant: each has a colour and a size, and a name of its own."""
    candidates = []
    for i, place in enumerate(places):
        colour, size = COLOURS[i % len(COLOURS)], ("small", "large")[i // 2 % 2]
        attributes = (Attribute(name="colour", value=colour), Attribute(name="size", value=size))
        words = f"the {size} {colour} box"
        candidates.append(Candidate(id=f"b{i}", position_m=place, attributes=attributes, description=words))
    return KnowledgeGap(
        id=BOX,
        kind=GapKind.TARGET,
        subject="the box",
        description="the box",
        values=tuple(c.id for c in candidates),
        prior=(1 / len(candidates),) * len(candidates),
        position_m=places[0],
        candidates=tuple(candidates),
    )
