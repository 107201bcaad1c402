"""The summary on a terminal, with the paper's figures beside it."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from mintpilot.benchmark.experiment import Cell, Experiment
from mintpilot.benchmark.methods import Method
from mintpilot.benchmark.records import TrialRecord
from mintpilot.benchmark.summary import summarise
from mintpilot.benchmark.tables import print_summary


@pytest.mark.parametrize("name", ["passive-mixture", "pure-llm"])
def test_the_papers_pure_llm_stands_beside_the_mixture_in_new_and_old_records(name: str) -> None:
    methods = tuple(Method(name=n, strategy=n) for n in (name, "mint"))
    cell = Cell(scenario="fire-warehouse", methods=methods)
    made = Experiment(name="table1", cells=(cell,), trials=1, seed=0, vehicle="kinematic")
    experiment = Experiment.model_validate_json(made.model_dump_json())
    trials = [
        TrialRecord(
            experiment="table1",
            cell="",
            seed=0,
            method=method.name,
            vehicle="kinematic",
            outcome="success",
            success=True,
            reason="",
        )
        for method in methods
    ]
    out = io.StringIO()
    print_summary(experiment, summarise(experiment, trials, ()), Console(file=out, width=160))
    (row,) = (line for line in out.getvalue().splitlines() if line.lstrip().startswith(name))
    assert "Pure LLM: 77 %" in row
    assert out.getvalue().count("Pure LLM") == 1
