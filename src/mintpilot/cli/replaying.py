"""``mintpilot replay``."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

from mintpilot.cli.exits import ExitCode


def replay_run(run: Path, *, verify: bool, as_json: bool) -> ExitCode:
    """Thinks a recorded mission through again, or prints its report."""
    if not verify:
        return _report(run, as_json=as_json)
    from mintpilot.assembly.replaying import verify_run

    done = verify_run(run)
    difference = done.verification.difference
    if as_json:
        print(
            json.dumps(
                {
                    "schema_version": 1,
                    "equal": difference is None,
                    "steps": done.verification.steps,
                    "deliberations": done.verification.deliberations,
                    "difference": None if difference is None else asdict(difference),
                    "cut": done.cut,
                },
                ensure_ascii=False,
            )
        )
    else:
        steps, thought = done.verification.steps, done.verification.deliberations
        if difference is None:
            print(f"Equal: {steps} steps bit for bit, {thought} deliberations within 1e-9.")
        else:
            print(f"Different at event {difference.number} ({difference.event}), after {steps - 1} equal steps:")
            print(f"  {difference.what}")
            print(f"  before it: {difference.before}")
        if done.cut:
            print(f"The record breaks off: {done.cut}")
    return ExitCode.SUCCESS if difference is None else ExitCode.NOT_A_SUCCESS


def _report(run: Path, *, as_json: bool) -> ExitCode:
    from mintpilot.cli.progress import LenientConsole
    from mintpilot.recording.record import read_record
    from mintpilot.recording.run_summary import summary
    from mintpilot.recording.terminal_report import print_report

    record = read_record(run)
    if as_json:
        print(summary(record).model_dump_json())
    else:
        print_report(record, LenientConsole())
    return ExitCode.SUCCESS
