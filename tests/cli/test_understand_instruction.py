"""``mintpilot understand instruction``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mintpilot.cli.main import main

MISSION = Path(__file__).resolve().parents[2] / "examples" / "my-building" / "mission.yaml"


def printed(capsys: pytest.CaptureFixture[str], *words: str, code: int = 0) -> str:
    assert main(["understand", "instruction", *words]) == code
    return capsys.readouterr().out


def test_the_steps_are_printed_and_what_is_stayed_out_of(capsys: pytest.CaptureFixture[str]) -> None:
    out = printed(capsys, "Find the nurse and bring her the cup, and avoid the smoke")
    assert out.splitlines() == [
        "1 go to the nurse", "2 pick up the cup", "3 bring the cup to the nurse", "rule: never enter the smoke",
    ]  # fmt: skip


def test_as_json_with_the_word_that_refuses(capsys: pytest.CaptureFixture[str]) -> None:
    done = json.loads(printed(capsys, "Search the garage for the rope", "--json"))
    assert done["steps"] == [
        {
            "n": 1, "action": "look", "target": "the rope", "place": "the garage",
            "text": "look into the garage for the rope",
        }
    ]  # fmt: skip
    assert (done["keep_out"], done["refused"]) == ([], None)
    refused = json.loads(printed(capsys, "Go to the lamp or the sofa", "--json", code=2))
    assert (refused["steps"], refused["refused"]["word"]) == ([], "or")


def test_a_mission_says_what_there_is(capsys: pytest.CaptureFixture[str]) -> None:
    assert "1 go to the box" in printed(capsys, "Go to the box and come back", str(MISSION))
    refused = json.loads(printed(capsys, "Go to the fountain", str(MISSION), "--json", code=2))
    assert refused["refused"]["word"] == "the fountain"
    assert "Seen was" in refused["refused"]["reason"]


def test_a_list_is_read_line_by_line(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "list.txt"
    file.write_text("# a list\nGo to the hut\twhatever\n\nDance\n")
    rows = json.loads(printed(capsys, "--file", str(file), "--json"))
    assert [(row["text"], row["refused"] is None) for row in rows] == [("Go to the hut", True), ("Dance", False)]
    assert "  refused: 'dance'" in printed(capsys, "--file", str(file))


def test_nothing_to_read_is_an_error(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    printed(capsys, code=2)
    printed(capsys, "--file", str(tmp_path / "none"), code=2)
