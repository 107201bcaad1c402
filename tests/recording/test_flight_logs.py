"""``flight.mcap`` read back by the independent reader, after a whole flight, a cut one and a full disk."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from mcap.reader import make_reader

from mintpilot import run_mission
from mintpilot.cli.main import main
from mintpilot.core.errors import InputError, RecordError
from mintpilot.recording.flight_logs import log_info, recover, track_csv, track_geojson
from mintpilot.recording.mcap_log import MCAP_FILE, McapRecorder
from mintpilot.recording.record import read_record
from mintpilot.recording.run_folder import RunFolder
from mintpilot.recording.run_list import Run, listed, to_remove

from .conftest import tell

EXAMPLE = Path(__file__).parents[2] / "examples" / "my-building" / "mission.yaml"
TOPICS = {"/map", "/grid", "/tf", "/path/planned", "/path/flown", "/log", "/gaps", "/tree", "/query", "/answer",
          "/directive", "/mission", "/verdict"}  # fmt: skip


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "one"
    run_mission(EXAMPLE, vehicle="kinematic", out=folder)
    return folder


def read(file: Path) -> list:
    with file.open("rb") as stream:
        return list(make_reader(stream).iter_messages())


@pytest.mark.long
def test_the_independent_reader_reads_what_was_flown(run: Path) -> None:
    messages = read(run / MCAP_FILE)
    assert {channel.topic for _, channel, _ in messages} >= TOPICS
    for schema, channel, message in messages:
        assert schema is not None
        if channel.message_encoding == "json":
            assert isinstance(json.loads(message.data), dict)
        else:
            assert schema.name.startswith("foxglove.")
            assert decoded(schema, message.data) is not None
    times = [message.log_time for _, _, message in messages]
    assert times == sorted(times)
    assert (run / MCAP_FILE).stat().st_size < 2_000_000
    verdict = next(json.loads(m.data) for _, c, m in messages if c.topic == "/verdict")
    assert verdict["outcome"] == json.loads((run / "record.json").read_text())["outcome"]


def decoded(schema, data: bytes):  # type: ignore[no-untyped-def]
    """With the schema in the file alone, as a viewer does."""
    from google.protobuf.descriptor_pb2 import FileDescriptorSet
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message_factory import GetMessageClass

    pool = DescriptorPool()
    for file in FileDescriptorSet.FromString(schema.data).file:
        pool.Add(file)
    return GetMessageClass(pool.FindMessageTypeByName(schema.name)).FromString(data)


@pytest.mark.long
def test_poses_are_those_of_the_lossless_log(run: Path) -> None:
    messages = [(s, m) for s, c, m in read(run / MCAP_FILE) if c.topic == "/tf"]
    rows = [line.split(",") for line in track_csv(run).splitlines()[1:]]
    assert len(rows) == len(messages) > 3
    for (schema, message), row in zip(messages, rows, strict=True):
        place = decoded(schema, message.data).translation
        assert (place.x, place.y, place.z) == pytest.approx(tuple(float(v) for v in row[1:4]), abs=1e-3)


@pytest.mark.long
def test_a_flight_log_alone_tells_the_same_track_but_the_battery(run: Path, tmp_path: Path) -> None:
    whole = [line.split(",") for line in track_csv(run).splitlines()]
    assert [line.split(",") for line in track_csv(run / MCAP_FILE).splitlines()] == whole
    alone = tmp_path / "alone.mcap"
    alone.write_bytes((run / MCAP_FILE).read_bytes())
    rows = [line.split(",") for line in track_csv(alone).splitlines()]
    assert rows[0] == whole[0]
    assert len(rows) == len(whole)
    for row, other in zip(rows[1:], whole[1:], strict=True):
        assert [float(v) for v in row[:5]] == pytest.approx([float(v) for v in other[:5]], abs=2e-3)
        assert row[5] == ""
    with pytest.raises(RecordError, match="no georeference"):
        track_geojson(alone)
    text = tmp_path / "text.mcap"
    text.write_bytes(b"hello, this is text")
    with pytest.raises(RecordError, match="no MCAP"):
        track_csv(text)


@pytest.mark.long
@pytest.mark.parametrize("share", [0.0, 0.3, 0.7, 0.999])
def test_a_file_that_breaks_off_is_mended_up_to_there(run: Path, share: float, tmp_path: Path) -> None:
    whole = (run / MCAP_FILE).read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole[: max(60, int(share * len(whole)))])
    assert not log_info(cut).whole
    count = recover(cut, tmp_path / "mended.mcap")
    mended = read(tmp_path / "mended.mcap")
    before = read(run / MCAP_FILE)
    assert count == len(mended) <= len(before)
    assert [m.data for _, _, m in mended] == [m.data for _, _, m in before[: len(mended)]]
    sizes = [len(m.data) for _, _, m in before]
    assert sum(sizes[: len(mended)]) >= (share - 0.5) * len(whole), "schemas and the footer take the rest"
    with pytest.raises(RecordError, match="exists"):
        recover(cut, tmp_path / "mended.mcap")


def test_what_is_no_log_is_refused(tmp_path: Path, run: Path) -> None:
    (tmp_path / "x.mcap").write_bytes(b"hello, this is text")
    for path, said in ((tmp_path / "x.mcap", "no MCAP"), (tmp_path, "neither"), (tmp_path / "x.txt", "no log")):
        with pytest.raises(RecordError, match=said):
            log_info(path)
    with pytest.raises(RecordError, match="no georeference"):
        track_geojson(run)


def test_the_commands(run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["log", "info", str(run), "--json"]) == 0
    info = json.loads(capsys.readouterr().out)
    assert info["whole"]
    assert info["topics"]["/verdict"] == 1
    assert main(["log", "info", str(run / "events.ndjson")]) == 0
    assert "whole" in capsys.readouterr().out
    assert main(["log", "export", str(run), "--out", str(tmp_path / "t.csv")]) == 0
    assert (tmp_path / "t.csv").read_text().startswith("time_s,x_m")
    assert main(["log", "recover", str(run), "--out", str(tmp_path / "r.mcap")]) == 0
    capsys.readouterr()
    assert main(["runs", str(run.parent), "--json"]) == 0
    (one,) = json.loads(capsys.readouterr().out)["runs"]
    assert one["outcome"] == json.loads((run / "record.json").read_text())["outcome"]


@pytest.mark.long
def test_a_flight_that_is_killed_keeps_what_was_written(tmp_path: Path) -> None:
    code = "\n".join(
        (
            "import time",
            "from pathlib import Path",
            "from mintpilot import run_mission",
            f"run_mission({str(EXAMPLE)!r}, vehicle='kinematic', out=Path({str(tmp_path / 'r')!r}),",
            "            progress=lambda event: time.sleep(0.02))",
        )
    )
    process = subprocess.Popen([sys.executable, "-c", code])
    file = tmp_path / "r" / MCAP_FILE
    until = time.monotonic() + 240
    while time.monotonic() < until and process.poll() is None:
        if file.exists() and file.stat().st_size > 20_000:
            break
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    found = log_info(file)
    assert not found.whole
    assert found.entries > 5
    assert recover(file, tmp_path / "m.mcap") == found.entries
    assert [one.outcome for one in listed(tmp_path)] == ["broken-off"]


@pytest.mark.long
@pytest.mark.parametrize("failing", [1, 2, 5, 9, 14])
@pytest.mark.parametrize("share", [0.0, 0.5, 0.99])
def test_a_write_that_fails_half_way_leaves_a_readable_file_and_is_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failing: int, share: float
) -> None:
    whole, torn = tmp_path / "whole", tmp_path / "torn"
    with RunFolder(whole) as folder:
        for event in 2 * tell():
            folder.record(event)
    real, writes = os.pwrite, 0

    def full(descriptor: int, data: memoryview, offset: int) -> int:
        nonlocal writes
        writes += 1
        if writes != failing:
            return real(descriptor, data, offset)
        real(descriptor, data[: int(share * len(data))], offset)
        raise OSError(errno.ENOSPC, "No space left on device")

    with RunFolder(torn) as folder:
        monkeypatch.setattr(os, "pwrite", full)
        for event in 2 * tell():
            folder.record(event)
    kept, wanted = read(torn / MCAP_FILE), [(c.topic, m.sequence) for _, c, m in read(whole / MCAP_FILE)]
    assert log_info(torn).whole
    assert [c.topic for _, c, _ in kept if c.topic not in {t for t, _ in wanted}] == []
    missing = [one for one in wanted if one not in {(c.topic, m.sequence) for _, c, m in kept}]
    assert 1 <= len(missing) <= 2, "one event, of at most two messages"
    assert {topic for topic, _ in wanted} == {c.topic for _, c, _ in kept}, "the same topic came again and is readable"
    lost = [n.text for n in read_record(torn).notices if n.kind == "record-incomplete"]
    assert lost == ["1 times something could not be written: the flight for viewers (No space left on device)."]


def test_a_footer_that_does_not_fit_leaves_a_file_that_can_be_mended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorder = McapRecorder(tmp_path / MCAP_FILE)
    for event in tell():
        recorder.record(event)
    before, real, writes = (tmp_path / MCAP_FILE).stat().st_size, os.pwrite, 0

    def full(descriptor: int, data: memoryview, offset: int) -> int:
        nonlocal writes
        writes += 1
        if writes == 1:
            return real(descriptor, data, offset)
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "pwrite", full)
    with pytest.raises(OSError, match="No space left"):
        recorder.close()
    assert (tmp_path / MCAP_FILE).stat().st_size == before
    monkeypatch.undo()
    found = log_info(tmp_path / MCAP_FILE)
    assert not found.whole
    assert recover(tmp_path / MCAP_FILE, tmp_path / "m.mcap") == found.entries == len(read(tmp_path / "m.mcap"))


def test_pruning_names_what_goes_and_removes_it_only_when_told(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import shutil

    for name in ("a", "b", "c"):
        shutil.copytree(run, tmp_path / name)
    (tmp_path / "other").mkdir()
    assert main(["runs", str(tmp_path), "--prune", "--keep", "1"]) == 0
    assert capsys.readouterr().out.count("would be removed") == 2
    assert main(["runs", str(tmp_path), "--prune", "--keep", "1", "--yes"]) == 0
    assert sorted(path.name for path in tmp_path.iterdir() if path.name != "other") == ["a"]
    assert main(["runs", str(tmp_path), "--prune"]) == 2
    assert main(["runs", str(tmp_path), "--keep", "1"]) == 2


def test_old_and_many_are_both_needed_where_both_are_given() -> None:
    runs = [Run(path=Path(str(n)), name="", begun_s=-86_400.0 * n, outcome="", size_bytes=0) for n in range(4)]
    assert [str(r.path) for r in to_remove(runs, 0.0, older_than_days=1.5)] == ["2", "3"]
    assert [str(r.path) for r in to_remove(runs, 0.0, keep=1)] == ["1", "2", "3"]
    assert [str(r.path) for r in to_remove(runs, 0.0, older_than_days=1.5, keep=3)] == ["3"]
    with pytest.raises(InputError, match="negative"):
        to_remove(runs, 0.0, keep=-1)
