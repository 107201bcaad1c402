"""The fault campaign, into docs/results.md: ``python -m bench.faults [--trials 10000] [--jobs 2] [--flown]``.

It goes on where an earlier run of the same folder stopped; ``--flown`` writes what is there without flying on.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from bench.sections import ROOT, Section, Table, keep
from mintpilot.benchmark.intervals import clopper_pearson_upper
from mintpilot.conformance.faults.campaign import FaultStore, counts, planned, run_campaign
from mintpilot.conformance.faults.records import FaultRecord
from mintpilot.conformance.faults.summary import AdapterRow, FaultRow, adapter_rows, fault_rows

HOW = (
    "Missions in which one to three faults come at random times (half of them with one). Kinematic: the sample hall, a "
    "warehouse on fire with one or two clouds, and boxes of medicine, flown by the kinematic simulator with every port "
    "faulty. Link: the control of a MAVLink link against the double's autopilot, 60 s on a clock turned by hand. "
    "Monitors that share no code with what they judge look at the true flight (touches, smoke, what was known free "
    "when it was commanded and four seconds before it was flown, explicit yeses), at the time to the safe state, at "
    "the events on disk and at the verdict. Bounds are exact, one-sided, 95 %."
)


def adapter_words(row: AdapterRow) -> tuple[str, ...]:
    """One adapter."""
    bound = clopper_pearson_upper(row.breached, row.trials)
    outcomes = ", ".join(f"{name} {n}" for name, n in row.outcomes.items())
    share = f"{row.breached} (share at most {bound:.2%})"
    each_s = row.cpu_s / max(row.trials, 1)
    return (row.adapter, str(row.trials), share, f"{row.mission_s / 3600:.1f}", f"{each_s:.2f}", outcomes)


def fault_words(row: FaultRow) -> tuple[str, ...]:
    """One fault."""
    took = "" if row.longest_s is None else f"{row.longest_s:.1f}"
    limit = f"{row.within_s:g}"
    return (row.fault, str(row.trials), str(row.breached), row.state, limit, str(row.told) if row.told else "", took)


def section(records: list[FaultRecord], wanted: int, trials: int, jobs: int) -> Section:
    """The section of docs/results.md."""
    breached = [record for record in records if record.breaches]
    notes = [f"{r.adapter.value} {r.number}: {r.breaches[0].rule}: {r.breaches[0].what}" for r in breached[:20]]
    if len(records) < wanted:
        notes.append(f"{len(records)} of the {wanted} missions of the whole campaign are flown; the command goes on.")
    notes.append(
        "Not in it yet: physics (wind, motors, pictures), both doubles over MAVLink, the console in a browser, voice. "
        "Depth that reads too far is not among the faults: nothing would find it out."
    )
    return Section(
        name="58-faults",
        title="Faults",
        command=f"python -m bench.faults --trials {trials} --jobs {jobs}",
        how=HOW,
        tables=(
            Table(
                caption="By adapter",
                header=("adapter", "missions", "breached", "hours of flight", "CPU s each", "how they ended"),
                rows=[adapter_words(row) for row in adapter_rows(records)],
            ),
            Table(
                caption="Kinematic, by fault; the safe state and its time count from when a mission is told of it",
                header=("fault", "missions", "breached", "safe state", "within, s", "told", "longest, s"),
                rows=[fault_words(row) for row in fault_rows(records)],
            ),
        ),
        notes=notes,
    )


def main() -> int:
    """Flies what is left, and writes the section."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--trials", type=int, default=10_000)
    arguments.add_argument("--jobs", type=int, default=2)
    arguments.add_argument("--out", type=Path, default=ROOT / "runs" / "faults")
    arguments.add_argument("--flown", action="store_true")
    given = arguments.parse_args()
    store, keys = FaultStore(given.out), planned(counts(given.trials))
    if not given.flown:
        run_campaign(store, keys, jobs=given.jobs, heard=lambda _: None)
    store.close()
    records = [store.records[key] for key in keys if key in store.records]
    keep(section(records, len(keys), given.trials, given.jobs))
    return 1 if any(record.breaches for record in records) else 0


if __name__ == "__main__":
    raise SystemExit(main())
