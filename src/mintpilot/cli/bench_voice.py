"""What ``mintpilot bench voice`` does: measure, print, keep."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

from rich import box
from rich.console import Console
from rich.table import Table

from mintpilot.benchmark.voice_report import VoiceOptions, measure_voice, voice_tables
from mintpilot.cli.exits import ExitCode
from mintpilot.core.errors import InputError


def bench_voice(clips: Path | None, *, most: int | None, voices: int, out: Path | None, as_json: bool) -> ExitCode:
    """Measures the installed recognisers.

    Raises:
        InputError: a number or folder that cannot be used.
    """
    if not 0 <= voices <= 6:
        raise InputError(f"--voices {voices}: must be 0 to 6")
    if most is not None and most < 2:
        raise InputError(f"--most {most}: must be 2 or more, since the threshold is chosen on one half")
    errors = Console(stderr=True, highlight=False, soft_wrap=True)
    result = measure_voice(VoiceOptions(clips=clips, most=most, voices=voices, out=out), errors.print)
    if as_json:
        print(json.dumps(asdict(result), ensure_ascii=False))
        return ExitCode.SUCCESS
    console = Console(highlight=False)
    for caption, header, rows in voice_tables(result):
        table = Table(title=caption, box=box.SIMPLE, title_justify="left")
        for name in header:
            table.add_column(name)
        for row in rows:
            table.add_row(*row)
        console.print(table)
    for note in result.notes:
        console.print(note)
    return ExitCode.SUCCESS
