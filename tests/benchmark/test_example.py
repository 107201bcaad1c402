"""The worked example of a strategy of one's own: installed as its package says, and compared in the table."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path

import pytest

from mintpilot.benchmark.experiments import table1
from mintpilot.benchmark.runner import RunOptions, run_experiment
from mintpilot.benchmark.store import read_records
from mintpilot.benchmark.summary import summarise

EXAMPLE = Path(__file__).parents[2] / "examples" / "my-strategy"


def install(folder: Path) -> None:
    """What pip makes of the package: its metadata, and its source on the path."""
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    info = folder / "my_strategy-0.1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n")
    lines = []
    for group, entries in project["entry-points"].items():
        lines += [f"[{group}]", *(f"{name} = {place}" for name, place in entries.items())]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")


@pytest.mark.long
def test_the_example_is_compared_with_the_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install(tmp_path / "site")
    paths = [str(tmp_path / "site"), str(EXAMPLE / "src")]
    for path in paths:
        monkeypatch.syspath_prepend(path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))
    made = table1(trials=2, seed=2, vehicle="kinematic", strategies=["nearest-first"])
    run_experiment(made, RunOptions(folder=tmp_path / "bench", jobs=1), lambda *_: None)
    trials, worlds = read_records(tmp_path / "bench")
    rows = {row.strategy: row for row in summarise(made, trials, worlds).rows}
    mine = rows["nearest-first"]
    assert mine.outcomes.keys() <= {"success", "no-safe-plan"}
    assert mine.success_rate_possible == 1.0
    assert rows["mint"].mean_queries <= mine.mean_queries <= rows["exhaustive"].mean_queries
