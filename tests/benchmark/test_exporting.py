"""Tables as CSV and LaTeX: every figure, readable by others."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pytest
from tests.benchmark.small import experiment, here

from mintpilot.benchmark.exporting import as_csv, as_latex
from mintpilot.benchmark.records import TrialRecord, WorldRecord
from mintpilot.benchmark.store import RecordStore
from mintpilot.benchmark.summary import summarise
from mintpilot.cli.main import main

CONFIG = experiment("passive-risky", "passive-conservative", trials=2)


@pytest.fixture(scope="module")
def records() -> list[TrialRecord | WorldRecord]:
    return here(CONFIG)


@pytest.mark.long
def test_csv_holds_the_figures_of_the_summary(records: list[TrialRecord | WorldRecord]) -> None:
    trials = [r for r in records if isinstance(r, TrialRecord)]
    summary = summarise(CONFIG, trials, [r for r in records if isinstance(r, WorldRecord)])
    lines = list(csv.DictReader(io.StringIO(as_csv([(CONFIG, summary)]))))
    assert [line["strategy"] for line in lines] == ["passive-risky", "passive-conservative"]
    for line, row in zip(lines, summary.rows, strict=True):
        assert float(line["success_rate"]) == row.success_rate
        assert (float(line["success_ci95_low"]), float(line["success_ci95_high"])) == row.success_ci95
        assert float(line["mean_cost_s"]) == row.mean_cost_s
        assert sum(int(v) for k, v in line.items() if k.startswith("outcomes_") and v) == row.n


def test_latex_has_as_many_columns_as_it_says_and_no_bare_percent(records: list[TrialRecord | WorldRecord]) -> None:
    trials = [r for r in records if isinstance(r, TrialRecord)]
    table = as_latex([(CONFIG, summarise(CONFIG, trials, []))])
    lines = [line for line in table.splitlines() if line.endswith("\\\\")]
    assert len(lines) == 3
    assert {line.count("&") for line in lines} == {6}
    assert "\\begin{tabular}{lrrrrrr}" in table
    assert not any("%" in line.replace("\\%", "") for line in lines)


def test_the_command_writes_a_file_and_says_what_is_missing(
    records: list[TrialRecord | WorldRecord], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "records"
    with RecordStore(folder, CONFIG) as store:
        for record in records:
            store.append("1", record)
    assert main(["bench", "export", str(folder), "--to", "latex", "--out", str(tmp_path / "t.tex")]) == 0
    assert "passive-risky" in (tmp_path / "t.tex").read_text()
    capsys.readouterr()
    assert main(["bench", "export", str(folder)]) == 0
    assert capsys.readouterr().out.startswith("experiment,vehicle,cell,strategy,n,")
    assert main(["bench", "export", str(tmp_path)]) != 0
    assert "Traceback" not in capsys.readouterr().err
