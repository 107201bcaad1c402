"""A Gymnasium environment: learn when to ask and when to commit.

``import mintpilot.gym`` enters it as ``mintpilot/Elicitation-v0``.

One episode is one world of a scenario and its mission on the map of a perfect survey, with a person who answers after
the truth. Action 0 commits: the safe plan that loses least on average is flown. Action i asks the best question about
gap i. The reward is the negative of the cost axis of the benchmark: a question's price for each question, and at last
the seconds of flight, or the price of failure. The observation is the belief and what it costs (`GAP_FEATURES`,
`COSTS`). All seconds are scaled by 1/100, so that returns are of the order of one.
"""

from __future__ import annotations

import functools
from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, TypeAlias, cast

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from mintpilot.assembly.components import Choices, deliberation_parts, scripted_operator
from mintpilot.assembly.worlds import World
from mintpilot.benchmark.conditions import true_world
from mintpilot.benchmark.experiment import Cell, Prices
from mintpilot.core.errors import InfeasibleError, InputError
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Ask
from mintpilot.core.tree import LeafReason, Mint, Node, ScoredQuery
from mintpilot.mission.deliberation import Deliberation, DeliberationParts
from mintpilot.mission.rehearsal import Rehearsal, begin
from mintpilot.mission_file.schema import OperatorSpec
from mintpilot.reasoning.classes import demands
from mintpilot.strategies.exhaustive import best_about
from mintpilot.strategies.flying import best_safe_plan, expected_cost_s, tree_of

SCALE: Final = 0.01
KINDS: Final = tuple(GapKind)
GAP_FEATURES: Final = ("kind", "first value", "branched on", "gain", "regret saved")
"""Columns of ``gaps``: the kind as a share of all kinds; the probability of the gap's first value; whether the tree
branches on it; the bits that the best question about it tells, as a share of the most that its replies can tell; the
expected seconds of regret that the answer saves, scaled. Rows of gaps that are not there, or settled, are zero."""
COSTS: Final = ("commit now", "best case", "question", "failure", "questions left")
"""Entries of ``costs``: the expected cost of committing now, failure included; the cost of the plan that is best if all
goes well; the prices of a question and of a failure, all scaled; and the share of the questions that are left."""
MOST: Final = 1000.0
"""Costs are cut off here, scaled."""
KEPT: Final = 1024
"""Moments that are kept, so that a world that comes again is not thought through again."""
Observation: TypeAlias = dict[str, NDArray[np.float32]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Moment:
    """Where an episode may be: a value, the same whenever the same answers were given in the same world."""

    world: World
    parts: DeliberationParts
    rehearsal: Rehearsal
    deliberation: Deliberation
    mint: Mint
    gaps: tuple[KnowledgeGap, ...]
    """Those at the start of the episode: what actions are about."""
    best: tuple[ScoredQuery | None, ...]
    """The best question about each of them."""
    commits: Plan | None
    """What is flown if no more is asked."""


class ElicitationEnv(gymnasium.Env[Observation, np.int64]):
    """Ask, or commit.

    ``observation_space``: ``gaps`` (max_gaps, 5) in 0..1, and ``costs`` (5,) in 0..1000, both float32.

    Args:
        scenario: name of the generator of worlds.
        parameters: the generator's own.
        worlds: numbers of the worlds that episodes are drawn from; each is thought through once and then comes fast.
            Learn on some and try on others.
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
        worlds: Sequence[int] = range(100),
        max_gaps: int = 4,
        max_questions: int = 10,
        answer_error: float = 0.0,
        prices: Prices | None = None,
        render_mode: str | None = None,
    ) -> None:
        if not worlds:
            raise InputError("worlds is empty; give the numbers of the worlds to draw from, e.g. range(100)")
        self.render_mode = render_mode
        self.action_space = spaces.Discrete(max_gaps + 1)
        seen: dict[str, spaces.Space[Any]] = {
            "gaps": spaces.Box(0.0, 1.0, (max_gaps, len(GAP_FEATURES)), np.float32),
            "costs": spaces.Box(0.0, MOST, (len(COSTS),), np.float32),
        }
        self.observation_space = cast("spaces.Space[Observation]", spaces.Dict(seen))
        self._cell = Cell(scenario=scenario, parameters=parameters or {}, methods=())
        self._worlds = worlds
        self._max_gaps, self._max_questions, self._error = max_gaps, max_questions, answer_error
        self._prices = prices or Prices()
        self._kept: OrderedDict[tuple[int, tuple[tuple[int, str], ...]], _Moment | None] = OrderedDict()
        self._said: tuple[tuple[int, str], ...] = ()
        self._line = ""

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """A new world. ``options={"world": n}`` names its number; else it is drawn from ``worlds``.

        Worlds in which nothing can be flown whatever the answers are skipped.

        Raises:
            InfeasibleError: that is so in the named world, or in all of ``worlds``.
        """
        super().reset(seed=seed)
        named = (options or {}).get("world")
        tried: set[int] = set()
        while True:
            number = self._worlds[int(self.np_random.integers(len(self._worlds)))] if named is None else int(named)
            moment = self._recall((number, ()), functools.partial(self._begun, number))
            if moment is not None:
                break
            tried.add(number)
            if named is not None or len(tried) == len(set(self._worlds)):
                which = f"world {number}" if named is not None else "all worlds"
                raise InfeasibleError(f"{which}: nothing can be flown, whatever the answers are; give another one")
        self._number, self._said, self._moment = number, (), moment
        self._truth = {gap.id: moment.world.truth.value_of(gap) for gap in moment.gaps}
        self._operator = scripted_operator(moment.world, OperatorSpec(answer_error=self._error))
        self._questions = 0
        self._line = f"world {number}: {len(moment.gaps)} gaps"
        return self._observation(), self._info()

    def step(self, action: np.int64) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Commits (0), or asks the best question about a gap. Asking about none costs a question and tells nothing."""
        if int(action) == 0:
            plan = self._moment.commits
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

    def _recall(
        self, key: tuple[int, tuple[tuple[int, str], ...]], think: Callable[[], _Moment | None]
    ) -> _Moment | None:
        """The moment of that world after those answers; None: nothing can be flown there."""
        if key not in self._kept:
            self._kept[key] = think()
            if len(self._kept) > KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return self._kept[key]

    def _begun(self, number: int) -> _Moment | None:
        world = true_world(self._cell, number)
        asking = replace(world.mission.asking, answer_error=self._error)
        world = replace(world, mission=replace(world.mission, asking=asking))
        parts = deliberation_parts(world, Choices())
        moment = self._thought(world, parts, begin(parts, world.map), None)
        return None if moment is None or moment.mint.root.leaf is LeafReason.INFEASIBLE else moment

    def _thought(
        self, world: World, parts: DeliberationParts, rehearsal: Rehearsal, gaps: tuple[KnowledgeGap, ...] | None
    ) -> _Moment | None:
        try:
            thought = rehearsal.deliberated()
        except InfeasibleError:
            return None
        mint = tree_of(thought.situation)
        fresh = {gap.id: gap for gap in thought.findings.gaps}
        gaps = thought.findings.gaps if gaps is None else gaps
        about = (fresh.get(gap.id) for gap in gaps)
        return _Moment(
            world=world,
            parts=parts,
            rehearsal=rehearsal,
            deliberation=thought,
            mint=mint,
            gaps=gaps,
            best=tuple(None if gap is None else best_about(gap, thought.situation) for gap in about),
            commits=best_safe_plan(thought.situation, mint),
        )

    def _ask(self, index: int) -> bool:
        """Puts the best question about that gap; False where nothing can be flown after the answer."""
        now = self._moment
        scored = now.best[index] if index < len(now.best) else None
        if scored is None:
            self._line = "asked about nothing that is open"
            return True
        put = now.rehearsal.asked(replace(now.deliberation, decision=Ask(scored=scored, mint=now.mint)))
        question = put.question
        assert question is not None
        answer = self._operator.answer(question, now.world.mission.asking.patience_s)
        said = question.query.part_words(answer.part) if answer.part is not None else answer.reply.value
        self._line = f"{question.text} {said}"
        self._said = (*self._said, (index, said))
        after = self._recall(
            (self._number, self._said), lambda: self._thought(now.world, now.parts, put.answered(answer), now.gaps)
        )
        if after is None:
            return False
        self._moment = after
        return True

    def _succeeds(self, plan: Plan) -> bool:
        """Whether everything that the plan rests on is so."""
        return all(self._truth.get(gap, value) == value for gap, value in demands(plan).items())

    def _observation(self) -> Observation:
        now = self._moment
        gaps = np.zeros((self._max_gaps, len(GAP_FEATURES)), np.float32)
        belief, branched = now.deliberation.situation.belief, _branched(now.mint.root)
        known = {gap.id for gap in belief.gaps}
        for row, gap, best in zip(gaps, now.gaps, now.best, strict=False):
            row[0] = (1 + KINDS.index(gap.kind)) / len(KINDS)
            if gap.id in known:
                row[1] = belief.marginal(gap.id)[0]
                row[2] = gap.id in branched
            if best is not None:
                row[3] = best.gain_bits / np.log2(best.query.part_count)
                row[4] = SCALE * best.regret_saved_s
        return {"gaps": np.clip(gaps, 0.0, 1.0), "costs": self._costs()}

    def _costs(self) -> NDArray[np.float32]:
        now, failure_s = self._moment, self._prices.failure_s
        best = now.mint.root.optimistic
        commits = failure_s
        if now.commits is not None:
            situation = now.deliberation.situation
            priced = replace(situation, settings=replace(situation.settings, failure_price_s=failure_s))
            commits = expected_cost_s(priced, now.mint, now.commits)
        seconds = np.array([commits, failure_s if best is None else best.cost_s, self._prices.question_s, failure_s])
        left = max(0.0, 1.0 - self._questions / self._max_questions)
        costs: NDArray[np.float32] = np.clip(np.append(SCALE * seconds, left), 0.0, MOST).astype(np.float32)
        return costs

    def _info(self) -> dict[str, Any]:
        return {"world": self._number, "gaps": [gap.id for gap in self._moment.gaps], "questions": self._questions}


def _branched(node: Node) -> set[str]:
    below = {gap for child in node.children for gap in _branched(child)}
    return below | ({node.branch_on} if node.branch_on else set())
