"""A target gap alone is the game of twenty questions: 24 people with attributes, one is meant."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench.question_games import answered
from mintpilot.assembly.registry import load
from mintpilot.core.gap import Assumptions, Candidate, GapKind, KnowledgeGap, target_id
from mintpilot.core.geometry import GridFrame
from mintpilot.core.mission import AskingSettings
from mintpilot.core.observation import Attribute
from mintpilot.core.plan import Leg, Plan, PlanningProblem, Site, Stop, VehicleLimits
from mintpilot.core.ports import Ask, Situation
from mintpilot.core.query import NO_PART, YES_PART
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Action
from mintpilot.reasoning.belief import prior_belief
from mintpilot.strategies.mint import MintStrategy

DATA = Path(__file__).resolve().parents[2] / "shared" / "data" / "twentyq" / "guess_who.json"


@dataclass(frozen=True, kw_only=True)
class TwentyQuestions:
    """What came of some games."""

    objective: str
    wrong: float
    """Share of wrong answers."""
    games: int
    questions: float
    """Mean number asked."""
    most: int
    right: float
    """Share of games in which the right person was named."""


class OneEach:
    """Each value of the one target gap has its own plan; all cost the same."""

    def __init__(self, gap: KnowledgeGap) -> None:
        self._gap = gap
        self.searches = 0

    def optimistic(self, given: Assumptions) -> Plan:
        possible = given.possible(self._gap)
        return self._plan(possible[0], len(possible) > 1)

    def cautious(self, given: Assumptions) -> Plan | None:
        possible = given.possible(self._gap)
        return self._plan(possible[0], False) if len(possible) == 1 else None

    def _plan(self, value: str, guessed: bool) -> Plan:
        place = float(self._gap.values.index(value))
        site = Site(position_m=(place, 0.0, 0.0), value=value)
        leg = Leg(
            stop=Stop(id="go", action=Action.GO, sites=(site,), dwell_s=0.0),
            site=site,
            path_m=np.array([[0.0, 1.0, 0.0], [place, 0.0, 0.0]]),
            length_m=1.0,
            duration_s=1.0,
        )
        relies = frozenset({self._gap.id}) if guessed else frozenset()
        return Plan(legs=(leg,), cost_s=1.0, relies_on=relies, enters=frozenset(), binds=((self._gap.id, value),))


def people() -> list[dict[str, Any]] | None:
    """The people of the game; None where the data are not there."""
    return json.loads(DATA.read_text()) if DATA.exists() else None


def person_gap(persons: list[dict[str, Any]]) -> KnowledgeGap:
    """Who is meant? Everybody is equally likely."""
    candidates = []
    for i, person in enumerate(persons):
        pairs = [(k, v) for k, vs in person.items() if k != "name" for v in (vs if isinstance(vs, list) else [vs])]
        attributes = tuple(Attribute(name=k, value=str(v)) for k, v in pairs)
        candidates.append(
            Candidate(
                id=person["name"], position_m=(float(i), 0.0, 0.0), attributes=attributes, description=person["name"]
            )
        )
    return KnowledgeGap(
        id=target_id(1, "person"),
        kind=GapKind.TARGET,
        subject="person",
        description="the person",
        values=tuple(c.id for c in candidates),
        prior=tuple([1 / len(candidates)] * len(candidates)),
        position_m=(0.0, 0.0, 0.0),
        candidates=tuple(candidates),
    )


def opening(gap: KnowledgeGap, settings: AskingSettings) -> Situation:
    """Before the first question. Nobody is told apart by where they stand."""
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=1.0, shape=(1, 1, 1))
    problem = PlanningProblem(
        map=SemanticMap(frame=frame, cells=np.ones((1, 1, 1), np.uint8)),
        start_m=(0.0, 0.0, 0.0),
        stops=(),
        gaps=(gap,),
        limits=VehicleLimits(),
    )
    return Situation(
        problem=problem,
        space=OneEach(gap),
        belief=prior_belief((gap,)),
        confirmed=frozenset(),
        withdrawn=frozenset(),
        asked=(),
        silent=False,
        settings=settings,
        metric=load("metric", "hausdorff")(),
        objective=load("objective", settings.objective)(),
    )


def play(situation: Situation, meant: str, rng: np.random.Generator) -> tuple[int, str]:
    """One game: the number of questions, and who was named."""
    gap, strategy = situation.problem.gaps[0], MintStrategy()
    count = 0
    while isinstance(decision := strategy.decide(situation), Ask):
        query = decision.scored.query
        part = query.part_of({gap.id: meant})
        if rng.random() < situation.settings.answer_error:
            part = NO_PART if part == YES_PART else YES_PART
        situation, count = answered(situation, query, part), count + 1
    return count, dict(decision.plan.binds)[gap.id] if decision.plan else ""


def twenty_questions(objective: str, *, wrong: float, games: int = 0, seed: int = 0) -> TwentyQuestions:
    """Plays with everybody in turn; once each where all answers are right."""
    persons = people()
    assert persons is not None
    gap = person_gap(persons)
    settings = AskingSettings(
        objective=objective,
        answer_error=wrong,
        alpha=0.02 if wrong else 0.0,
        goal_entropy_bits=0.0,
        max_questions=200,
    )
    situation, rng = opening(gap, settings), np.random.default_rng(seed)
    results = []
    for i in range(games or len(gap.values)):
        meant = gap.values[i % len(gap.values)]
        count, named = play(situation, meant, rng)
        results.append((count, named == meant))
    counts = [count for count, _ in results]
    return TwentyQuestions(
        objective=objective,
        wrong=wrong,
        games=len(results),
        questions=float(np.mean(counts)),
        most=max(counts),
        right=float(np.mean([right for _, right in results])),
    )
