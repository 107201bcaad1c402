"""Tables from records."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from mintpilot.benchmark.experiment import Experiment, Part, Prices
from mintpilot.benchmark.intervals import student, wilson
from mintpilot.benchmark.records import Stages, TrialRecord, WorldRecord

Interval = tuple[float, float]


class Row(Part):
    """One method in one cell."""

    cell: str
    strategy: str
    n: int
    success_rate: float
    success_ci95: Interval
    """Wilson's."""
    n_possible: int
    """Trials in worlds in which the planner that knows the truth finds a plan."""
    success_rate_possible: float | None
    """Of those."""
    success_possible_ci95: Interval
    mean_queries: float
    mean_queries_ci95: Interval | None
    """Student's t; None for one trial."""
    mean_queries_possible: float | None
    """In worlds in which the planner that knows the truth finds a plan."""
    mean_cost_s: float
    """Flight, questions and failures on one axis (`Prices`), seconds."""
    mean_cost_ci95: Interval | None
    mean_flight_s: float
    outcomes: dict[str, int]
    """How the trials ended."""
    latency_s: dict[str, float]
    """Median seconds from instruction to finished trajectories, by stage, and ``total``, over trials that flew."""


class GapShare(Part):
    """How often gaps of a kind really mattered."""

    cell: str
    kind: str
    gaps: int
    mattered: float
    """Share of which the value, the others being what they are, changes the best mission by more than delta_c."""
    mattered_ci95: Interval
    could_matter: float
    """Share that decides under some values of the others."""


class Summary(Part):
    """What the records of one experiment come to."""

    rows: tuple[Row, ...]
    worlds: int
    possible: int
    """Worlds in which the planner that knows the truth finds a plan."""
    least_possible_queries: float | None
    """Mean over the worlds of the fewest questions that any method needs on average over the truths that the prior
    allows (exact dynamic programming); None where some tree was too large."""
    gaps: tuple[GapShare, ...]


def cost_s(trial: TrialRecord, prices: Prices) -> float:
    """Flight seconds, plus the price of the questions, plus that of a failure."""
    return trial.flight_s + prices.question_s * trial.questions + (0.0 if trial.success else prices.failure_s)


def summarise(experiment: Experiment, trials: Sequence[TrialRecord], worlds: Sequence[WorldRecord]) -> Summary:
    """The tables; rows in the order of the configuration, with the records that are there."""
    possible = {(w.cell, w.seed) for w in worlds if w.possible}
    rows = []
    for cell in experiment.cells:
        for method in cell.methods:
            found = [t for t in trials if t.cell == cell.name and t.method == method.name]
            if found:
                rows.append(_row(cell.name, method.name, found, possible, experiment.prices))
    return Summary(
        rows=tuple(rows),
        worlds=len(worlds),
        possible=len(possible),
        least_possible_queries=least_possible(worlds),
        gaps=tuple(share for cell in experiment.cells for share in _gap_shares(cell.name, worlds)),
    )


def least_possible(worlds: Sequence[WorldRecord]) -> float | None:
    """Mean of the fewest expected questions; None where one of them is not known."""
    least = [w.least_questions for w in worlds]
    known = [value for value in least if value is not None]
    return sum(known) / len(known) if known and len(known) == len(least) else None


def latency_s(stages: Stages) -> float:
    """All stages together."""
    return float(sum(stages.model_dump().values()))


def _row(cell: str, method: str, trials: Sequence[TrialRecord], possible: set[tuple[str, int]], prices: Prices) -> Row:
    n, good = len(trials), sum(t.success for t in trials)
    can = [t for t in trials if (t.cell, t.seed) in possible]
    good_can = sum(t.success for t in can)
    costs = [cost_s(t, prices) for t in trials]
    queries = [float(t.questions) for t in trials]
    outcomes = sorted({t.outcome for t in trials})
    flew = [t for t in trials if t.flown_m > 0]
    stages = {name: median(getattr(t.stages_s, name) for t in flew) for name in Stages.model_fields} if flew else {}
    if flew:
        stages["total"] = median(latency_s(t.stages_s) for t in flew)
    return Row(
        cell=cell,
        strategy=method,
        n=n,
        success_rate=good / n,
        success_ci95=wilson(good, n),
        n_possible=len(can),
        success_rate_possible=good_can / len(can) if can else None,
        success_possible_ci95=wilson(good_can, len(can)),
        mean_queries=sum(queries) / n,
        mean_queries_ci95=student(queries),
        mean_queries_possible=sum(t.questions for t in can) / len(can) if can else None,
        mean_cost_s=sum(costs) / n,
        mean_cost_ci95=student(costs),
        mean_flight_s=sum(t.flight_s for t in trials) / n,
        outcomes={name: sum(t.outcome == name for t in trials) for name in outcomes},
        latency_s=stages,
    )


def _gap_shares(cell: str, worlds: Sequence[WorldRecord]) -> list[GapShare]:
    shares = []
    gaps = [gap for w in worlds if w.cell == cell for gap in w.gaps]
    for kind in sorted({gap.kind for gap in gaps}):
        same = [gap for gap in gaps if gap.kind == kind]
        real = sum(gap.mattered for gap in same)
        shares.append(
            GapShare(
                cell=cell,
                kind=kind,
                gaps=len(same),
                mattered=real / len(same),
                mattered_ci95=wilson(real, len(same)),
                could_matter=sum(gap.could_matter for gap in same) / len(same),
            )
        )
    return shares
