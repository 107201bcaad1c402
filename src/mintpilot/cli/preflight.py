"""``mintpilot preflight``."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

from mintpilot.cli.exits import ExitCode


def check_vehicle_for(mission: Path, vehicle: str, *, accept_failsafes: bool, as_json: bool) -> ExitCode:
    """Prints every check; the exit code says whether the vehicle may fly."""
    from mintpilot.assembly.preflight import preflight

    checks = preflight(mission, vehicle, accept_failsafes=accept_failsafes)
    well = all(check.ok or (accept_failsafes and check.failsafe) for check in checks)
    if as_json:
        shown = [{key: value for key, value in asdict(check).items() if key != "failsafe"} for check in checks]
        print(json.dumps(shown, ensure_ascii=False))
    else:
        for check in checks:
            mark = "ok      " if check.ok else "accepted" if accept_failsafes and check.failsafe else "NOT OK  "
            print(f"{mark}  {check.check}: {check.value}; wanted: {check.wanted}")
            if not check.ok and check.how:
                print(f"          → {check.how}")
        print("Ready to fly." if well else "Not ready to fly: see NOT OK.")
    return ExitCode.SUCCESS if well else ExitCode.FAILED_DEVICE
