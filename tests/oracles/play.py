"""A mission without flight: a strategy asks, the truth answers, until it flies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mintpilot.assembly.registry import load
from mintpilot.core.gap import GapKind
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Ask, Fly, QueryObjective, Situation, Strategy
from mintpilot.core.query import Combine, Query, Reply
from mintpilot.reasoning.belief import condition, prior_belief

from .worlds import BruteForce, World

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


def told(situation: Situation, query: Query, reply: Reply) -> Situation:
    """The situation after a reply, as the loop makes it."""
    if reply is Reply.TIMEOUT:
        return replace(situation, silent=True)
    if reply is Reply.UNSURE:
        return replace(situation, withdrawn=situation.withdrawn | {query.id})
    update = condition(situation.belief, query, reply, situation.settings.answer_error)
    if update.contradiction:
        return replace(situation, withdrawn=situation.withdrawn | {query.id})
    sure = len(query.literals) == 1 or query.combine is Combine.ALL
    kinds = {g.id: g.kind for g in situation.belief.gaps}
    named = {x.gap for x in query.literals if kinds[x.gap] is GapKind.OBSTACLE and x.values == {"passable"}}
    return replace(
        situation,
        belief=update.belief,
        confirmed=situation.confirmed | (named if sure and reply is Reply.YES else frozenset()),
        asked=(*situation.asked, (query, reply is Reply.YES)),
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
        yes = query.holds(truth)
        if rng is not None and rng.random() < situation.settings.answer_error:
            yes = not yes
        queries.append(query)
        situation = told(situation, query, Reply.YES if yes else Reply.NO)
    raise AssertionError(f"still asking after {TOO_MANY} questions")
