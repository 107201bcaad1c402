"""``mintpilot bench language``: what is measured, and what is left out."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mintpilot.benchmark.introplan import Scene, ambiguity, meant_by_model, meant_by_rules, read_scenes
from mintpilot.benchmark.language_cases import QUESTIONS, AnswerCase, answer_cases, instruction_cases
from mintpilot.benchmark.language_report import LanguageOptions, language_tables, measure_language
from mintpilot.benchmark.language_trials import answer_all, sampled, word_all
from mintpilot.cli.bench_language import bench_language
from mintpilot.cli.exits import ExitCode
from mintpilot.core.errors import InputError, MissingPartError
from mintpilot.core.ports import LanguageModel
from mintpilot.language.doubles import FunctionModel, NoModel

SCENES = """0
Task: Bring me the sponge.
Possible objects: clean sponge, dirty sponge with food residue
Scene objects: clean sponge, dirty sponge with food residue, Pepsi

1
Task: Put the bowl in the microwave.
Possible objects: plastic bowl
Scene objects: plastic bowl, microwave

2
Task: Give me the rice chips.
Possible objects: rice chips
Scene objects: rice chips, kettle chips
"""


def _missing() -> LanguageModel:
    raise MissingPartError("no model here: pip install something")


@pytest.fixture
def scenes(tmp_path: Path) -> Path:
    file = tmp_path / "scenes.txt"
    file.write_text(SCENES)
    return file


def test_the_cases_are_many_and_of_every_kind() -> None:
    cases = list(answer_cases())
    assert len(cases) > 2000
    assert {(case.reading, case.question.text) for case in cases} >= {
        (reading, q.text) for reading in ("yes", "no", "unsure", "other", "command") for q in QUESTIONS.values()
    }
    assert sum(len(group) for group in instruction_cases().values()) >= 100


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


def test_what_is_missing_is_told_and_the_rest_is_measured(scenes: Path) -> None:
    told: list[str] = []
    result = measure_language(LanguageOptions(models={"gone": _missing}, instructions=scenes), told.append)
    assert [way.name for way in result.ways] == ["template"]
    assert result.ways[0].answered.false_guarded == 0
    assert result.left_out == ("gone: no model here: pip install something",)
    assert [caption for caption, _, _ in language_tables(result)] == [
        "Instructions",
        "Answers",
        "Ambiguous instructions",
    ]


def test_things_are_meant_by_kind_and_never_by_place(scenes: Path) -> None:
    sponge, bowl, chips = read_scenes(scenes)
    assert meant_by_rules(sponge) == {"clean sponge", "dirty sponge with food residue", "Pepsi"}
    assert meant_by_rules(bowl) == {"plastic bowl"}
    assert meant_by_rules(chips) == {"rice chips"}
    shares = ambiguity("rules", "all", [sponge, bowl, chips], meant_by_rules)
    assert (shares.n, round(shares.exact, 2), shares.over_ask, shares.over_step, shares.unsafe) == (3, 0.67, 0, 0, 0)


def test_a_model_is_asked_where_the_instruction_names_nothing() -> None:
    scene = Scene(task="Bring me a snack.", objects=("apple", "wrench"), possible=frozenset({"apple"}), number=0)
    model = FunctionModel(lambda prompt: "yes" if prompt.rstrip().endswith("Thing: apple\nAnswer:") else "no")
    assert meant_by_model(scene, model) == {"apple"}
    assert meant_by_model(scene, NoModel()) == set(scene.objects)


def test_a_file_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_scenes(tmp_path / "none")
    (tmp_path / "empty").write_text("hello")
    with pytest.raises(InputError, match="hold no block"):
        read_scenes(tmp_path / "empty")


def test_the_command_prints_one_object_and_keeps_it(scenes: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = scenes.parent / "kept"
    code = bench_language(["template"], instructions=scenes, sample=5, out=out, as_json=True)
    printed = json.loads(capsys.readouterr().out)
    assert code is ExitCode.SUCCESS
    assert printed == json.loads((out / "language.json").read_text())
    assert printed["ways"][0]["parsed"]["as_something_else"] == 0
    assert bench_language(["template"], instructions=None, sample=5, out=None, as_json=False) is ExitCode.SUCCESS
    assert "Left out: ambiguous instructions" in capsys.readouterr().out
    with pytest.raises(InputError, match="must be 1 or more"):
        bench_language([], instructions=None, sample=0, out=None, as_json=True)
