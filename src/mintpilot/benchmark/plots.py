"""Plots of an experiment as SVG, from its records only."""

from __future__ import annotations

import io
from collections.abc import Sequence

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.records import TrialRecord
from mintpilot.benchmark.summary import Row, Summary

COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#5c5c5c", "#b8a600", "#7a4fbf", "#8c564b")
"""Told apart by people with colour blindness, too."""
MARKS = "osD^vPX*<>"


def plots_of(
    experiment: Experiment, trials: Sequence[TrialRecord], summary: Summary, number: int
) -> list[tuple[str, str]]:
    """(title, SVG) of each plot that the experiment is worth.

    Args:
        experiment: the configuration.
        trials: its records.
        summary: the tables made from them.
        number: tells the plots of several experiments on one page apart.
    """
    made = []
    if len(experiment.cells) > 1:
        swept = [cell.name for cell in experiment.cells if cell.name.startswith("k = ")]
        made.append(("Questions by number of gaps", _lines(summary.rows, swept, "mean_queries", "questions, mean")))
        made.append(("Cost by number of gaps", _lines(summary.rows, swept, "mean_cost_s", "cost, mean (s)")))
        others = [cell.name for cell in experiment.cells if cell.name not in swept]
        made += [(f"{name}: success and questions", _scatter(summary.rows, name)) for name in others]
    else:
        made.append(("Success and questions", _scatter(summary.rows, experiment.cells[0].name)))
        made.append(("How many questions were asked", _histogram(trials)))
    if experiment.vehicle == "mujoco":
        made.append(("Instruction to finished trajectories, by stage", _stages(summary.rows)))
    return [(title, _svg(figure, f"p{number}-{i}")) for i, (title, figure) in enumerate(made)]


def _lines(rows: Sequence[Row], cells: Sequence[str], value: str, label: str) -> Figure:
    figure, axes = _figure()
    place = {cell: index + 1 for index, cell in enumerate(cells)}
    for i, strategy in enumerate(_strategies(rows)):
        line = [row for row in rows if row.strategy == strategy and row.cell in place]
        x = [place[row.cell] for row in line]
        y = [getattr(row, value) for row in line]
        axes.plot(x, y, marker=MARKS[i % len(MARKS)], color=COLOURS[i % len(COLOURS)], label=strategy, lw=1.4, ms=5)
    axes.set_xlabel("knowledge gaps")
    axes.set_ylabel(label)
    axes.set_ylim(bottom=0)
    _legend(figure, axes)
    return figure


def _scatter(rows: Sequence[Row], cell: str) -> Figure:
    figure, axes = _figure()
    for i, row in enumerate(row for row in rows if row.cell == cell):
        lo, hi = row.success_ci95
        across = row.mean_queries_ci95 or (row.mean_queries, row.mean_queries)
        axes.errorbar(
            row.mean_queries,
            100 * row.success_rate,
            xerr=[[row.mean_queries - across[0]], [across[1] - row.mean_queries]],
            yerr=[[100 * (row.success_rate - lo)], [100 * (hi - row.success_rate)]],
            fmt=MARKS[i % len(MARKS)],
            color=COLOURS[i % len(COLOURS)],
            label=row.strategy,
            capsize=3,
        )
    axes.set_xlabel("questions, mean and 95 % interval")
    axes.set_ylabel("success, % of all worlds")
    axes.set_ylim(0, 103)
    axes.set_xlim(left=min(0.0, *axes.get_xlim()))
    _legend(figure, axes)
    return figure


def _histogram(trials: Sequence[TrialRecord]) -> Figure:
    figure, axes = _figure()
    names = list(dict.fromkeys(t.method for t in trials if t.questions))
    most = max((t.questions for t in trials), default=0)
    width = 0.8 / max(1, len(names))
    for i, name in enumerate(names):
        mine = [t.questions for t in trials if t.method == name]
        shares = [100 * mine.count(k) / len(mine) for k in range(most + 1)]
        at = [k + (i - (len(names) - 1) / 2) * width for k in range(most + 1)]
        axes.bar(at, shares, width=width, color=COLOURS[i % len(COLOURS)], label=name)
    axes.set_xlabel("questions")
    axes.set_ylabel("share of trials, %")
    axes.set_xticks(range(most + 1))
    _legend(figure, axes)
    return figure


def _stages(rows: Sequence[Row]) -> Figure:
    figure, axes = _figure()
    shown = [row for row in rows if row.latency_s]
    left = [0.0] * len(shown)
    for i, stage in enumerate(("perception", "deliberation", "wording", "answer", "planning")):
        widths = [row.latency_s[stage] for row in shown]
        axes.barh([row.strategy for row in shown], widths, left=left, color=COLOURS[i], label=stage)
        left = [a + b for a, b in zip(left, widths, strict=True)]
    axes.set_xlabel("seconds, sum of medians")
    axes.invert_yaxis()
    _legend(figure, axes)
    return figure


def _strategies(rows: Sequence[Row]) -> list[str]:
    return list(dict.fromkeys(row.strategy for row in rows))


def _figure() -> tuple[Figure, Axes]:
    figure = Figure(figsize=(6.4, 3.6), layout="constrained")
    axes = figure.add_subplot()
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def _legend(figure: Figure, axes: Axes) -> None:
    if axes.get_legend_handles_labels()[0]:
        figure.legend(loc="outside right upper", fontsize=8, frameon=False)


def _svg(figure: Figure, salt: str) -> str:
    """The figure alone, ids of its own, the same every time."""
    text = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": salt, "svg.fonttype": "none"}):
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    svg = text.getvalue()
    return svg[svg.index("<svg") :]
