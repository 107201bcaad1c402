"""``mintpilot bench faults``."""

from __future__ import annotations

import json as json_module
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from mintpilot.cli.bench_flags import Flag, Json
from mintpilot.cli.exits import ExitCode, guarded
from mintpilot.core.errors import InputError

if TYPE_CHECKING:
    from mintpilot.conformance.faults.records import FaultRecord

AdapterName: TypeAlias = Literal["kinematic", "link", "mujoco", "doubles", "console", "voice"]
EVERY = 50
"""Progress is told after so many trials."""


def faults(
    *,
    trials: int = 300,
    out: Path = Path("runs/faults"),
    jobs: int = 2,
    adapter: tuple[AdapterName, ...] = (),
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Faults into running missions: cameras, positions, motors, links, people, models, disks, processes, clocks.

    Independent monitors judge each: no unsafe motion, a safe state in time, no record lost, an honest verdict. The same
    command goes on where an interrupted one stopped. Exit code 1: something was breached.

    Args:
        trials: Number of missions, over all adapters; a whole campaign has 10000.
        out: Folder of records.
        jobs: Missions at once.
        adapter: Fly the missions of this adapter only; may be given several times. Default: all.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        if trials < 1 or jobs < 1:
            raise InputError(f"--trials {trials} --jobs {jobs}: at least 1 of each")
        return _bench(trials, out, jobs, adapter, as_json=json)

    return guarded(work, as_json=json, debug=debug)


def _bench(trials: int, out: Path, jobs: int, only: tuple[str, ...], *, as_json: bool) -> ExitCode:
    from mintpilot.benchmark.intervals import clopper_pearson_upper
    from mintpilot.conformance.faults.campaign import FaultStore, counts, lacking, planned, run_campaign
    from mintpilot.conformance.faults.summary import adapter_rows, fault_rows

    wanted = {adapter: n for adapter, n in counts(trials).items() if not only or adapter.value in only}
    left_out = {adapter: why for adapter in wanted if (why := lacking(adapter))}
    for adapter, why in left_out.items():
        print(f"{adapter.value}: left out: {why}", file=sys.stderr)
    store, keys = FaultStore(out), [key for key in planned(wanted) if key[0] not in left_out]
    done = sum(key in store.records for key in keys)

    def heard(record: FaultRecord) -> None:
        nonlocal done
        done += 1
        for breach in record.breaches:
            print(f"{record.adapter.value} {record.number}: {breach.rule}: {breach.what}", file=sys.stderr)
        if done % EVERY == 0:
            print(f"{done} of {len(keys)}", file=sys.stderr)

    try:
        run_campaign(store, keys, jobs=jobs, heard=heard)
    finally:
        store.close()
    records = [store.records[key] for key in keys]
    adapters, kinds = list(adapter_rows(records)), list(fault_rows(records))
    breached = [record for record in records if record.breaches]
    if as_json:
        rows = {"adapters": [asdict(row) for row in adapters], "faults": [asdict(row) for row in kinds]}
        breaches = [record.model_dump(mode="json") for record in breached]
        print(json_module.dumps({"schema_version": 1, **rows, "breached": breaches}))
        return ExitCode.NOT_A_SUCCESS if breached else ExitCode.SUCCESS
    for row in adapters:
        bound = clopper_pearson_upper(row.breached, row.trials)
        print(f"{row.adapter}: {row.breached} of {row.trials} breached (share at most {bound:.2%}); {row.outcomes}")
    for kind in kinds:
        took = "never told" if kind.longest_s is None else f"told {kind.told} times, safe after {kind.longest_s:.1f} s"
        print(f"{kind.fault:16} {kind.breached} of {kind.trials}; {took}; {kind.state} within {kind.within_s:g} s")
    return ExitCode.NOT_A_SUCCESS if breached else ExitCode.SUCCESS
