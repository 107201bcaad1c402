"""What ``mintpilot bench language`` does: measure, print, keep."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table

from mintpilot.assembly.registry import load
from mintpilot.benchmark.language_report import (
    RULES,
    LanguageOptions,
    LanguageResult,
    language_tables,
    measure_language,
    models_there,
)
from mintpilot.cli.exits import ExitCode
from mintpilot.core.errors import InputError

if TYPE_CHECKING:
    from mintpilot.core.ports import LanguageModel

FILE = "language.json"


def bench_language(
    llm: Sequence[str], *, instructions: Path | None, sample: int, out: Path | None, as_json: bool
) -> ExitCode:
    """Measures the rules, and the models named; without names those that are there.

    Raises:
        InputError: a number or file that cannot be used.
    """
    if sample < 1:
        raise InputError(f"--sample {sample}: must be 1 or more")
    errors = Console(stderr=True, highlight=False, soft_wrap=True)
    names = [name for name in (llm or models_there()) if name != RULES]
    options = LanguageOptions(models={name: _maker(name) for name in names}, instructions=instructions, sample=sample)
    result = measure_language(options, errors.print)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        (out / FILE).write_text(json.dumps(asdict(result), indent=1, ensure_ascii=False) + "\n", "utf-8")
    if as_json:
        print(json.dumps(asdict(result), ensure_ascii=False))
    else:
        _print(result)
    return ExitCode.SUCCESS


def _maker(name: str) -> Callable[[], LanguageModel]:
    kind = load("language", name)

    def make() -> LanguageModel:
        model: LanguageModel = kind()
        return model

    return make


def _print(result: LanguageResult) -> None:
    console = Console(highlight=False)
    for caption, header, rows in language_tables(result):
        table = Table(title=caption, box=box.SIMPLE, title_justify="left")
        for name in header:
            table.add_column(name)
        for row in rows:
            table.add_row(*row)
        console.print(table)
    for reason in result.left_out:
        console.print(f"Left out: {reason}")
