"""Writes what is generated of the documentation: the command line's help and the mission file's schema.

python scripts/make_docs.py
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from mintpilot.mission.reader import json_schema

DOCS = Path(__file__).parents[1] / "docs"
COMMANDS = ("", "demo", "run", "plan", "check", "doctor")
HEAD = """# The command line

Written by `make docs`; do not edit. Results go to standard output, everything else to standard error, so that
`--json` prints one object and nothing else.
"""


def cli_page() -> str:
    """The help of every command as one page."""
    parts = [HEAD]
    for command in COMMANDS:
        words = [sys.executable, "-c", "import sys; from mintpilot.cli.main import main; sys.exit(main())"]
        shown = subprocess.run(
            [*words, *command.split(), "--help"],
            env={**os.environ, "COLUMNS": "100", "NO_COLOR": "1", "TERM": "dumb"},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        lines = "\n".join(line.rstrip() for line in shown.strip().splitlines())
        parts.append(f"## mintpilot {command}".rstrip() + f"\n\n```text\n{lines}\n```\n")
    return "\n".join(parts)


def main() -> None:
    """Writes both files."""
    (DOCS / "mission.schema.json").write_text(json_schema(), encoding="utf-8")
    (DOCS / "cli.md").write_text(cli_page(), encoding="utf-8")


if __name__ == "__main__":
    main()
