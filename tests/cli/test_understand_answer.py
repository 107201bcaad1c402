"""``mintpilot understand answer``: fields, kinds of question, files."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from mintpilot.cli.main import main

CASES = Path(__file__).resolve().parents[3] / "shared" / "cases" / "answers.tsv"
if not CASES.exists():  # the worktrees of a checkout lie one folder deeper
    CASES = Path(__file__).resolve().parents[4] / "shared" / "cases" / "answers.tsv"
KEYS = yaml.safe_dump(
    [
        {"id": "key-7", "description": "the brass key", "attributes": {"material": "brass"}},
        {"id": "key-8", "description": "the steel key on the left", "attributes": {"material": "steel"}},
    ]
)


def read(capsys: pytest.CaptureFixture[str], *words: str) -> list[dict[str, object]]:
    assert main(["understand", "answer", *words, "--json"]) == 0
    rows: list[dict[str, object]] = json.loads(capsys.readouterr().out)
    return rows


@pytest.mark.parametrize(
    ("words", "reading", "permissions"),
    [
        (["it is safe"], "yes", ["enter:smoke-1"]),
        (["it is safe", "--by", "voice"], "read-back:yes", ["enter:smoke-1"]),
        (["it is toxic"], "no", []),
        (["nobody", "--kind", "presence"], "no", ["leave-out:room-1"]),
        (["somebody is in there", "--kind", "presence"], "yes", []),
        (["the red one", "--kind", "target"], "evidence:colour=red", ["pick:box-1"]),
        (["the blue one", "--kind", "target"], "evidence:colour=blue", []),
        (["yes", "--kind", "target"], "yes", ["pick:box-1"]),
        (["come back"], "order:return", []),
        (["niemand", "--kind", "presence", "--lang", "de"], "no", ["leave-out:room-1"]),
        (["o", "--by", "key", "--lang", "fr"], "yes", ["enter:smoke-1"]),
        (["roger"], "again", []),
    ],
)
def test_an_answer_with_its_reading_and_what_it_allows(capsys, words, reading, permissions) -> None:
    assert read(capsys, *words) == [{"text": words[0], "reading": reading, "permissions": permissions}]


def test_candidates_come_from_a_list_or_from_a_mission(capsys, tmp_path: Path) -> None:
    keys = tmp_path / "keys.yaml"
    keys.write_text(KEYS)
    asked = ("--kind", "target", "--candidates", str(keys))
    assert read(capsys, "the steel one", *asked)[0]["permissions"] == ["pick:key-8"]
    assert read(capsys, "the left one", *asked)[0]["reading"] == "evidence:side=left"
    assert read(capsys, "the red one", *asked)[0]["reading"] == "again"
    mission = Path(__file__).resolve().parents[2] / "src" / "mintpilot" / "cli" / "missions" / "fire-warehouse.yaml"
    (row,) = read(capsys, "yes", "--candidates", str(mission))
    assert row["reading"] == "yes"
    assert [str(p).split(":")[0] for p in row["permissions"]] == ["enter"]  # type: ignore[union-attr]


def test_a_file_has_one_answer_a_line_and_lists_of_one_s_own_can_be_tried(capsys, tmp_path: Path) -> None:
    file = tmp_path / "answers.txt"
    file.write_text("yes\n\nit's locked ☠\nno\n", encoding="utf-8")
    assert [row["reading"] for row in read(capsys, "--file", str(file))] == ["yes", "again", "no"]
    assert main(["understand", "answer", "--file", str(file)]) == 0
    shown = capsys.readouterr().out
    assert "yes: yes  allows: enter:smoke-1" in shown
    assert "because of: ☠" in shown


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "Give either an answer"),
        (["yes", "--lang", "tlh"], "tlh"),
        (["yes", "--kind", "door"], "door"),
        (["--file", "/nowhere"], "cannot be read"),
        (["yes", "--candidates", "/nowhere"], "/nowhere"),
        (["--file", "/dev/zero"], "cannot be read"),
    ],
)
def test_wrong_words_end_with_2(capsys, words, said) -> None:
    assert main(["understand", "answer", *words]) == 2
    assert said in capsys.readouterr().err


def test_a_list_of_candidates_is_checked(capsys, tmp_path: Path) -> None:
    for number, (text, said) in enumerate((("- red\n- blue\n", "candidate 1"), ("- {id: a}\n", "two or more"))):
        file = tmp_path / f"{number}.yaml"
        file.write_text(text)
        assert main(["understand", "answer", "yes", "--kind", "target", "--candidates", str(file)]) == 2
        assert said in capsys.readouterr().err
    assert main(["understand", "answer", "yes", "--candidates", str(tmp_path / "1.yaml")]) == 2
    assert "--kind target only" in capsys.readouterr().err


@pytest.mark.skipif(not CASES.exists(), reason="needs ../shared/cases/answers.tsv")
def test_answers_that_were_read_wrongly_are_not_any_more(capsys) -> None:
    rows = [line.split("\t") for line in CASES.read_text("utf-8").splitlines() if line and not line.startswith("#")]
    kinds = {"smoke": "obstacle", "room": "presence"}
    for asked, text, wrong, kind in rows:
        lang = next((name for name in ("de", "fr", "es") if kind.endswith(f"({name})")), "en")
        reading = read(capsys, text, f"--kind={kinds[asked]}", f"--lang={lang}")[0]["reading"]
        assert reading not in (wrong.replace("command: ", "order:"), f"read-back:{wrong}"), text
