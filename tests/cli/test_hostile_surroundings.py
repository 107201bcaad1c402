"""Input that is wrong or hostile, and bare surroundings: each ends with words, never with a traceback or a hang."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

EXAMPLE = Path("examples/my-building").resolve()


def program(*words: str, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "mintpilot", *words],
        capture_output=True,
        stdin=subprocess.DEVNULL,
        env={**os.environ, **(env or {})},
        timeout=100,
        check=False,
    )


def changed(folder: Path, old: str, new: str) -> Path:
    """The example mission with something else in it."""
    text = (EXAMPLE / "mission.yaml").read_text(encoding="utf-8")
    assert old in text
    file = folder / "mission.yaml"
    text = text.replace("map: building.yaml", f"map: {EXAMPLE}/building.yaml")
    file.write_text(text.replace(old, new), encoding="utf-8")
    return file


@pytest.mark.long
@pytest.mark.parametrize(
    "vehicle",
    ["cruise_mps: 1.0e-300", "max_acceleration_mps2: 1.0e-9", "radius_m: 1.0e+200", "margin_m: 1.0e+9"],
)
def test_a_vehicle_that_cannot_be_is_refused_at_its_line(tmp_path, vehicle):
    done = program(
        "check", str(changed(tmp_path, "vehicle: {radius_m: 0.3, cruise_mps: 1.5}", f"vehicle: {{{vehicle}}}"))
    )
    assert done.returncode == 2
    assert f"(vehicle.{vehicle.partition(':')[0]})".encode() in done.stdout + done.stderr


@pytest.mark.long
@pytest.mark.parametrize("character", ["\\e", "\\x07", "\\u202e", "\\u200f", "\\x9b"])
@pytest.mark.parametrize("key", ["name", "regions[0].description", "instruction"])
def test_what_steers_a_terminal_is_refused_at_its_line(tmp_path, key, character):
    text = (EXAMPLE / "mission.yaml").read_text(encoding="utf-8")
    name = key.rpartition(".")[2]
    line = next(line for line in text.splitlines() if line.strip().startswith(f"{name}:"))
    indent = line[: len(line) - len(line.lstrip())]
    file = changed(tmp_path, line, f'{indent}{name}: "the {character}[2J cloud"')
    done = program("check", str(file))
    said = done.stdout + done.stderr
    assert done.returncode == 2
    assert f"{key})".encode() in said
    assert b"is not seen by whoever reads this" in said
    assert b"\x1b" not in said


@pytest.mark.long
@pytest.mark.parametrize("operator", ["terminal", "console,terminal"])
def test_nobody_can_answer_from_dev_null(tmp_path, operator):
    done = program("run", str(EXAMPLE / "mission.yaml"), "--operator", operator, "--out", str(tmp_path / "run"))
    assert done.returncode == 2
    assert b"needs a standard input" in done.stderr


@pytest.mark.parametrize("words", [["--out", ""], ["--out="]])
def test_no_name_is_no_folder(words):
    done = program("run", str(EXAMPLE / "mission.yaml"), "--operator", "scripted", *words)
    assert done.returncode == 2
    assert b"give a file or a folder" in done.stderr


@pytest.mark.long
def test_a_pipe_is_no_mission(tmp_path):
    os.mkfifo(tmp_path / "mission.yaml")
    done = program("check", str(tmp_path / "mission.yaml"))
    assert done.returncode == 2
    assert b"no regular file" in done.stdout + done.stderr


@pytest.mark.long
def test_somebody_elses_folder_is_not_written_into(tmp_path):
    (tmp_path / "report.html").write_text("mine")
    done = program("run", str(EXAMPLE / "mission.yaml"), "--operator", "scripted", "--out", str(tmp_path))
    assert done.returncode == 4
    assert b"not empty" in done.stderr
    assert (tmp_path / "report.html").read_text() == "mine"
    assert [file.name for file in tmp_path.iterdir()] == ["report.html"]


@pytest.mark.long
def test_a_seed_that_is_none_is_refused():
    done = program("run", str(EXAMPLE / "mission.yaml"), "--operator", "scripted", "--seed", "-1")
    assert done.returncode == 2
    assert b"seed -1 must be" in done.stderr


@pytest.mark.long
def test_what_others_wrote_reaches_the_terminal_spelt_out():
    done = program("plan", str(EXAMPLE / "mission.yaml"), "--strategy", "\x1b[31mx")
    assert done.returncode == 2
    assert b"\x1b" not in done.stderr
    assert rb"\x1b[31mx" in done.stderr


@pytest.mark.long
def test_a_narrow_encoding_ends_no_mission(tmp_path):
    done = program(
        "run", str(EXAMPLE / "mission.yaml"), "--operator", "scripted", "--out", str(tmp_path / "run"),
        env={"PYTHONIOENCODING": "ascii"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


@pytest.mark.long
@pytest.mark.parametrize(("number", "name"), [(signal.SIGTERM, b"SIGTERM"), (signal.SIGHUP, b"SIGHUP")])
def test_being_told_to_end_is_named(tmp_path, number, name):
    out = tmp_path / "run"
    words = [sys.executable, "-m", "mintpilot", "run", str(EXAMPLE / "mission.yaml"), "--operator", "terminal"]
    process = subprocess.Popen(
        [*words, "--out", str(out)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stderr is not None
    for _ in range(600):
        if (out / "events.ndjson").exists() and len((out / "events.ndjson").read_bytes().splitlines()) > 3:
            break
        time.sleep(0.1)
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    assert name in said
    assert (out / "record.json").is_file()
