"""One to eight gaps; answers and beliefs that are not perfect. `python -m bench.gaps [--trials 50] [--jobs 2]`."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from bench.experiments import Measured, above_optimal, arguments, failures, measure
from bench.sections import Section, Table, keep
from mintpilot.benchmark.experiments import CONDITIONS, MOST_GAPS, gaps
from mintpilot.benchmark.summary import Row
from mintpilot.benchmark.tables import percent

SWEEP = [f"k = {k}" for k in range(1, MOST_GAPS + 1)]
HOW = (
    "Scenario `fire-warehouse` with k gaps of mixed kinds: as many clouds as closed rooms, or one cloud more; all "
    "true priors 0.5. Each method flies in the same worlds. Every method is told the prices: a question counts as 10 "
    "s of flight, a failure as 600 s; *cost* is flight + questions + failures on that one axis, over all worlds, "
    "those included in which nobody can succeed. `information-gain` is `mint` with its defaults. `knowno` is a "
    "conformal asker, calibrated to 95 % coverage on 200 other worlds for each k (`python -m bench.calibrate`). "
    "`entropy-threshold` asks about every gap of more than half a bit. Conditions are at k = 4: the drone knows the "
    "rate of wrong answers unless the name says otherwise; a prior of 0.2 or 0.8 is believed of clouds to be safe "
    "and of rooms to be occupied while 0.5 is true; detections off: every cloud and thing is believed elsewhere, "
    "normal with 0.5 m in x and y. Success is counted over the worlds in which a planner that knows the truth finds "
    "a plan."
)


def section(measured: Measured, command: str) -> Section:
    """The section of docs/results.md."""
    others = [name for name, _ in CONDITIONS]
    tables = []
    for cells, what in ((SWEEP, "by number of gaps"), (others, "by condition, four gaps")):
        tables += [
            _matrix(measured, cells, f"Success where possible, {what}", _success),
            _matrix(measured, cells, f"Questions, mean, {what}", lambda row: f"{row.mean_queries:.2f}"),
            _matrix(measured, cells, f"Cost, mean seconds, {what}", lambda row: f"{row.mean_cost_s:.0f}"),
        ]
    notes = [f"{cell}: {above_optimal(measured, 'information-gain', cell)}" for cell in SWEEP]
    notes.append(
        "`optimal` is exact for answers that are believed right, and is left out where they are not. It counts "
        "questions only, asks until the plan is settled and knows nothing of their price. It also stops where 98 % of "
        "the mass says that nothing can be flown (`alpha` of method, section 5), while `mint` goes on as long as there "
        "is hope: with many gaps most worlds are nearly hopeless, and there `optimal` asks less and gives up more."
    )
    for row in measured.summary.rows:
        if row.strategy == "information-gain" and row.cell in others and row.success_rate_possible is not None:
            notes.append(
                f"{row.cell}: `information-gain` succeeds where possible in {_success(row)} of {row.n_possible}."
            )
    for cell in (*SWEEP, *others):
        notes += [f"{cell}: {line}" for line in failures(measured, "information-gain", cell, most=3)]
    notes += [measured.throughput] if measured.throughput else []
    return Section(
        name="32-gaps", title="More gaps, worse answers", command=command, how=HOW, tables=tables, notes=notes
    )


def _matrix(measured: Measured, cells: Sequence[str], caption: str, words: Callable[[Row], str]) -> Table:
    found = {(row.strategy, row.cell): row for row in measured.summary.rows}
    names = list(dict.fromkeys(row.strategy for row in measured.summary.rows))
    rows = [(name, *(words(found[name, cell]) if (name, cell) in found else "-" for cell in cells)) for name in names]
    return Table(caption=f"{caption} (n = {measured.experiment.trials} each)", header=("method", *cells), rows=rows)


def _success(row: Row) -> str:
    if row.success_rate_possible is None:
        return "-"
    lo, hi = row.success_possible_ci95
    return f"{percent(row.success_rate_possible)} [{100 * lo:.0f}, {100 * hi:.0f}]"


def main() -> None:
    """Measures, and keeps the section."""
    args = arguments(__doc__, (("trials", 50),))
    measured = measure(gaps(trials=args.trials, seed=args.seed, vehicle="kinematic"), args.jobs)
    made = section(measured, f"python -m bench.gaps --trials {args.trials} --seed {args.seed}")
    print(made.markdown()) if args.dry else keep(made)


if __name__ == "__main__":
    main()
