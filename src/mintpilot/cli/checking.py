"""``mintpilot check``."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from pathlib import Path

from mintpilot.cli.exits import ExitCode


def check_file(path: Path, *, as_json: bool) -> ExitCode:
    """Prints every mistake in that mission file, or that there is none."""
    from mintpilot.assembly.validation import check_mission

    problems = check_mission(path)
    if as_json:
        report = {"schema_version": 1, "file": str(path), "problems": [asdict(problem) for problem in problems]}
        print(json.dumps(report, ensure_ascii=False))
    elif not problems:
        print(f"{path}: no mistakes.")
    else:
        for problem in problems:
            print(problem)
        print(f"{len(problems)} mistake{'s' if len(problems) > 1 else ''}.", file=sys.stderr)
    return ExitCode.WRONG_INPUT if problems else ExitCode.SUCCESS


def print_schema() -> ExitCode:
    """Prints the JSON Schema of mission files."""
    from mintpilot.mission_file.reader import json_schema

    sys.stdout.write(json_schema())
    return ExitCode.SUCCESS
