"""The embedded model: finding its file, and its process."""

from __future__ import annotations

import hashlib
import importlib
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from mintpilot.core.errors import DeviceError, InputError, MissingPartError
from mintpilot.models import gguf
from mintpilot.models.doubles import ReplayModel
from mintpilot.models.embedded import EmbeddedModel
from mintpilot.models.gguf import find_model, join_parts, part_files

needs_runtime = pytest.mark.skipif(find_spec("xllamacpp") is None, reason="xllamacpp is not installed")


def test_ones_own_file_comes_first(tmp_path: Path) -> None:
    own = tmp_path / "own.gguf"
    own.write_bytes(b"GGUF....")
    assert find_model(environment={"MINTPILOT_GGUF": str(own)}) == own
    assert find_model(str(own), {}) == own


def test_what_is_no_model_is_refused(tmp_path: Path) -> None:
    other = tmp_path / "other.gguf"
    other.write_bytes(b"PK...")
    with pytest.raises(InputError, match="not a GGUF file"):
        find_model(str(other), {})
    with pytest.raises(InputError, match="cannot be read"):
        find_model(str(tmp_path / "none.gguf"), {})


def test_parts_are_joined_only_into_the_pinned_file(tmp_path: Path) -> None:
    parts = [tmp_path / "a", tmp_path / "b"]
    parts[0].write_bytes(b"GGUF one ")
    parts[1].write_bytes(b"two")
    whole = tmp_path / "cache" / "model.gguf"
    with pytest.raises(InputError, match="not the pinned model"):
        join_parts(whole, parts, sha256="0" * 64)
    assert not whole.parent.exists()
    join_parts(whole, parts, sha256=hashlib.sha256(b"GGUF one two").hexdigest())
    assert whole.read_bytes() == b"GGUF one two"
    assert list(whole.parent.iterdir()) == [whole]


def test_a_file_in_the_cache_that_is_another_one_is_refused(tmp_path: Path) -> None:
    (tmp_path / gguf.NAME).write_bytes(b"GGUF something else")
    with pytest.raises(InputError, match="not the pinned model"):
        find_model(environment={"MINTPILOT_CACHE": str(tmp_path)})


def test_a_package_with_a_part_is_not_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "part_of_a_model"
    (package / "data").mkdir(parents=True)
    (package / "__init__.py").write_text("raise RuntimeError('was run')")
    (package / "data" / "part01.bin").write_bytes(b"x")
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    assert part_files(["part_of_a_model"]) == [package / "data" / "part01.bin"]
    with pytest.raises(MissingPartError, match="no_such_part"):
        part_files(["no_such_part"])


@needs_runtime
def test_a_file_that_cannot_be_loaded_is_one_error(tmp_path: Path) -> None:
    broken = tmp_path / "broken.gguf"
    broken.write_bytes(b"GGUF" + b"\x00" * 64)
    model = EmbeddedModel(str(broken))
    try:
        with pytest.raises(DeviceError, match="could not be loaded"):
            model.complete("Hello?", schema=None, timeout_s=60)
    finally:
        model.close()


@needs_runtime
def test_a_silent_process_is_waited_for_only_so_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = tmp_path / "own.gguf"
    own.write_bytes(b"GGUF")
    sleeper = tmp_path / "sleeper"
    sleeper.write_text("#!/bin/sh\nexec sleep 60\n")
    sleeper.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(sleeper))
    model = EmbeddedModel(str(own))
    try:
        for _ in range(2):
            with pytest.raises(DeviceError, match="did not answer in time"):
                model.complete("Hello?", schema=None, timeout_s=0.05)
    finally:
        model.close()


def test_recordings_are_read_and_bad_ones_refused(tmp_path: Path) -> None:
    tape = tmp_path / "tape.jsonl"
    tape.write_text('{"text": "one"}\n{"text": "two", "model": "m", "tokens": 3}\n')
    model = ReplayModel.from_file(tape)
    assert [model.complete("", schema=None, timeout_s=1).text for _ in range(2)] == ["one", "two"]
    with pytest.raises(DeviceError, match="at its end"):
        model.complete("", schema=None, timeout_s=1)
    tape.write_text('{"words": "one"}\n')
    with pytest.raises(InputError, match=r"tape.jsonl:1"):
        ReplayModel.from_file(tape)
    with pytest.raises(InputError, match="cannot be read"):
        ReplayModel.from_file(tmp_path / "none")


@pytest.mark.slow
@needs_runtime
@pytest.mark.skipif(find_spec(gguf.PARTS[0]) is None, reason="the embedded model's parts are not installed")
def test_the_pinned_model_answers() -> None:
    model = EmbeddedModel()
    try:
        model.wait(120)
        answer = model.complete("What is the capital of France? One word.", schema=None, timeout_s=120)
    finally:
        model.close()
    assert "Paris" in answer.text
    assert answer.tokens > 0
