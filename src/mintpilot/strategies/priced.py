"""A question is put only where asking on is better than acting now, its price counted (method, section 11)."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import Mint, StopReason
from mintpilot.elicitation.candidates import candidate_queries
from mintpilot.elicitation.partitions import part_row
from mintpilot.reasoning.situation import plans_of, regret_matrix
from mintpilot.strategies.flying import answerable, best_safe_plan, fly, may_be_flown, questions_left

MAX_POLICIES = 4000
"""So many sets of hypotheses are looked at; beyond, an answer is taken to tell all: the bound stays a bound."""


class CountsPrice(Strategy):
    """Decides as another strategy does, but flies where no policy of asking is better than acting now.

    Args:
        strategy: decides.
    """

    def __init__(self, strategy: Strategy) -> None:
        self.strategy = strategy

    def decide(self, situation: Situation) -> Decision:
        """See `Strategy.decide`. Nothing is changed where questions have no price."""
        decision = self.strategy.decide(situation)
        mint = decision.mint
        if not isinstance(decision, Ask) or mint is None or situation.settings.question_price_s <= 0:
            return decision
        acting_s, asking_s = worth_s(situation, mint)
        if asking_s < acting_s - TOLERANCE:
            return decision
        safe = best_safe_plan(situation, mint)
        return fly(situation, mint, safe, StopReason.PRICE, best_gain_bits=decision.scored.gain_bits)


def worth_s(situation: Situation, mint: Mint) -> tuple[float, float]:
    """Expected regret, seconds: of acting now, and of the best policy that asks at least once, prices included.

    The policy is looked ahead to its end over the tree's hypotheses, with right answers: where even that is no better
    than acting, no policy is.
    """
    regret_s = regret_matrix(mint, situation.settings)
    support = mint.support
    mass = mint.belief.probability.ravel()[support]
    mass = mass / mass.sum()
    flown = [
        i for i, plan in enumerate(plans_of(mint)[: len(regret_s)]) if plan is None or may_be_flown(situation, plan)
    ]
    acting_s = float((regret_s[flown] @ mass).min()) if flown else float("inf")
    queries = candidate_queries(
        mint, start_m=situation.problem.start_m, refused=situation.withdrawn, kinds=situation.settings.kinds
    )
    rows = [(query.effort, part_row(query, mint.belief)[support]) for query in answerable(queries, situation)]
    ahead = _Ahead(regret_s, mass, rows, situation.settings.question_price_s)
    return acting_s, ahead.asking_s(np.ones(support.size, bool), questions_left(situation))


class _Ahead:
    """The best policies over sets of hypotheses, each worked out once."""

    def __init__(self, regret_s: Floats, mass: Floats, rows: list[tuple[float, np.ndarray]], price_s: float) -> None:
        self._loss = regret_s * mass
        self._mass, self._price_s = mass, price_s
        # Of queries that divide alike the one of least effort stays.
        self._splits = list({row.tobytes(): (effort, row) for effort, row in sorted(rows, key=_effort)[::-1]}.values())
        self._known: dict[tuple[bytes, int], float] = {}

    def asking_s(self, held: Bools, left: int) -> float:
        """Expected loss of asking at least once among these hypotheses, weighted with their mass."""
        if left <= 0:
            return float("inf")
        price_s = self._price_s * float(self._mass[held].sum())
        if len(self._known) >= MAX_POLICIES:
            return price_s + float(self._loss[:, held].min(axis=0).sum())
        best = float("inf")
        for effort, row in self._splits:
            parts = [held & (row == part) for part in np.unique(row[held])]
            if len(parts) > 1:
                best = min(best, effort * price_s + sum(self._best_s(part, left - 1) for part in parts))
        return best

    def _best_s(self, held: Bools, left: int) -> float:
        """The same of the better of acting and asking."""
        key = (held.tobytes(), left)
        if key not in self._known:
            acting_s = float(self._loss[:, held].sum(axis=1).min())
            self._known[key] = acting_s
            if acting_s > self._price_s * float(self._mass[held].sum()) + TOLERANCE:
                self._known[key] = min(acting_s, self.asking_s(held, left))
        return self._known[key]


def _effort(row: tuple[float, np.ndarray]) -> float:
    return row[0]
