"""``mintpilot bench perception``."""

from __future__ import annotations

import json as json_module
from dataclasses import asdict
from typing import Annotated

from cyclopts import Parameter

from mintpilot.cli.bench_flags import Flag, Json
from mintpilot.cli.exits import ExitCode, guarded
from mintpilot.core.errors import InputError, UnknownNameError


def perception(
    *,
    style: Annotated[list[str], Parameter(name="--style", negative="")] = [],  # noqa: B006
    scenes: int = 25,
    seed: int = 0,
    use: Annotated[str, Parameter(name="--perception")] = "segments",
    namer: Annotated[list[str], Parameter(name="--namer", negative="")] = [],  # noqa: B006
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """What is found, named and asked about in furnished rooms with people, doors and things; the truth is known.

    Args:
        style: Of the rooms; may be given several times. Default: those that no rule was chosen on.
        scenes: Rooms of each style.
        seed: Of the first room; the others follow.
        use: Perception that is measured.
        namer: Who names what is found; may be given several times. Default: the perception's own way.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.assembly.perceiving import Seeing, make_perception
        from mintpilot.benchmark.perception import measure_perception, rows_of
        from mintpilot.simulation.furnished.style import HELD_BACK, STYLES

        if scenes < 1 or seed < 0:
            raise InputError(f"--scenes {scenes} --seed {seed}: at least 1 room, and no negative seed")
        for name in style:
            if name not in STYLES:
                raise UnknownNameError("style", name, STYLES)
        made = make_perception(Seeing(perception=use, namers=tuple(namer)))
        picked = [STYLES[name] for name in dict.fromkeys(style or HELD_BACK)]
        rows = list(rows_of(measure_perception(picked, scenes, seed, made)))
        if json:
            names = [one.name for one in picked]
            print(json_module.dumps({"schema_version": 1, "styles": names, "rows": [asdict(row) for row in rows]}))
            return ExitCode.SUCCESS
        for row in rows:
            interval = "" if row.low is None or row.high is None else f" [{row.low:.3f}, {row.high:.3f}]"
            wanted = f"; wanted: {row.wanted}" if row.wanted else ""
            print(f"{row.value:8.3f}{interval}  of {row.n}  {row.name}{wanted}")
        return ExitCode.SUCCESS

    return guarded(work, as_json=json, debug=debug)
