"""A Gymnasium environment: learn when to ask and when to commit.

``gymnasium.make("mintpilot/Elicitation-v0")`` works wherever MintPilot and gymnasium are installed: the environment is
entered through gymnasium's entry-point group, and on import of this module.

One episode is one world of a scenario and its mission on the map of a perfect survey, with a person who answers after
the truth. The observation is the belief: for each of up to ``max_gaps`` gaps its kind, the probability of its first
value, whether the tree branches on it, and the bits that the best question about it tells of it, as a share of the most
that its replies can tell. Action 0 commits: the safe plan that loses least on average is flown. Action i asks the best
question about gap i. The reward is the negative of the cost axis of the benchmark: a question's price for each
question, and in the end the seconds of flight, or the price of failure. Everything is scaled by 1/100, so that returns
are of the order of one.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, TypeAlias, cast

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from mintpilot.assembly.components import Choices, deliberation_parts, scripted_operator
from mintpilot.assembly.worlds import World
from mintpilot.benchmark.conditions import true_world
from mintpilot.benchmark.experiment import Cell, Prices
from mintpilot.benchmark.gym_entry import register
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Ask
from mintpilot.core.tree import LeafReason, Mint, Node, ScoredQuery
from mintpilot.mission.deliberation import Deliberation, DeliberationParts
from mintpilot.mission.rehearsal import Rehearsal, begin
from mintpilot.mission_file.schema import OperatorSpec
from mintpilot.reasoning.classes import demands
from mintpilot.strategies.exhaustive import best_about
from mintpilot.strategies.flying import best_safe_plan, tree_of

SCALE = 0.01
FEATURES = 4
KINDS = tuple(GapKind)
Observation: TypeAlias = NDArray[np.float32]


class ElicitationEnv(gymnasium.Env[Observation, np.int64]):
    """Ask, or commit.

    Args:
        scenario: name of the generator of worlds.
        parameters: the generator's own.
        max_gaps: gaps that the observation has room for; those beyond it cannot be asked about.
        max_questions: after so many questions the episode is truncated, at the price of a failure.
        answer_error: probability that an answer is the opposite of the truth; the belief knows it.
        prices: of questions and failures, seconds.
        render_mode: ``ansi`` for a line of text, or None.
    """

    metadata: dict[str, Any] = {"render_modes": ["ansi"], "render_fps": 1}  # noqa: RUF012  (gymnasium's own form)

    def __init__(
        self,
        scenario: str = "fire-warehouse",
        *,
        parameters: dict[str, float] | None = None,
        max_gaps: int = 4,
        max_questions: int = 10,
        answer_error: float = 0.0,
        prices: Prices | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.render_mode = render_mode
        self.action_space = spaces.Discrete(max_gaps + 1)
        box = spaces.Box(0.0, 1.0, (max_gaps, FEATURES), np.float32)
        self.observation_space = cast("spaces.Space[Observation]", box)
        self._cell = Cell(scenario=scenario, parameters=parameters or {}, methods=())
        self._max_gaps, self._max_questions, self._error = max_gaps, max_questions, answer_error
        self._prices = prices or Prices()
        self._line = ""

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """A new world. ``options={"world": n}`` names its seed; else it is drawn.

        Worlds in which nothing can be flown whatever the answers are skipped.
        """
        super().reset(seed=seed)
        named = (options or {}).get("world")
        while True:
            number = int(self.np_random.integers(2**31)) if named is None else int(named)
            try:
                self._begin(true_world(self._cell, number))
                break
            except InfeasibleError:
                if named is not None:
                    raise
        self._line = f"world {number}: {len(self._gaps)} gaps"
        return self._observation(), self._info()

    def step(self, action: np.int64) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Commits (0), or asks the best question about a gap. Asking about none costs a question and tells nothing."""
        if int(action) == 0:
            plan = best_safe_plan(self._thought.situation, self._mint)
            success = plan is not None and self._succeeds(plan)
            seconds = plan.cost_s if plan is not None else 0.0
            cost = seconds + (0.0 if success else self._prices.failure_s)
            self._line = f"committed: {'success' if success else 'failure'}, {seconds:.0f} s of flight"
            return self._observation(), -SCALE * cost, True, False, {**self._info(), "success": success}
        self._questions += 1
        cost = self._prices.question_s
        possible = self._ask(int(action) - 1)
        spent = self._questions >= self._max_questions
        if not possible or spent:
            cost += self._prices.failure_s
        return self._observation(), -SCALE * cost, not possible, possible and spent, self._info()

    def render(self) -> str | None:
        """What happened last, as a line of text."""
        return self._line if self.render_mode == "ansi" else None

    def _begin(self, world: World) -> None:
        asking = replace(world.mission.asking, answer_error=self._error)
        self._world = replace(world, mission=replace(world.mission, asking=asking))
        self._parts: DeliberationParts = deliberation_parts(self._world, Choices())
        person = OperatorSpec(answer_error=self._error)
        self._operator = scripted_operator(self._world, person)
        self._questions = 0
        self._think(begin(self._parts, world.map))
        if self._mint.root.leaf is LeafReason.INFEASIBLE:
            raise InfeasibleError(
                f"world {world.seed}: nothing can be flown, whatever the answers are; draw another one"
            )
        self._gaps: tuple[KnowledgeGap, ...] = self._thought.findings.gaps
        self._truth = {gap.id: world.truth.value_of(gap) for gap in self._gaps}

    def _think(self, moment: Rehearsal) -> None:
        self._moment = moment
        self._thought: Deliberation = moment.deliberated()
        self._mint: Mint = tree_of(self._thought.situation)

    def _ask(self, index: int) -> bool:
        """Puts the best question about that gap; False where nothing can be flown after the answer."""
        scored = self._best(index)
        if scored is None:
            self._line = "asked about nothing that is open"
            return True
        put = self._moment.asked(replace(self._thought, decision=Ask(scored=scored, mint=self._mint)))
        question = put.question
        assert question is not None
        answer = self._operator.answer(question, self._world.mission.asking.patience_s)
        said = question.query.part_words(answer.part) if answer.part is not None else answer.reply.value
        self._line = f"{question.text} {said}"
        try:
            self._think(put.answered(answer))
        except InfeasibleError:
            return False
        return True

    def _best(self, index: int) -> ScoredQuery | None:
        open_gaps = {gap.id: gap for gap in self._thought.findings.gaps}
        if index >= len(self._gaps) or self._gaps[index].id not in open_gaps:
            return None
        return best_about(open_gaps[self._gaps[index].id], self._thought.situation)

    def _succeeds(self, plan: Plan) -> bool:
        """Whether everything that the plan rests on is so."""
        return all(self._truth.get(gap, value) == value for gap, value in demands(plan).items())

    def _observation(self) -> Observation:
        seen = np.zeros((self._max_gaps, FEATURES), np.float32)
        belief, branched = self._thought.situation.belief, _branched(self._mint.root)
        known = {gap.id for gap in belief.gaps}
        for row, gap in zip(seen, self._gaps, strict=False):
            row[0] = (1 + KINDS.index(gap.kind)) / len(KINDS)
            if gap.id in known:
                row[1] = belief.marginal(gap.id)[0]
                row[2] = gap.id in branched
                best = best_about(gap, self._thought.situation)
                row[3] = best.gain_bits / np.log2(best.query.part_count) if best is not None else 0.0
        clipped: Observation = np.clip(seen, 0.0, 1.0)
        return clipped

    def _info(self) -> dict[str, Any]:
        return {"world": self._world.seed, "gaps": [gap.id for gap in self._gaps], "questions": self._questions}


def _branched(node: Node) -> set[str]:
    below = {gap for child in node.children for gap in _branched(child)}
    return below | ({node.branch_on} if node.branch_on else set())


register()
