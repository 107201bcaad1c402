"""One self-contained page from records: tables, plots, every trial, and two of them side by side."""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TypeAlias

from jinja2 import Environment
from markupsafe import Markup

from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.plots import plots_of
from mintpilot.benchmark.records import TrialRecord, WorldRecord
from mintpilot.benchmark.summary import Row, Summary, latency_s, summarise
from mintpilot.benchmark.tables import HEADER, PAPER, between, mean_words, percent, row_words
from mintpilot.core.errors import RecordError

Folder: TypeAlias = tuple[Experiment, Sequence[TrialRecord], Sequence[WorldRecord], str]
"""Configuration, records, and the folder's name as the user knows it."""
SIDE_BY_SIDE = 4
STAGES = ("perception", "deliberation", "wording", "answer", "planning", "total")


@dataclass(frozen=True, slots=True, kw_only=True)
class _Table:
    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Section:
    title: str
    facts: tuple[str, ...]
    tables: tuple[_Table, ...]
    folded: tuple[_Table, ...]
    """Shown on demand only."""
    plots: tuple[tuple[str, Markup], ...]
    config: str


def write_report(folders: Sequence[Folder], out: Path) -> None:
    """Writes the page.

    Args:
        folders: what to show, one section each.
        out: the HTML file; nothing else is needed beside it.

    Raises:
        RecordError: there is nothing to show, or the file cannot be written.
    """
    if not any(trials for _, trials, _, _ in folders):
        raise RecordError("there are no trials in these folders; run a benchmark first")
    sections = [_section(folder, number) for number, folder in enumerate(folders)]
    template = files("mintpilot.benchmark").joinpath("report.html.jinja").read_text(encoding="utf-8")
    page = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True).from_string(template)
    text = page.render(sections=sections, data=_packed(folders))
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        raise RecordError(f"cannot write {out}: {error.strerror}; choose another file with --out") from error


def _section(folder: Folder, number: int) -> _Section:
    experiment, trials, worlds, name = folder
    summary = summarise(experiment, trials, worlds)
    single = [_results(experiment, summary, cell.name) for cell in experiment.cells]
    tables = single if len(single) == 1 else _matrices(experiment, summary)
    folded = [] if len(single) == 1 else single
    if experiment.vehicle == "mujoco":
        tables.append(_latencies(summary.rows))
    if summary.gaps:
        tables.append(_gaps(summary))
    return _Section(
        title=f"{experiment.name}, {experiment.vehicle}: {name}",
        facts=_facts(experiment, summary),
        tables=tuple(table for table in tables if table.rows),
        folded=tuple(table for table in folded if table.rows),
        plots=tuple((title, Markup(svg)) for title, svg in plots_of(experiment, trials, summary, number)),
        config=experiment.model_dump_json(indent=1),
    )


def _results(experiment: Experiment, summary: Summary, cell: str) -> _Table:
    paper = PAPER.get(experiment.name, {})
    rows = []
    for row in summary.rows:
        if row.cell == cell:
            ends = ", ".join(f"{name} {count}" for name, count in row.outcomes.items())
            rows.append((*row_words(row), ends, *((paper.get(row.strategy, ""),) if paper else ())))
    header = (*HEADER, "endings", *(("paper",) if paper else ()))
    return _Table(title=cell or "Methods", header=header, rows=tuple(rows))


def _matrices(experiment: Experiment, summary: Summary) -> list[_Table]:
    """Method by setting, one table for each figure, a few settings beside each other."""
    words: dict[str, Callable[[Row], str]] = {
        "Success where possible": lambda row: (
            "-"
            if row.success_rate_possible is None
            else f"{percent(row.success_rate_possible)} {between(row.success_possible_ci95)}"
        ),
        "Questions, mean": lambda row: mean_words(row.mean_queries, row.mean_queries_ci95, 2),
        "Cost, mean, s": lambda row: mean_words(row.mean_cost_s, row.mean_cost_ci95, 0),
    }
    found = {(row.strategy, row.cell): row for row in summary.rows}
    methods = tuple(dict.fromkeys(row.strategy for row in summary.rows))
    cells = [cell.name for cell in experiment.cells]
    tables = []
    for start in range(0, len(cells), SIDE_BY_SIDE):
        some = cells[start : start + SIDE_BY_SIDE]
        for title, say in words.items():
            rows = tuple((m, *(say(found[m, c]) if (m, c) in found else "-" for c in some)) for m in methods)
            tables.append(_Table(title=title, header=("method", *some), rows=rows))
    return tables


def _latencies(rows: Sequence[Row]) -> _Table:
    flown = [row for row in rows if row.latency_s]
    return _Table(
        title="Seconds from the instruction to the finished trajectories, median over trials that flew",
        header=("method", *STAGES),
        rows=tuple((row.strategy, *(f"{row.latency_s[stage]:.2f}" for stage in STAGES)) for row in flown),
    )


def _gaps(summary: Summary) -> _Table:
    return _Table(
        title="Gaps that really mattered",
        header=("setting", "kind", "gaps", "really mattered", "decide under some values of the others"),
        rows=tuple(
            (g.cell, g.kind, str(g.gaps), f"{percent(g.mattered)} {between(g.mattered_ci95)}", percent(g.could_matter))
            for g in summary.gaps
        ),
    )


def _facts(experiment: Experiment, summary: Summary) -> tuple[str, ...]:
    prices = experiment.prices
    facts = [
        f"In {summary.possible} of {summary.worlds} worlds a planner that is told the truth finds a plan; elsewhere "
        "nobody can succeed.",
        f"Cost: seconds of flight, {prices.question_s:g} s for each question, {prices.failure_s:g} s for a failure.",
        f"The scripted person thinks for {experiment.think} s about a question; the clock and the battery run.",
        "Brackets: 95 % intervals, Wilson's for shares and Student's t for means.",
    ]
    if summary.least_possible_queries is not None:
        facts.insert(
            1,
            f"No method can ask fewer than {summary.least_possible_queries:.3f} questions on average "
            "(exact dynamic programming over the priors).",
        )
    return tuple(facts)


def _packed(folders: Sequence[Folder]) -> str:
    """All trials and worlds for the browser: JSON, compressed, as text."""
    data = {
        "trials": [_trial(trial, number) for number, folder in enumerate(folders) for trial in folder[1]],
        "worlds": {
            f"{number}|{world.cell}|{world.seed}": {
                "outline": world.outline_m,
                "boxes": world.boxes,
                "possible": world.possible,
                "best": world.best_s,
                "gaps": [[gap.id, gap.truth, gap.mattered] for gap in world.gaps],
            }
            for number, folder in enumerate(folders)
            for world in folder[2]
        },
        "names": [f"{experiment.name}, {experiment.vehicle}" for experiment, _, _, _ in folders],
    }
    raw = json.dumps(data, separators=(",", ":"), ensure_ascii=False).encode()
    return base64.b64encode(gzip.compress(raw, 9, mtime=0)).decode()


def _trial(trial: TrialRecord, number: int) -> dict[str, object]:
    return {
        "f": number,
        "cell": trial.cell,
        "seed": trial.seed,
        "method": trial.method,
        "outcome": trial.outcome,
        "ok": trial.success,
        "reason": trial.reason,
        "questions": trial.questions,
        "flight": round(trial.flight_s, 1),
        "flown": round(trial.flown_m, 1),
        "latency": round(latency_s(trial.stages_s), 2),
        "stop": trial.stop_reason,
        "asked": [[a.text, a.reply, round(a.gain_bits, 3)] for a in trial.asked],
        "path": trial.path_m,
        "error": trial.error,
    }
