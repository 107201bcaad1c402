"""A mission without flight: a strategy asks, the truth answers, until it flies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mintpilot.assembly.registry import load
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Ask, Fly, QueryObjective, Situation, Strategy
from mintpilot.core.query import Answer, Query, Reply, answer_for
from mintpilot.mission.belief_state import BeliefState, update
from mintpilot.reasoning.belief import prior_belief
from oracles.worlds import BruteForce, World

TOO_MANY = 200


@dataclass(frozen=True)
class Game:
    """How one mission went up to the flight."""

    queries: tuple[Query, ...]
    fly: Fly
    situation: Situation

    @property
    def questions(self) -> int:
        return len(self.queries)


def open_situation(
    world: World,
    settings: AskingSettings,
    *,
    objective: QueryObjective | None = None,
    space: BruteForce | None = None,
    groups: tuple = (),
) -> Situation:
    """The situation before the first question."""
    return Situation(
        problem=world.problem(),
        space=space or BruteForce(world),
        belief=prior_belief(world.gaps, groups),
        confirmed=frozenset(),
        withdrawn=frozenset(),
        asked=(),
        silent=False,
        settings=settings,
        metric=load("metric", settings.impact_metric)(),
        objective=objective or load("objective", settings.objective)(),
    )


def told(situation: Situation, query: Query, answer: Answer | Reply, attempts: tuple[str, ...] = ()) -> Situation:
    """The situation after an answer, by the update that is shipped.

    Args:
        situation: before the answer.
        query: what was asked.
        answer: what came back; a bare reply takes no time.
        attempts: ids of the queries that were put before.
    """
    before = BeliefState(
        map=situation.problem.map,
        belief=situation.belief,
        confirmed=situation.confirmed,
        withdrawn=situation.withdrawn,
        asked=situation.asked,
        attempts=attempts,
        silent=situation.silent,
    )
    given = Answer(reply=answer, latency_s=0.0) if isinstance(answer, Reply) else answer
    after = update(before, query, given, situation.settings).state
    return replace(
        situation,
        belief=after.belief,
        confirmed=after.confirmed,
        withdrawn=after.withdrawn,
        asked=after.asked,
        silent=after.silent,
        settings=replace(situation.settings, max_questions=max(0, situation.settings.question_budget - 1)),
    )


def play(
    strategy: Strategy,
    situation: Situation,
    truth: dict[str, str],
    *,
    rng: np.random.Generator | None = None,
) -> Game:
    """Plays to the end; with ``rng`` answers are wrong with the situation's answer error."""
    queries: list[Query] = []
    for _ in range(TOO_MANY):
        decision = strategy.decide(situation)
        if not isinstance(decision, Ask):
            return Game(tuple(queries), decision, situation)
        query = decision.scored.query
        part = query.part_of(truth)
        if rng is not None and rng.random() < situation.settings.answer_error:
            part = (part + int(rng.integers(1, query.part_count))) % query.part_count
        situation = told(situation, query, answer_for(query, part), tuple(q.id for q in queries))
        queries.append(query)
    raise AssertionError(f"still asking after {TOO_MANY} questions")
