"""An ordered value: asked by thresholds, cut where plans change, flown under only after a yes (method, section 13)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from drivers.play import play
from mintpilot.assembly.registry import load
from mintpilot.core.gap import BLOCKED, PASSABLE, Assumptions, obstacle_id
from mintpilot.core.geometry import GridFrame
from mintpilot.core.mission import AskingSettings, QueryKinds
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import PlanningProblem, Site, Stop, VehicleLimits
from mintpilot.core.ports import Situation
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.core.task import Action
from mintpilot.core.threshold import ValueKind
from mintpilot.elicitation.candidates import candidate_queries
from mintpilot.elicitation.sentences import sentence
from mintpilot.mapping.values import Value, cut_by
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.reasoning.belief import prior_belief
from mintpilot.strategies.flying import tree_of
from mintpilot.strategies.mint import MintStrategy
from mintpilot.uncertainty.gaps import obstacle_gaps

FRAME = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.25, shape=(12, 16, 24))
LIMITS = VehicleLimits(radius_m=0.2, margin_m=0.05, cruise_mps=1.0)
EDGE = Value(id="edge", kind=ValueKind.CEILING, least_m=0.75, most_m=2.75, mean_m=1.6, sigma_m=0.5)
SETTINGS = AskingSettings(delta_c_s=0.0, alpha=0.0, floor=0.0, goal_entropy_bits=0.0, max_questions=60)
TRUTHS_M = (0.8, 1.1, 1.4, 1.6, 1.9, 2.3, 2.7)


def hall(detour: bool = True) -> tuple[SemanticMap, Region]:
    """A wall with a wide gate that smoke hangs in; far to the side there may be a way round."""
    cells = np.full(FRAME.shape, Cell.FREE, np.uint8)
    cells[:, 0 if not detour else 3 :, 11:13] = Cell.OCCUPIED
    cells[:, 5:13, 11:13] = Cell.FREE
    cells[:, :2, 11:13] = Cell.FREE if detour else Cell.OCCUPIED
    cells[:, 2, 11:13] = Cell.OCCUPIED
    inside = np.zeros(FRAME.shape, bool)
    inside[:, 5:13, 10:14] = True
    region = Region(
        id="smoke-1", kind=RegionKind.SMOKE, cells=np.flatnonzero(inside).astype(np.int64),
        description="the grey smoke in the gate",
    )  # fmt: skip
    return SemanticMap(frame=FRAME, cells=cells), region


def problem(detour: bool = True) -> tuple[PlanningProblem, tuple, tuple[Region, ...]]:
    bare, region = hall(detour)
    regions, group = cut_by(region, EDGE, FRAME, LIMITS)
    map = replace(bare, regions=regions)
    gaps = tuple(sorted(obstacle_gaps(map, (), prior_passable=0.5), key=lambda g: g.id))
    stop = Stop(id="go", action=Action.GO, sites=(Site(position_m=(5.4, 2.4, 2.4), reach_m=0.15),), dwell_s=0.0)
    made = PlanningProblem(map=map, start_m=(0.6, 2.4, 2.4), stops=(stop,), gaps=gaps, limits=LIMITS)
    return made, (group,), regions


def situation(detour: bool = True, kinds: QueryKinds = QueryKinds.YES_NO) -> tuple[Situation, tuple[Region, ...]]:
    made, groups, regions = problem(detour)
    settings = replace(SETTINGS, kinds=kinds)
    return Situation(
        problem=made, space=GridPlanner().open(made), belief=prior_belief(made.gaps, groups), confirmed=frozenset(),
        withdrawn=frozenset(), asked=(), silent=False, settings=settings,
        metric=load("metric", "frechet")(), objective=load("objective", settings.objective)(),
    ), regions  # fmt: skip


def truth_of(edge_m: float, regions: tuple[Region, ...]) -> dict[str, str]:
    return {
        obstacle_id(r.id): PASSABLE if edge_m >= r.threshold.at_least_m else BLOCKED
        for r in regions
        if r.passable is Knowledge.OPEN
    }


def omniscient_s(edge_m: float, detour: bool = True) -> float | None:
    """By a map in which the smoke reaches down to where it really does: no thresholds, no gaps."""
    bare, region = hall(detour)
    layer = np.unravel_index(region.cells, FRAME.shape)[0]
    smoke = region.cells[(layer + 1) * FRAME.resolution_m > edge_m + 1e-9]
    made, _, _ = problem(detour)
    known = replace(bare, regions=(replace(region, cells=smoke, passable=Knowledge.NO),))
    plan = GridPlanner().open(replace(made, map=known, gaps=())).optimistic(Assumptions())
    return None if plan is None else plan.cost_s


@pytest.mark.long
@pytest.mark.parametrize("kinds", list(QueryKinds))
@pytest.mark.parametrize("edge_m", TRUTHS_M)
def test_it_flies_as_the_omniscient_planner_does_and_only_where_a_yes_says_so(edge_m: float, kinds: QueryKinds) -> None:
    opening, regions = situation(kinds=kinds)
    game = play(MintStrategy(), opening, truth_of(edge_m, regions))
    assert game.fly.plan.cost_s == pytest.approx(omniscient_s(edge_m))
    assert game.fly.plan.enters <= game.situation.confirmed
    assert all(truth_of(edge_m, regions)[name] == PASSABLE for name in game.fly.plan.enters)


def test_plans_turn_on_few_of_the_thresholds_and_only_those_are_asked_about() -> None:
    opening, regions = situation()
    open_ = [r for r in regions if r.passable is Knowledge.OPEN]
    costs = [round(omniscient_s(r.threshold.at_least_m), 6) for r in open_]
    plans = len({omniscient_s(0.8), *costs})
    mint = tree_of(opening)
    assert len(mint.classes) <= plans + 1
    for query in candidate_queries(mint):
        text = sentence(query, {gap.id: gap for gap in mint.belief.gaps})
        top = max(opening.problem.gap(name).threshold.at_least_m for name in query.gap_ids)
        assert text == f"Is the lower edge of the grey smoke in the gate at least {top:g} m high?"


def test_below_the_least_value_it_flies_without_any_yes() -> None:
    opening, regions = situation(detour=False)
    game = play(MintStrategy(), opening, truth_of(EDGE.least_m, regions))
    assert game.fly.plan.cost_s == pytest.approx(omniscient_s(EDGE.least_m, detour=False))
    assert not game.fly.plan.enters


def test_what_is_not_known_is_not_flown_under() -> None:
    opening, _ = situation(detour=False)
    plan = opening.space.cautious(Assumptions())
    assert plan is not None
    assert plan.path_m[:, 2].min() + LIMITS.clearance_m <= EDGE.least_m


def test_a_choice_of_intervals_takes_one_question() -> None:
    opening, regions = situation(kinds=QueryKinds.ANY)
    choices = [q for q in candidate_queries(tree_of(opening), kinds=QueryKinds.ANY) if q.is_choice]
    for query in choices:
        parts = {query.part_of(truth_of(edge_m, regions)) for edge_m in TRUTHS_M}
        assert len(parts) > 1
