"""Table 1 again, by what missions gave: people reached, seconds of the person. `python -m bench.given RECORDS …`.

Each folder is made by `mintpilot bench table1 …`, which goes on where it was interrupted.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path

from bench.sections import Section, Table, keep
from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.intervals import clopper_pearson_upper
from mintpilot.benchmark.priced import PricedRow, priced_rows, priced_s
from mintpilot.benchmark.records import TrialRecord
from mintpilot.benchmark.store import read_config, read_records
from mintpilot.benchmark.summary import least_possible

HEADER = (
    "method", "worlds", "people reached of reachable", "partial", "questions, mean", "operator s, mean",
    "hidden s, mean", "cost, mean s",
)  # fmt: skip
SAFE = ("passive-conservative", "mint-unasked")
"""Never ask, and fly only what is known to be safe: the second also looks into rooms."""
LAWFUL = ("mint", "mint-paper", "optimal", "exhaustive")


def table(folder: Path) -> tuple[Table, Experiment, list[TrialRecord], float | None]:
    """The table of one folder, and what the notes are made of."""
    config = read_config(folder)
    trials, worlds = read_records(folder)
    whole = {w.seed for w in worlds if w.people_reachable is not None}
    methods = {m.name for cell in config.cells for m in cell.methods}
    for method in methods & {t.method for t in trials}:
        whole &= {t.seed for t in trials if t.method == method}  # paired: worlds that all of them flew in
    kept = [t for t in trials if t.seed in whole]
    rows = priced_rows(config, kept, [w for w in worlds if w.seed in whole])
    delay = f"the person takes {config.think} s" if config.think.most_s else "answers at once"
    caption = f"{config.vehicle}, {len(whole)} worlds from seed {config.seed}, {delay}"
    return (
        Table(caption=caption, header=HEADER, rows=[_words(row) for row in rows]),
        config,
        kept,
        least_possible([w for w in worlds if w.seed in whole]),
    )


def laws(config: Experiment, trials: Sequence[TrialRecord], where: str) -> Iterable[str]:
    """One note for each law of method section 9, with the number of worlds that break it."""
    by = {(t.seed, t.method): t for t in trials}
    seeds = sorted({t.seed for t in trials})
    for asks in LAWFUL:
        for never in SAFE:
            pairs = [(by[s, asks], by[s, never]) for s in seeds if (s, asks) in by and (s, never) in by]
            if not pairs:
                continue
            fewer = [a.seed for a, b in pairs if a.people_found < b.people_found]
            mean = sum(priced_s(a, config.prices) - priced_s(b, config.prices) for a, b in pairs) / len(pairs)
            named = f": {', '.join(str(s) for s in fewer[:8])}" if fewer else ""
            bound = 100 * clopper_pearson_upper(len(fewer), len(pairs))
            yield (
                f"{where}: `{asks}` reaches fewer people than `{never}` in {len(fewer)} of {len(pairs)} worlds"
                f"{named} (at most {bound:.2f} %, exact one-sided 95 %); its cost is {mean:+.1f} s on average."
            )


def _words(row: PricedRow) -> tuple[str, ...]:
    low, high = row.reached_ci95
    share = 100 * row.reached / max(1, row.reachable)
    costs = "" if row.cost_ci95 is None else f" [{row.cost_ci95[0]:.0f}, {row.cost_ci95[1]:.0f}]"
    return (
        row.strategy,
        str(row.n),
        f"{row.reached} of {row.reachable} = {share:.1f} % [{100 * low:.1f}, {100 * high:.1f}]",
        str(row.partial),
        f"{row.questions:.2f}",
        f"{row.operator_s:.1f}",
        f"{row.hidden_s:.1f}",
        f"{row.cost_s:.0f}{costs}",
    )


def main() -> None:
    """Writes the section from the folders given."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("records", type=Path, nargs="+")
    tables, notes, commands = [], [], []
    for folder in arguments.parse_args().records:
        made, config, trials, least = table(folder)
        tables.append(made)
        where = f"{config.vehicle}, {made.caption.rpartition(', ')[2]}"
        if config.think.most_s == 0:
            notes += laws(config, trials, where)
        if least is not None:
            notes.append(
                f"{where}: least possible questions, mean: {least:.3f} (exact, the same prices and tolerances)."
            )
        if any(t.outcome in ("raised", "timed-out", "crashed") for t in trials):
            notes.append(f"{where}: {sum(t.outcome in ('raised', 'timed-out', 'crashed') for t in trials)} broke down.")
        only = "".join(f" --only {m}" for m in sorted({t.method for t in trials}))
        commands.append(
            f"mintpilot bench table1 --vehicle {config.vehicle} --trials {config.trials} --seed {config.seed} "
            f"--think {config.think}{only} --out RECORDS"
        )
    keep(
        Section(
            name="30-table1-given",
            title="Table 1 again: what missions give",
            command=f"{'; '.join(commands)}; python -m bench.given RECORDS …",
            how="Table 1's worlds. *Reachable*: whom a planner that is told the truth reaches. *Operator s*: "
            "from questions shown to their answers. *Hidden*: of that, flown of what had to be flown anyway. Cost: "
            "seconds of flight + 10 s for each question + 600 s for each person there who was not reached, and for a "
            "lost drone. `optimal` asks by exact dynamic programming; `told the truth` is the least that anybody could "
            "pay; `mint-unasked` is `mint` with no questions. The laws (method, section 9) are counted where answers "
            "come at once. Fewer worlds than in the table above: those that there was time for.",
            tables=tables,
            notes=notes,
        )
    )


if __name__ == "__main__":
    main()
