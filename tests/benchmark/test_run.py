"""Experiments run for real, in worker processes."""

from __future__ import annotations

import json
from pathlib import Path

import duckdb
import pytest
from tests.benchmark.small import experiment, here

from mintpilot.benchmark import pool
from mintpilot.benchmark.experiment import Condition
from mintpilot.benchmark.experiments import boxes, gaps, table1
from mintpilot.benchmark.records import TrialRecord
from mintpilot.benchmark.runner import RunOptions, run_experiment
from mintpilot.benchmark.store import read_config, read_records, write_parquet
from mintpilot.benchmark.summary import cost_s, summarise
from mintpilot.benchmark.trial import CRASHED, RAISED, TIMED_OUT
from mintpilot.cli.main import main
from mintpilot.core.errors import InputError, RecordError, UnknownNameError


def quiet(*_: object) -> None:
    pass


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of three methods in three worlds, in two goes."""
    made = tmp_path_factory.mktemp("runs") / "bench"
    config = experiment("mint", "exhaustive", "passive-risky", trials=2)
    run_experiment(config, RunOptions(folder=made, jobs=1), quiet)
    progress = run_experiment(config.model_copy(update={"trials": 3}), RunOptions(folder=made), quiet)
    assert (progress.before, progress.done) == (6, 3)
    return made


def plain(record: TrialRecord) -> dict[str, object]:
    """What must be the same every time: all but the times of this machine."""
    timed = {"stages_s", "deliberation_max_s", "survey_s", "wall_s"}
    data = record.model_dump(exclude=timed)
    data["asked"] = [(a.query, a.reply) for a in record.asked]
    return data


@pytest.mark.long
def test_every_method_flies_in_every_world_once(folder: Path) -> None:
    trials, worlds = read_records(folder)
    assert sorted((t.seed, t.method) for t in trials) == sorted(
        (seed, method) for seed in (2, 3, 4) for method in ("mint", "exhaustive", "passive-risky")
    )
    assert [w.seed for w in worlds] == [2, 3, 4]
    assert all(t.outcome != RAISED for t in trials), [t.error for t in trials]
    mint = [t for t in trials if t.method == "mint"]
    possible = {w.seed for w in worlds if w.possible}
    assert possible
    assert all(t.success for t in mint if t.seed in possible)
    assert all(t.questions == 2 for t in trials if t.method == "exhaustive")


@pytest.mark.long
def test_same_seed_same_records_whoever_else_flies(folder: Path) -> None:
    alone = [r for r in here(experiment("mint", trials=2)) if isinstance(r, TrialRecord)]
    before = [plain(t) for t in read_records(folder)[0] if t.method == "mint" and t.seed < 4]
    assert [plain(t) for t in alone] == before


@pytest.mark.long
def test_finished_trials_are_never_flown_again_and_lost_ones_are(folder: Path) -> None:
    config = read_config(folder)
    flown = []
    assert run_experiment(config, RunOptions(folder=folder), lambda p, r: flown.append(r)).done == 0
    assert not flown
    shard = next(p for p in sorted((folder / "shards").iterdir()) if p.read_text().count('"kind":"trial"'))
    text = shard.read_text()
    lines = text.splitlines(keepends=True)
    last = max(i for i, line in enumerate(lines) if '"kind":"trial"' in line)
    shard.write_text("".join(lines[:last]) + lines[last][:40])  # the power went while this was written
    lost = json.loads(lines[last])
    also = sum('"kind":"trial"' in line for line in lines[last + 1 :])
    assert also == 0
    run_experiment(config, RunOptions(folder=folder), lambda p, r: flown.append(r))
    assert [(r.method, r.seed) for r in flown if isinstance(r, TrialRecord)] == [(lost["method"], lost["seed"])]
    assert len(read_records(folder)[0]) == 9


@pytest.mark.long
def test_one_method_alone_is_flown_and_the_rest_stays_for_later(tmp_path: Path) -> None:
    config = experiment("passive-risky", "passive-conservative", trials=1)
    alone = RunOptions(folder=tmp_path / "r", jobs=1, only=frozenset({"passive-risky"}))
    assert run_experiment(config, alone, quiet).trials == 1
    trials, worlds = read_records(tmp_path / "r")
    assert [t.method for t in trials] == ["passive-risky"]
    assert len(worlds) == 1
    rest = run_experiment(config, RunOptions(folder=tmp_path / "r", jobs=1), quiet)
    assert (rest.trials, rest.before, rest.done) == (2, 1, 1)
    with pytest.raises(UnknownNameError, match="Did you mean 'passive-risky'"):
        run_experiment(config, RunOptions(folder=tmp_path / "r", only=frozenset({"passive-risk"})), quiet)


@pytest.mark.long
def test_a_folder_of_something_else_is_refused(folder: Path) -> None:
    config = read_config(folder)
    with pytest.raises(RecordError, match=r"another experiment \(it differs in seed\).*--out"):
        run_experiment(config.model_copy(update={"seed": 5}), RunOptions(folder=folder), quiet)


@pytest.mark.long
def test_parquet_says_what_the_records_say(folder: Path) -> None:
    trials, worlds = read_records(folder)
    made = write_parquet(folder)
    assert [p.name for p in made] == ["trials.parquet", "worlds.parquet"]
    found = duckdb.sql(f"SELECT method, seed, success, questions FROM '{made[0]}' ORDER BY seed, method").fetchall()
    assert found == sorted(
        ((t.method, t.seed, t.success, t.questions) for t in trials), key=lambda row: (row[1], row[0])
    )
    assert duckdb.sql(f"SELECT count(*) FROM '{made[1]}'").fetchall() == [(len(worlds),)]


def test_summary_counts_what_the_records_hold(folder: Path) -> None:
    config, (trials, worlds) = read_config(folder), read_records(folder)
    summary = summarise(config, trials, worlds)
    row = next(r for r in summary.rows if r.strategy == "exhaustive")
    mine = [t for t in trials if t.method == "exhaustive"]
    assert row.n == len(mine)
    assert row.success_rate == sum(t.success for t in mine) / len(mine)
    assert row.mean_cost_s == pytest.approx(sum(cost_s(t, config.prices) for t in mine) / len(mine))
    assert sum(row.outcomes.values()) == row.n
    assert summary.possible == sum(w.possible for w in worlds)
    assert summary.least_possible_queries == pytest.approx(sum(w.least_questions or 0.0 for w in worlds) / len(worlds))


@pytest.mark.long
@pytest.mark.usefixtures("bad_plugins")
def test_plugins_that_raise_hang_or_kill_their_process_cost_their_own_trials_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pool, "GRACE_S", 1.0)
    # The good ones fly before any process has to start anew, and so have time enough.
    bad = experiment("mint", "raising", "exhaustive", "hanging", "stubborn", "dying", trials=1, time_limit_s=4.0)
    run_experiment(bad, RunOptions(folder=tmp_path / "bench", jobs=1), quiet)
    found = {t.method: t for t in read_records(tmp_path / "bench")[0]}
    assert found["raising"].outcome == RAISED
    assert "ZeroDivisionError: no idea" in found["raising"].reason
    assert "small.py" in found["raising"].error
    assert found["hanging"].outcome == TIMED_OUT
    assert found["stubborn"].outcome == TIMED_OUT
    assert "did not stop; its process was ended" in found["stubborn"].reason
    assert found["dying"].outcome == CRASHED
    assert "exit code 7" in found["dying"].reason
    assert {name for name, trial in found.items() if trial.success} == {"mint", "exhaustive"}


@pytest.mark.long
def test_answers_that_are_wrong_are_wrong_in_the_same_trials_every_time() -> None:
    wrong = experiment("exhaustive", trials=3, condition=Condition(answer_error=0.4, believed_error=0.0))
    runs = [[plain(t) for t in here(wrong) if isinstance(t, TrialRecord)] for _ in range(2)]
    assert runs[0] == runs[1]
    right = [plain(t) for t in here(experiment("exhaustive", trials=3)) if isinstance(t, TrialRecord)]
    assert runs[0] != right


@pytest.mark.usefixtures("bad_plugins")
def test_unknown_strategies_and_numbers_out_of_range_are_refused_before_anything_is_flown() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'mint-paper'"):
        table1(trials=1, seed=0, vehicle="kinematic", strategies=["mint-papr"])
    with pytest.raises(InputError, match="bad-plugins"):
        table1(trials=1, seed=0, vehicle="kinematic", strategies=["missing"])
    with pytest.raises(InputError, match="named twice"):
        gaps(trials=1, seed=0, vehicle="kinematic", strategies=["knowno"])
    with pytest.raises(InputError, match="--trials 0"):
        table1(trials=0, seed=0, vehicle="kinematic")
    with pytest.raises(InputError, match="--think 40"):
        boxes(trials=1, seed=0, vehicle="kinematic", think=40)


@pytest.mark.long
def test_command_prints_one_object(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "bench"
    words = ["bench", "table1", "--trials", "1", "--seed", "3", "--jobs", "1", "--out", str(out), "--json"]
    assert main(words) == 0
    shown = capsys.readouterr()
    made = json.loads(shown.out)
    assert "missions per minute" in shown.err
    assert [row["strategy"] for row in made["rows"]] == [m.name for m in read_config(out).cells[0].methods]
    row = made["rows"][0]
    assert {"n", "success_rate", "success_ci95", "mean_queries", "mean_queries_ci95", "mean_cost_s"} <= set(row)
    assert {"least_possible_queries", "config", "records"} <= set(made)
    assert (out / "trials.parquet").exists()
    assert made["config"]["versions"]["mintpilot"]


def test_command_names_the_nearest_strategy(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "table1", "--strategy", "knowknow", "--json"]) == 2
    assert "Did you mean 'knowno'" in json.loads(capsys.readouterr().out)["error"]["message"]


def test_a_language_model_that_lacks_something_is_told_before_anything_is_flown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("MINTPILOT_LLM_URL", raising=False)
    folder = tmp_path / "records"
    assert main(["bench", "table1", "--llm", "embeded", "--out", str(folder)]) == 2
    assert "Did you mean 'embedded'" in capsys.readouterr().err
    assert main(["bench", "table1", "--llm", "endpoint", "--out", str(folder)]) in (2, 3)
    assert not folder.exists()


@pytest.mark.long
@pytest.mark.usefixtures("bad_plugins")
def test_a_lying_language_model_changes_no_outcome() -> None:
    plain_records = [plain(r) for r in here(experiment("mint", trials=4)) if isinstance(r, TrialRecord)]
    helped = experiment("mint", trials=4, llm="babbling")
    lied_to = [plain(r) for r in here(helped) if isinstance(r, TrialRecord)]
    assert [r["outcome"] for r in lied_to] == [r["outcome"] for r in plain_records]
    assert [r["asked"] for r in lied_to] == [r["asked"] for r in plain_records]
