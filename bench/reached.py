"""People reached, against never asking, into docs/results.md. `python -m bench.reached RECORDS`.

Records are made by
`mintpilot bench table1 --trials 1000 --seed 30000 --only mint --only passive-conservative --think 0 --out RECORDS`.
"""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path

from bench.sections import Section, Table, keep
from mintpilot.benchmark.intervals import clopper_pearson_upper, wilson
from mintpilot.benchmark.store import read_config, read_records

ASKS, NEVER = "mint", "passive-conservative"


def main() -> None:
    """Compares the two methods world by world, and writes the section."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("records", type=Path)
    folder: Path = arguments.parse_args().records
    config = read_config(folder)
    trials, worlds = read_records(folder)
    by = {(trial.seed, trial.method): trial for trial in trials}
    seeds = sorted(seed for seed, method in by if method == ASKS and (seed, NEVER) in by)
    fewer = [s for s in seeds if by[s, ASKS].people_found < by[s, NEVER].people_found]
    rows = []
    for method in (ASKS, NEVER):
        flown = [by[seed, method] for seed in seeds]
        found, there = sum(t.people_found for t in flown), sum(t.people_there for t in flown)
        low, high = wilson(found, there)
        ends = Counter(t.outcome for t in flown)
        questions = sum(t.questions for t in flown) / len(flown)
        rows.append(
            (
                method,
                str(len(flown)),
                f"{found} of {there} = {100 * found / there:.1f} % [{100 * low:.1f}, {100 * high:.1f}]",
                ", ".join(f"{name} {count}" for name, count in sorted(ends.items())),
                f"{questions:.2f}",
            )
        )
    bound = 100 * clopper_pearson_upper(len(fewer), len(seeds))
    keep(
        Section(
            name="30-reached",
            title="Missions that give what they can: people reached",
            command=f"mintpilot bench table1 --trials {config.trials} --seed {config.seed} --only {ASKS} "
            f"--only {NEVER} --think 0 --out RECORDS; python -m bench.reached RECORDS",
            how="Table 1's worlds on the kinematic simulator, batteries as they are drawn, right answers at once. "
            "Somebody counts as reached by the simulator's judge.",
            tables=(
                Table(
                    caption="",
                    header=("method", "worlds", "people reached of those who are there", "endings", "questions, mean"),
                    rows=rows,
                ),
            ),
            notes=(
                f"Worlds in which fewer people are reached than by never asking: {len(fewer)} of {len(seeds)} "
                f"(at most {bound:.2f} %, exact one-sided 95 %).",
                f"In {sum(w.possible for w in worlds)} of {len(worlds)} worlds a planner that is told the truth finds "
                "a plan for somebody.",
            ),
        )
    )


if __name__ == "__main__":
    main()
