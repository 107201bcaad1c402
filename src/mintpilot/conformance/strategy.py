"""Checks of methods of asking, and of what they weigh questions by."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from mintpilot.assembly.registry import load
from mintpilot.conformance.sample import require, sample_world
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Fly, QueryObjective, QuerySituation, Strategy
from mintpilot.core.query import CHOICE_EFFORT, Answer, Query, Reply, answer_for, is_refused
from mintpilot.mission.deliberation import Deliberation, DeliberationParts
from mintpilot.mission.rehearsal import Rehearsal, begin

_BUDGET = 8
_ENDURANCE_S = 120.0


def check_strategy(make: Callable[[], Strategy]) -> None:
    """Plays small missions against every truth: questions about what is open only, an end, and no unsafe plan.

    Args:
        make: makes a fresh strategy; called more than once.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Strategy`.
    """
    settings = replace(sample_world().mission.asking, max_questions=_BUDGET)
    gaps = _begin(make(), settings).deliberated().findings.gaps
    asked = [list(_play(make(), truth, settings)) for truth in _truths(gaps)]
    again = list(_play(make(), next(_truths(gaps)), settings))
    rule = f"asked {asked[0]} and then {again} under the same truth; the same seed must give the same questions"
    require(asked[0] == again, make(), rule)
    _check_silence(make(), settings)
    _check_doubt(make(), settings)
    first = _begin(make(), replace(settings, max_questions=0)).deliberated()
    require(isinstance(first.decision, Fly), make(), "it asks though the budget is 0 questions; it must fly, or stay")


def check_objective(make: Callable[[], QueryObjective]) -> None:
    """One number for each query, the same each time, and nothing for a query that tells nothing of the plan.

    Args:
        make: makes a fresh objective; called more than once.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.QueryObjective`.
    """
    probability = np.array([0.25, 0.25, 0.2, 0.15, 0.1, 0.05])
    class_of = np.array([0, 0, 1, 1, 2, 2])
    parts = np.array(
        [[0, 0, 1, 1, 1, 1], [0, 1, 0, 1, 0, 1], [1, 1, 0, 0, 1, 1], [0] * 6, [1] * 6, [0, 0, 1, 1, 2, 2], [2] * 6],
        np.int8,
    )
    part_count = np.array([2, 2, 2, 2, 2, 3, 3])
    effort = np.where(part_count > 2, CHOICE_EFFORT, 1.0)
    regret = np.where(class_of[None, :] == np.arange(3)[:, None], 0.0, 20.0)
    situation = QuerySituation(
        probability=probability,
        class_of=class_of,
        regret_s=regret,
        parts=parts,
        part_count=part_count,
        effort=effort,
        settings=AskingSettings(),
    )
    objective = make()
    scores = objective.scores(situation)
    rule = f"scores of shape {scores.shape} for {len(parts)} queries; one number for each it must be"
    require(scores.shape == (len(parts),), objective, rule)
    require(bool(np.isfinite(scores).all()), objective, f"scores {scores.tolist()} are not all finite")
    again = make().scores(situation)
    require(
        np.array_equal(scores, again), objective, f"a fresh one gives {again.tolist()} instead of {scores.tolist()}"
    )
    for index, what in ((3, "yes"), (4, "no"), (6, "by its third option")):
        rule = f"a query that is always answered {what} scores {scores[index]:g}; what tells nothing scores 0 or less"
        require(scores[index] <= 1e-9, objective, rule)
    require(float(scores[0]) > 0, objective, f"the query that settles a plan scores {scores[0]:g}; above 0 it must be")
    require(float(scores[5]) > 0, objective, f"the choice among the plans scores {scores[5]:g}; above 0 it must be")
    settled = QuerySituation(
        probability=np.array([0.5, 0.5]),
        class_of=np.array([0, 0]),
        regret_s=np.zeros((1, 2)),
        parts=np.array([[0, 1]], np.int8),
        part_count=np.array([2]),
        effort=np.ones(1),
        settings=AskingSettings(),
    )
    left = float(make().scores(settled)[0])
    require(left <= 1e-9, objective, f"one plan is left, yet a query still scores {left:g}; 0 or less it must be")


def _truths(gaps: tuple[KnowledgeGap, ...]) -> Iterator[Mapping[str, str]]:
    for values in itertools.product(*(gap.values for gap in gaps)):
        yield dict(zip((gap.id for gap in gaps), values, strict=True))


def _play(strategy: Strategy, truth: Mapping[str, str], settings: AskingSettings) -> Iterator[str]:
    """The questions of one mission under that truth, up to the decision to fly."""
    moment = _begin(strategy, settings)
    for asked in itertools.count():
        found = moment.deliberated()
        if isinstance(found.decision, Fly):
            _check_flight(found, found.decision, strategy)
            return
        require(asked < _BUDGET, strategy, f"it asks on after {asked} questions, the whole budget")
        query = found.decision.scored.query
        _check_query(query, found, strategy)
        moment = moment.asked(found).answered(answer_for(query, query.part_of(truth)))
        yield query.id


def _check_query(query: Query, found: Deliberation, strategy: Strategy) -> None:
    open_gaps = {gap.id for gap in found.findings.gaps}
    closed = sorted(set(query.gap_ids) - open_gaps)
    require(not closed, strategy, f"it asks about {closed}, which are no open gaps ({sorted(open_gaps)})")
    repeated = query.id in {earlier.query.id for earlier in found.state.asked}
    require(not repeated, strategy, f"it asks '{query.id}' again, though the answer is known")


def _check_flight(found: Deliberation, fly: Fly, strategy: Strategy) -> None:
    if fly.plan is None or fly.unsafe:
        return
    kinds = {gap.id: gap.kind for gap in found.findings.gaps}
    entered = sorted(gap for gap in fly.plan.enters if kinds.get(gap) is GapKind.OBSTACLE)
    require(not entered, strategy, f"it flies into {entered}, not known to be passable, without saying `unsafe`")


def _check_silence(strategy: Strategy, settings: AskingSettings) -> None:
    moment = _begin(strategy, settings)
    found = moment.deliberated()
    if isinstance(found.decision, Fly):
        return
    silent = moment.asked(found).answered(Answer(reply=Reply.TIMEOUT, latency_s=0.0))
    asks = not isinstance(silent.deliberated().decision, Fly)
    require(not asks, strategy, "it asks though nobody answers; after a time-out it must fly, or stay")


def _check_doubt(strategy: Strategy, settings: AskingSettings) -> None:
    """Nobody knows anything: each query may be put once, and the asking must end."""
    moment, unsure = _begin(strategy, settings), Answer(reply=Reply.UNSURE, latency_s=0.0)
    for _ in range(2 * _BUDGET):
        found = moment.deliberated()
        if isinstance(found.decision, Fly):
            return
        query = found.decision.scored.query
        again = is_refused(query, found.state.withdrawn)
        require(not again, strategy, f"it asks '{query.id}' again, which was answered 'I do not know'")
        moment = moment.asked(found).answered(unsure)


def _begin(strategy: Strategy, settings: AskingSettings) -> Rehearsal:
    world = sample_world()
    limits = replace(world.mission.limits, endurance_s=_ENDURANCE_S)
    parts = DeliberationParts(
        mission=replace(world.mission, asking=settings, limits=limits),
        task=world.task,
        planner=load("planner", "grid")(),
        strategy=strategy,
        metric=load("metric", settings.impact_metric)(),
        objective=load("objective", settings.objective)(),
    )
    return begin(parts, world.map)
