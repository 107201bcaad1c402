"""What ``mintpilot bench voice`` does: measure, print, keep."""

from __future__ import annotations

import json
from dataclasses import asdict

from rich import box
from rich.console import Console
from rich.table import Table

from mintpilot.benchmark.voice_report import VoiceOptions, measure_voice, voice_tables
from mintpilot.cli.exits import ExitCode
from mintpilot.core.errors import InputError


def bench_voice(options: VoiceOptions, *, as_json: bool) -> ExitCode:
    """Measures the installed recognisers.

    Raises:
        InputError: a number or folder that cannot be used.
    """
    if not 0 <= options.voices <= 8:
        raise InputError(f"--voices {options.voices}: must be 0 to 8")
    if options.most is not None and options.most < 1:
        raise InputError(f"--most {options.most}: must be 1 or more")
    if not 0 <= options.alone_h <= 24:
        raise InputError(f"--alone {options.alone_h:g}: must be 0 to 24 hours")
    errors = Console(stderr=True, highlight=False, soft_wrap=True)
    result = measure_voice(options, errors.print)
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
