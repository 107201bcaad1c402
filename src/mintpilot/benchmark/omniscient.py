"""The planner that is told the truth, and what a world's gaps are really worth."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import World
from mintpilot.benchmark.records import GapTruth, WorldRecord
from mintpilot.benchmark.warm import WarmPlanner
from mintpilot.core.errors import InfeasibleError, LimitError
from mintpilot.core.gap import Assumptions, KnowledgeGap
from mintpilot.core.mission import AskingSettings
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Ask, PlanSpace
from mintpilot.core.tree import Node
from mintpilot.elicitation.objectives.optimal import Optimal
from mintpilot.mission.deliberation import Deliberation, DeliberationParts
from mintpilot.mission.rehearsal import begin
from mintpilot.reasoning.classes import least_cost_s
from mintpilot.simulation.judge import SceneJudge

PERSON_M = 0.3
"""Half the edge of a person's mark in pictures."""
MAX_STATES = 5000
"""Bound on the exact programme for the fewest questions; larger trees have no figure."""


def survey_world(world: World, *, experiment: str, cell: str, planner: WarmPlanner | None = None) -> WorldRecord:
    """The record of a world: what is possible in it, and which of its gaps matter.

    Args:
        world: as it is, its map that of a perfect survey.
        experiment: name for the record.
        cell: name for the record.
        planner: shares plans with the missions in this world.
    """
    parts = deliberation_parts(world, Choices())
    if planner is not None:
        parts = replace(parts, planner=planner)
    (x0, y0, _), (x1, y1, _) = world.scene.volume.lo_m, world.scene.volume.hi_m
    outline = (x0, y0, x1, y1)
    boxes = tuple(_seen_from_above(world))
    try:
        thought = _thought(world, parts)
    except InfeasibleError:
        thought = None
    if thought is None:
        return WorldRecord(
            experiment=experiment,
            cell=cell,
            seed=world.seed,
            possible=False,
            best_s=None,
            people_reachable=0,
            gaps=(),
            least_questions=0.0,
            outline_m=outline,
            boxes=boxes,
        )
    truths = {gap.id: world.truth.value_of(gap) for gap in thought.findings.gaps}
    given = Assumptions.exactly({gap: value for gap, value in truths.items() if value is not None})
    best = thought.situation.space.optimistic(given)
    tree = thought.decision.mint
    branched = _branched(tree.root) if tree is not None else set()
    return WorldRecord(
        experiment=experiment,
        cell=cell,
        seed=world.seed,
        possible=best is not None and not best.leaves_undone,
        best_s=best.cost_s if best else None,
        people_reachable=people_reached(best, world) if best else 0,
        gaps=tuple(
            GapTruth(
                id=gap.id,
                kind=gap.kind.value,
                truth=truths[gap.id],
                mattered=mattered(gap, given, thought.situation.space, parts.settings),
                could_matter=gap.id in branched,
            )
            for gap in thought.findings.gaps
        ),
        least_questions=_least_questions(world, parts),
        outline_m=outline,
        boxes=boxes,
    )


def people_reached(plan: Plan, world: World) -> int:
    """How many of the people who need help are reached where the plan is flown as it is meant, by the judge's rules."""
    judge = SceneJudge(world.scene, world.rules)
    for leg in plan.legs:
        x, y, z = leg.path_m[-1]
        judge.acted(leg.stop, (float(x), float(y), float(z)))
    return judge.people()[0]


def mattered(gap: KnowledgeGap, given: Assumptions, space: PlanSpace, settings: AskingSettings) -> bool:
    """Whether the best plan's cost differs by more than delta_c between the gap's values, the others as given.

    For a target gap: whether its values lead to different places at all, since any other one is the wrong one.
    """
    cases = [given.assume(gap.id, (value,)) for value in gap.values]
    plans = [space.optimistic(case) for case in cases]
    if any(dict(p.binds).get(gap.id) for p in plans if p is not None):
        return len(gap.values) > 1
    costs = [_cost(plan, case) for plan, case in zip(plans, cases, strict=True)]
    if len(set(costs)) <= 1:
        return False
    return max(costs) - min(costs) > settings.delta_c_s


def _thought(world: World, parts: DeliberationParts) -> Deliberation:
    return begin(parts, world.map).deliberated()


def _least_questions(world: World, parts: DeliberationParts) -> float | None:
    """Expected questions of the exact programme at the first deliberation."""
    try:
        decision = _thought(world, replace(parts, objective=Optimal(MAX_STATES))).decision
    except LimitError:
        return None
    return 1.0 / decision.scored.score if isinstance(decision, Ask) else 0.0


def _cost(plan: Plan | None, given: Assumptions) -> float:
    return least_cost_s(plan, given) if plan is not None else float("inf")


def _branched(node: Node) -> set[str]:
    below = {gap for child in node.children for gap in _branched(child)}
    return below | ({node.branch_on} if node.branch_on else set())


def _seen_from_above(world: World) -> list[tuple[str, float, float, float, float]]:
    scene = world.scene
    things = [(solid.kind, solid.extent_m) for solid in scene.solids]
    things += [("toxic smoke" if smoke.toxic else "harmless smoke", smoke.extent_m) for smoke in scene.smokes]
    things += [("occupied room" if room.occupant else "empty room", room.extent_m) for room in scene.rooms]
    flat = [(kind, box.lo_m[0], box.lo_m[1], box.hi_m[0], box.hi_m[1]) for kind, box in things]
    for person in scene.persons:
        x, y, _ = person.position_m
        flat.append(("person", x - PERSON_M, y - PERSON_M, x + PERSON_M, y + PERSON_M))
    return [(kind, round(a, 1), round(b, 1), round(c, 1), round(d, 1)) for kind, a, b, c, d in flat]
