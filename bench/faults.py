"""The fault campaign, into docs/results.md: ``python -m bench.faults [--trials 10000] [--jobs 2] [--flown]``.

It goes on where an earlier run of the same folder stopped; ``--flown`` writes what is there without flying on.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from bench.sections import ROOT, Section, Table, keep
from mintpilot.benchmark.intervals import clopper_pearson_upper
from mintpilot.conformance.faults.campaign import FaultStore, counts, planned, run_campaign
from mintpilot.conformance.faults.kinds import Adapter
from mintpilot.conformance.faults.records import FaultRecord
from mintpilot.conformance.faults.summary import AdapterRow, FaultRow, adapter_rows, fault_rows

HOW = (
    "Missions in which one to three faults come at random times (half of them with one). Kinematic: the sample hall, a "
    "warehouse on fire with one or two clouds, and boxes of medicine, flown by the kinematic simulator with every port "
    "faulty. Link: the control of a MAVLink link against the double's autopilot, 60 s on a clock turned by hand. "
    "MuJoCo: physics and rendered pictures; wind up to 2 N swinging by half, rotors weaker by up to a quarter or lost, "
    "a position off by up to 0.12 m, cameras gone, frozen or wrong. Doubles: both autopilots over UDP in real time. "
    "Console: a real browser (Chromium), slow, killed, flooding, with others and intruders beside it. Voice: real "
    "recognisers, sound that is noisy, cut, doubled, flooded or misheard. "
    "Monitors that share no code with what they judge look at the true flight (touches, smoke, what was known free "
    "when it was commanded and four seconds before it was flown, explicit yeses, what was told and drawn), at the time "
    "to the safe state, at the events on disk, at who was heard and at the verdict. Bounds are exact, one-sided, 95 %."
)
NOTES = (
    "Depth that reads too far is not among the faults: nothing would find it out.",
    "After a rotor is lost, or once a double is in other hands than ours, touches are no breach here; the verdict is "
    "judged all the same. A real vehicle's mission cannot know what was touched: only a claim of success is judged.",
    "Doubles and console pass their time as on the wall, on a machine that others used: time in which the machine did "
    "not let a mission run is taken off.",
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


def told(record: FaultRecord) -> None:
    """What is said of each mission while it goes on."""
    breaches = "; ".join(f"{one.rule}: {one.what}" for one in record.breaches)
    print(f"{record.adapter.value} {record.number}: {record.outcome} {breaches}", flush=True)


def section(records: list[FaultRecord], wanted: int, trials: int, jobs: int) -> Section:
    """The section of docs/results.md."""
    breached = [record for record in records if record.breaches]
    notes = [f"{r.adapter.value} {r.number}: {r.breaches[0].rule}: {r.breaches[0].what}" for r in breached[:20]]
    if len(records) < wanted:
        notes.append(f"{len(records)} of the {wanted} missions of the whole campaign are flown; the command goes on.")
    notes += [*NOTES, f"Load at the end: {os.getloadavg()[0]:.0f} on {os.cpu_count()} cores."]
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
                caption="By fault, over all adapters; times count from when a mission is told of it or it begins",
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
    arguments.add_argument("--adapter", action="append", choices=list(Adapter), help="fly only these now")
    arguments.add_argument("--flown", action="store_true")
    given = arguments.parse_args()
    store, keys = FaultStore(given.out), planned(counts(given.trials))
    if not given.flown:
        wanted = given.adapter or list(Adapter)
        run_campaign(store, [key for key in keys if key[0] in wanted], jobs=given.jobs, heard=told)
    store.close()
    records = [store.records[key] for key in keys if key in store.records]
    keep(section(records, len(keys), given.trials, given.jobs))
    return 1 if any(record.breaches for record in records) else 0


if __name__ == "__main__":
    raise SystemExit(main())
