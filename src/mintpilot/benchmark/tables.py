"""The summary on a terminal."""

from __future__ import annotations

from rich import box
from rich.console import Console
from rich.table import Table

from mintpilot.assembly.registry import present_name
from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.summary import Row, Summary

PAPER = {
    "table1": {"passive-mixture": "Pure LLM: 77 %, 0.0", "exhaustive": "100 %, 2.0", "mint": "100 %, 1.4"},
    "boxes": {"passive-conservative": "35 %", "mint": "100 %, 20.7 s"},
}
"""What the paper states: success, mean questions; for the boxes seconds from start to completed trajectories. Its
'Pure LLM' stands beside `passive-mixture`, which is no language model but draws between the two stances it may take."""
ROOMY = 100
"""From this many columns on a terminal shows everything."""
LEFT_OUT = ("n", "cost, mean s", "flight, mean s")
HEADER = ("method", "n", "success", "success where possible", "questions, mean", "cost, mean s", "flight, mean s")


def print_summary(experiment: Experiment, summary: Summary, console: Console) -> None:
    """Prints one table for each cell, then what is known of the worlds."""
    paper = PAPER.get(experiment.name, {})
    for cell in experiment.cells:
        rows = [row for row in summary.rows if row.cell == cell.name]
        if not rows:
            continue
        timed = experiment.vehicle == "mujoco"
        header = (*HEADER, *(("latency, median",) if timed else ()), *(("paper",) if paper else ()))
        shown = [name for name in header if console.width >= ROOMY or name not in LEFT_OUT]
        title = f"{cell.name or experiment.name}, n = {rows[0].n}"
        table = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, pad_edge=False)
        table.padding = (0, 1, 0, 0)
        for name in shown:
            table.add_column(name.replace(", ", ",\n").replace(" where ", "\nwhere "), no_wrap=True)
        for row in rows:
            seconds = row.latency_s.get("total")
            late = ((f"{seconds:.1f} s" if seconds is not None else "-"),) if timed else ()
            words = (*row_words(row), *late, *((paper.get(present_name(row.strategy), ""),) if paper else ()))
            by_name = dict(zip(header, words, strict=True))
            table.add_row(*(by_name[name].replace(" [", "\n[").replace("%, ", "%,\n") for name in shown))
        console.print(table)
    console.print(_worlds(summary), highlight=False, soft_wrap=True)


def row_words(row: Row) -> tuple[str, ...]:
    """The cells of `HEADER`."""
    possible = row.success_rate_possible
    return (
        row.strategy,
        str(row.n),
        f"{percent(row.success_rate)} {between(row.success_ci95)}",
        f"{percent(possible)} {between(row.success_possible_ci95)}" if possible is not None else "-",
        mean_words(row.mean_queries, row.mean_queries_ci95, 2),
        mean_words(row.mean_cost_s, row.mean_cost_ci95, 0),
        f"{row.mean_flight_s:.0f}",
    )


def percent(share: float) -> str:
    """A share in words."""
    return f"{100 * share:.1f} %"


def between(interval: tuple[float, float]) -> str:
    """An interval of shares in words."""
    return f"[{100 * interval[0]:.1f}, {100 * interval[1]:.1f}]"


def mean_words(value: float, interval: tuple[float, float] | None, digits: int) -> str:
    """A mean with its interval, if there is one, in words."""
    if interval is None:
        return f"{value:.{digits}f}"
    return f"{value:.{digits}f} [{interval[0]:.{digits}f}, {interval[1]:.{digits}f}]"


def _worlds(summary: Summary) -> str:
    lines = [
        f"In {summary.possible} of {summary.worlds} worlds a planner that is told the truth finds a plan; "
        "elsewhere nobody can succeed."
    ]
    if summary.least_possible_queries is not None:
        lines.append(
            f"Least possible questions, mean: {summary.least_possible_queries:.3f} (exact dynamic programming)."
        )
    for share in summary.gaps:
        where = f"{share.cell}: " if share.cell else ""
        lines.append(
            f"{where}{share.kind} gaps: {share.gaps}; {percent(share.mattered)} {between(share.mattered_ci95)} really "
            f"mattered, {percent(share.could_matter)} might have."
        )
    return "\n".join(lines)
