"""What missions gave, under the one objective of method section 9: seconds of flight and prices of what is left."""

from __future__ import annotations

from collections.abc import Sequence

from mintpilot.benchmark.experiment import Experiment, Part, Prices
from mintpilot.benchmark.intervals import student, wilson
from mintpilot.benchmark.records import TrialRecord, WorldRecord
from mintpilot.core.mission import Outcome

LOST = frozenset(o.value for o in (Outcome.COLLISION, Outcome.TOXIC_SMOKE, Outcome.ENDURANCE, Outcome.LEFT_VOLUME))
"""Endings in which the drone is lost: they count as one person more."""
TOLD = "told the truth"
"""Name of the row of the planner that is told the truth: no method costs less."""


class PricedRow(Part):
    """One method in the worlds of one cell; or the planner that is told the truth."""

    strategy: str
    n: int
    reached: int
    """People reached of those whom the planner that is told the truth reaches, world by world."""
    reachable: int
    reached_ci95: tuple[float, float]
    """Wilson's, of the share."""
    partial: int
    """Missions that ended having done a part, and said what they left."""
    questions: float
    operator_s: float
    """Seconds from questions shown to their answers, mean of a mission."""
    hidden_s: float
    """Of these, flown of what had to be flown anyway, mean."""
    cost_s: float
    """Flight, questions, people who were there and not reached, a lost drone; mean."""
    cost_ci95: tuple[float, float] | None


def priced_s(trial: TrialRecord, prices: Prices) -> float:
    """Cost of one mission, seconds."""
    lost = trial.people_there - trial.people_found + (trial.outcome in LOST)
    return trial.flight_s + prices.question_s * trial.questions + prices.failure_s * lost


def priced_rows(
    experiment: Experiment, trials: Sequence[TrialRecord], worlds: Sequence[WorldRecord], cell: str = ""
) -> list[PricedRow]:
    """One row for each method that flew, in the order of the configuration, that of the one told the truth last.

    Worlds of older records, in which nobody counted whom that planner reaches, are left out.
    """
    reachable = {w.seed: w.people_reachable for w in worlds if w.cell == cell and w.people_reachable is not None}
    mine = [t for t in trials if t.cell == cell and t.seed in reachable]
    names = [m.name for one in experiment.cells if one.name == cell for m in one.methods]
    rows = []
    for name in names:
        flown = [t for t in mine if t.method == name]
        if flown:
            rows.append(_row(name, flown, reachable, experiment.prices))
    there = {t.seed: t.people_there for t in mine}
    told = [w for w in worlds if w.cell == cell and w.seed in there]
    if told:
        rows.append(_told(told, there, experiment.prices))
    return rows


def _row(name: str, flown: Sequence[TrialRecord], reachable: dict[int, int], prices: Prices) -> PricedRow:
    n = len(flown)
    reached = sum(min(t.people_found, reachable[t.seed]) for t in flown)
    able = sum(reachable[t.seed] for t in flown)
    costs = [priced_s(t, prices) for t in flown]
    return PricedRow(
        strategy=name,
        n=n,
        reached=reached,
        reachable=able,
        reached_ci95=wilson(reached, able),
        partial=sum(t.outcome == Outcome.PARTIAL.value for t in flown),
        questions=sum(t.questions for t in flown) / n,
        operator_s=sum(t.waited_s for t in flown) / n,
        hidden_s=sum(t.hidden_s for t in flown) / n,
        cost_s=sum(costs) / n,
        cost_ci95=student(costs),
    )


def _told(worlds: Sequence[WorldRecord], there: dict[int, int], prices: Prices) -> PricedRow:
    able = sum(w.people_reachable or 0 for w in worlds)
    left = [there[w.seed] - (w.people_reachable or 0) for w in worlds]
    costs = [(w.best_s or 0.0) + prices.failure_s * missed for w, missed in zip(worlds, left, strict=True)]
    return PricedRow(
        strategy=TOLD,
        n=len(worlds),
        reached=able,
        reachable=able,
        reached_ci95=wilson(able, able),
        partial=sum(missed > 0 for missed in left),
        questions=0.0,
        operator_s=0.0,
        hidden_s=0.0,
        cost_s=sum(costs) / len(costs),
        cost_ci95=student(costs),
    )
