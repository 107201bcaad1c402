"""What the scripts that write sections from benchmark records share: running, tables, notes."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from bench.sections import ROOT, Table
from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.records import TrialRecord, WorldRecord
from mintpilot.benchmark.runner import Progress, RunOptions, run_experiment
from mintpilot.benchmark.store import read_records
from mintpilot.benchmark.summary import Summary, summarise
from mintpilot.benchmark.tables import HEADER, PAPER, between, percent, row_words

RUNS = ROOT / "runs"


class Measured:
    """An experiment with its records and their summary."""

    def __init__(self, experiment: Experiment, folder: Path, progress: Progress) -> None:
        self.experiment = experiment
        self.folder = folder
        self.progress = progress
        trials, worlds = read_records(folder)
        last = experiment.seed + experiment.trials
        self.trials: list[TrialRecord] = [t for t in trials if t.seed < last]
        self.worlds: list[WorldRecord] = [w for w in worlds if w.seed < last]
        self.summary: Summary = summarise(experiment, self.trials, self.worlds)

    @property
    def throughput(self) -> str:
        """Missions per minute: of this run, or by the records where all were there already."""
        name = f"{self.experiment.name}, {self.experiment.vehicle}"
        if self.progress.done:
            return f"{name}: {self.progress.per_minute:.0f} missions per minute"
        walls = [t.wall_s for t in self.trials]
        return f"{name}: {60 * len(walls) / sum(walls):.0f} missions per minute and worker" if walls else ""

    def of(self, method: str, cell: str = "") -> list[TrialRecord]:
        """The trials of one method in one cell."""
        return [t for t in self.trials if t.method == method and t.cell == cell]

    def possible(self, cell: str = "") -> set[int]:
        """Seeds of the worlds in which the planner that knows the truth finds a plan."""
        return {w.seed for w in self.worlds if w.cell == cell and w.possible}


def measure(experiment: Experiment, jobs: int) -> Measured:
    """Flies what has no record yet, in a folder of its own under ``runs``; tells how far it is."""
    folder = RUNS / f"results-{experiment.name}-{experiment.vehicle}-{experiment.digest()}"
    told = [0.0]

    def heard(progress: Progress, _record: object) -> None:
        if progress.seconds - told[0] > 20:
            told[0] = progress.seconds
            done = progress.before + progress.done
            print(f"{folder.name}: {done} of {progress.trials}, {progress.per_minute:.0f} a minute", file=sys.stderr)

    return Measured(experiment, folder, run_experiment(experiment, RunOptions(folder=folder, jobs=jobs), heard))


def results_table(measured: Measured, *, cell: str = "", caption: str = "") -> Table:
    """The table of one cell, the paper's figures beside it."""
    paper = PAPER.get(measured.experiment.name, {})
    rows = [
        (*row_words(row), *((paper.get(row.strategy, ""),) if paper else ()))
        for row in measured.summary.rows
        if row.cell == cell
    ]
    return Table(caption=caption, header=(*HEADER, *(("paper",) if paper else ())), rows=rows)


def gap_table(measured: Measured, *, caption: str) -> Table:
    """How often gaps really mattered."""
    rows = [
        (g.cell, g.kind, str(g.gaps), f"{percent(g.mattered)} {between(g.mattered_ci95)}", percent(g.could_matter))
        for g in measured.summary.gaps
    ]
    header = ("setting", "kind of gap", "gaps", "really mattered", "decides under some values of the others")
    return Table(caption=caption, header=header, rows=rows)


def failures(measured: Measured, method: str, cell: str = "", most: int = 12) -> list[str]:
    """A line for each world in which the method failed though the planner that knows the truth does not."""
    can = measured.possible(cell)
    lost = [t for t in measured.of(method, cell) if t.seed in can and not t.success]
    lines = [f"`{method}`, world {t.seed}: {t.outcome} ({t.reason})" for t in lost[:most]]
    return lines + ([f"… and {len(lost) - most} more"] if len(lost) > most else [])


def above_optimal(measured: Measured, method: str, cell: str = "") -> str:
    """By how much the method asks more than exact dynamic programming in the same worlds."""
    pairs = {t.seed: t.questions for t in measured.of("optimal", cell) if t.outcome != "raised"}
    mine = [(t.questions, pairs[t.seed]) for t in measured.of(method, cell) if t.seed in pairs]
    asked, least = sum(a for a, _ in mine), sum(b for _, b in mine)
    share = 100 * (asked / least - 1) if least else 0.0
    n = max(1, len(mine))
    return f"`{method}` asks {asked / n:.3f} questions, `optimal` {least / n:.3f} in the same worlds: {share:+.1f} %."


def arguments(doc: str | None, extra: Sequence[tuple[str, int]]) -> argparse.Namespace:
    """The options of a script: its numbers of trials, then --seed, --jobs and --dry."""
    parser = argparse.ArgumentParser(description=doc)
    for name, default in extra:
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--dry", action="store_true", help="print the section, keep nothing")
    return parser.parse_args()
