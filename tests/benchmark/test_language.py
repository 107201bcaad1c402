"""``mintpilot bench language``: what is measured, and what is left out."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mintpilot.benchmark.instruction_trials import read_rows, score, upper_bound
from mintpilot.benchmark.language_cases import QUESTIONS, AnswerCase, answer_cases
from mintpilot.benchmark.language_report import LanguageOptions, language_tables, measure_language
from mintpilot.benchmark.language_trials import answer_all, sampled, word_all
from mintpilot.cli.bench_language import bench_language
from mintpilot.cli.exits import ExitCode
from mintpilot.core.errors import InputError, MissingPartError
from mintpilot.core.ports import LanguageModel
from mintpilot.language.instruction import parse_instruction
from mintpilot.models.doubles import FunctionModel, NoModel

LIST = """within\tinstruction\treference
yes\tPut the bowl in the microwave\tpick: bowl; deliver: bowl @ microwave
yes\tAvoid the smoke and wait at the gate for 5 seconds\tgo: gate ~5; out: smoke
yes\tJuggle the red box\tgo: red box
no\tGo to any other box\t-
"""


def _missing() -> LanguageModel:
    raise MissingPartError("no model here: pip install something")


@pytest.fixture
def listed(tmp_path: Path) -> Path:
    file = tmp_path / "list.tsv"
    file.write_text(LIST)
    return file


def test_the_cases_are_many_and_of_every_kind() -> None:
    cases = list(answer_cases())
    assert len(cases) > 2000
    assert {(case.reading, case.question.text) for case in cases} >= {
        (reading, q.text) for reading in ("yes", "no", "unsure", "other", "command") for q in QUESTIONS.values()
    }


def test_a_false_yes_and_a_no_for_a_yes_are_counted() -> None:
    smoke = QUESTIONS["smoke"]
    cases = [
        AnswerCase(text="yes", question=smoke, reading="no"),
        AnswerCase(text="no", question=smoke, reading="yes"),
        AnswerCase(text="banana", question=smoke, reading="unsure"),
    ]
    counted = answer_all(cases, NoModel())
    assert (counted.n, counted.understood, counted.false_guarded, counted.no_for_yes) == (3, 1, 1, 1)


def test_a_sample_is_seeded_and_in_order() -> None:
    cases = list(answer_cases())
    assert sampled(cases, 20) == sampled(cases, 20)
    assert len(sampled(cases, 20)) == 20
    assert sampled(cases[:5], 20) == cases[:5]


def test_wordings_are_counted_as_the_check_lets_them_through() -> None:
    same = word_all(FunctionModel(lambda prompt: prompt.rsplit("Question:", 1)[1].removesuffix("Rewritten:").strip()))
    assert (same.accepted, same.changed) == (same.n, 0)
    assert same.model_words == same.template_words
    turned = word_all(FunctionModel(lambda _: "Is it dangerous?"))
    assert turned.accepted == 0
    assert turned.speed.calls == turned.n


@pytest.mark.long
def test_what_is_missing_is_told_and_the_rest_is_measured(listed: Path) -> None:
    told: list[str] = []
    result = measure_language(LanguageOptions(models={"gone": _missing}, instructions=listed), told.append)
    assert [way.name for way in result.ways] == ["template"]
    assert result.ways[0].answered.false_guarded == 0
    assert result.left_out == ("gone: no model here: pip install something",)
    assert [caption for caption, _, _ in language_tables(result)] == [
        "Instructions",
        "Answers",
    ]


def test_a_file_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_rows(tmp_path / "none")
    (tmp_path / "empty").write_text("hello")
    with pytest.raises(InputError, match="columns must be"):
        read_rows(tmp_path / "empty")


def test_readings_are_compared_with_their_references(listed: Path) -> None:
    rows = read_rows(listed)
    found = score(rows, lambda text: parse_instruction(text, home_m=(0.0, 0.0, 1.0)))
    assert (found.n, found.within, found.right, found.wrong, found.refused) == (4, 3, 2, (), ("Juggle the red box",))
    beside = score(rows, lambda _: parse_instruction("go to the blue box"))
    assert (beside.right, len(beside.wrong)) == (0, 4)


def test_the_bound_on_a_share_is_the_exact_one() -> None:
    assert upper_bound(0, 300) == pytest.approx(1 - 0.05 ** (1 / 300))
    assert upper_bound(4, 4) == 1.0


@pytest.mark.long
def test_the_command_prints_one_object_and_keeps_it(listed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = listed.parent / "kept"
    code = bench_language(["template"], instructions=listed, sample=5, out=out, as_json=True)
    printed = json.loads(capsys.readouterr().out)
    assert code is ExitCode.SUCCESS
    assert printed == json.loads((out / "language.json").read_text())
    assert printed["ways"][0]["parsed"]["wrong"] == []
    assert bench_language(["template"], instructions=None, sample=5, out=None, as_json=False) is ExitCode.SUCCESS
    assert "Left out: instructions" in capsys.readouterr().out
    with pytest.raises(InputError, match="must be 1 or more"):
        bench_language([], instructions=None, sample=0, out=None, as_json=True)
