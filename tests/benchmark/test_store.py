"""Folders of records that are old, damaged, full or gone."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.benchmark.small import experiment

from mintpilot.benchmark.records import TrialRecord, read_shard
from mintpilot.benchmark.store import RecordStore, finished_in, read_config, read_records
from mintpilot.benchmark.trial import broken_trial
from mintpilot.cli.main import main
from mintpilot.core.errors import RecordError

EXPERIMENT = experiment("mint", "exhaustive")


def record(seed: int = 2, method: str = "mint") -> TrialRecord:
    return broken_trial(EXPERIMENT, EXPERIMENT.cells[0], seed, method, "raised", "it raised")


def filled(folder: Path) -> Path:
    with RecordStore(folder, EXPERIMENT) as store:
        store.append("worker-0", record())
        store.append("worker-1", record(method="exhaustive"))
    return folder


def test_what_is_appended_is_read_back(tmp_path: Path) -> None:
    folder = filled(tmp_path / "bench")
    assert read_config(folder) == EXPERIMENT
    assert read_records(folder) == ([record(method="exhaustive"), record()], [])
    assert finished_in(folder) == {("", 2, "mint"), ("", 2, "exhaustive")}
    with RecordStore(folder, EXPERIMENT) as again:
        again.append("worker-0", record(seed=3))
    assert len(list((folder / "shards").iterdir())) == 3


def test_records_of_another_schema_are_refused_with_advice(tmp_path: Path) -> None:
    folder = filled(tmp_path / "bench")
    shard = next((folder / "shards").iterdir())
    old = json.loads(shard.read_text()) | {"schema_version": 0}
    shard.write_text(json.dumps(old) + "\n")
    with pytest.raises(RecordError, match=r"ndjson:1: record of schema version 0, this program reads 1; .*config.json"):
        read_records(folder)
    with pytest.raises(RecordError, match="schema version 0"), RecordStore(folder, EXPERIMENT):
        finished_in(folder)


def test_damaged_lines_are_named_but_a_last_one_cut_off_is_left_out(tmp_path: Path) -> None:
    shard = tmp_path / "001-worker-0.ndjson"
    line = record().model_dump_json()
    shard.write_text(f"{line}\n{line[:50]}")
    assert read_shard(shard) == [record()]
    shard.write_text(f"{line[:50]}\n{line}\n")
    with pytest.raises(RecordError, match=r"ndjson:1: not JSON"):
        read_shard(shard)
    shard.write_text(json.dumps(json.loads(line) | {"questions": "many"}) + "\n")
    with pytest.raises(RecordError, match=r"ndjson:1: questions: .*delete that line"):
        read_shard(shard)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full, a disk that is always full")
def test_a_full_disk_keeps_what_was_written(tmp_path: Path) -> None:
    folder = filled(tmp_path / "bench")
    full = folder / "shards" / "002-worker-0.ndjson"
    with RecordStore(folder, EXPERIMENT) as store:
        full.symlink_to("/dev/full")
        with pytest.raises(RecordError, match=r"No space left on device; make room and give the same command again"):
            store.append("worker-0", record(seed=3))
        store.append("worker-1", record(seed=3))
    full.unlink()
    assert len(read_records(folder)[0]) == 3


def test_folders_that_are_no_benchmarks_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "report", str(tmp_path), "--out", str(tmp_path / "page.html")]) == 4
    assert f"{tmp_path} holds no benchmark" in capsys.readouterr().err
    (tmp_path / "config.json").write_text('{"config_version": 0}')
    with pytest.raises(RecordError, match="another version or was changed"):
        read_config(tmp_path)
    with pytest.raises(RecordError, match="cannot write to"):
        RecordStore(tmp_path / "config.json" / "below", EXPERIMENT)
