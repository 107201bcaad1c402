"""``mintpilot bench trust``."""

from __future__ import annotations

import json as json_module
from dataclasses import asdict

from mintpilot.cli.bench_flags import Flag, Json
from mintpilot.cli.exits import ExitCode, guarded
from mintpilot.core.errors import InputError


def trust(*, trials: int = 60, seed: int = 0, json: Json = False, debug: Flag = False) -> ExitCode:
    """What a person may rely on: pestering, certificates, consequences that tell something. Nothing is flown.

    Args:
        trials: Number of worlds.
        seed: Of the first world; the others follow.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.benchmark.trust import measure_trust

        if trials < 1 or seed < 0:
            raise InputError(f"--trials {trials} --seed {seed}: at least 1 world, and no negative seed")
        rows = measure_trust(trials, seed)
        if json:
            print(json_module.dumps({"schema_version": 1, "rows": [asdict(row) for row in rows]}))
            return ExitCode.SUCCESS
        for row in rows:
            ends = [f"{end:.3g}" for end in (row.low, row.high) if end is not None]
            interval = f" [{', '.join(ends)}]" if len(ends) == 2 else f" (share at most {ends[0]})" if ends else ""
            print(f"{row.value:8.4g}{interval}  of {row.n}  {row.name}; wanted: {row.wanted}")
        return ExitCode.SUCCESS

    return guarded(work, as_json=json, debug=debug)
