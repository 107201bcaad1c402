"""What a person may rely on, into docs/results.md. `python -m bench.trust [--trials 300] [--seed 0]`."""

from __future__ import annotations

import argparse

from bench.sections import Section, Table, keep
from mintpilot.benchmark.trust import TrustRow, measure_trust


def words(row: TrustRow) -> tuple[str, ...]:
    """One row of the table."""
    if row.low is not None and row.high is not None:
        interval = f"{row.low:.2f} to {row.high:.2f}"
    else:
        interval = "" if row.high is None else f"share at most {100 * row.high:.1f} %"
    return (row.name, f"{row.value:.4g}", str(row.n), interval, row.wanted)


def main() -> None:
    """Measures, and writes the section."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--trials", type=int, default=300)
    arguments.add_argument("--seed", type=int, default=0)
    given = arguments.parse_args()
    rows = measure_trust(given.trials, given.seed)
    keep(
        Section(
            name="53-trust",
            title="Trust: pestering, certificates, consequences",
            command=f"python -m bench.trust --trials {given.trials} --seed {given.seed}",
            how="Worlds by turns: boxes of medicine, a warehouse on fire, one with two clouds and two rooms. Each "
            "is thought through without flying, once with somebody who answers everything with 'I don't know', once "
            "with the truth. *Something else is flown*: another plan, or another question next. Bounds are exact, "
            "one-sided, 95 %.",
            tables=(
                Table(
                    caption="", header=("figure", "found", "of", "interval", "wanted"), rows=[words(r) for r in rows]
                ),
            ),
        )
    )
    for row in rows:
        print(*words(row), sep=" | ")


if __name__ == "__main__":
    main()
