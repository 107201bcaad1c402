"""Instructions in free words, put into typed steps by a model that is not trusted."""

from __future__ import annotations

import json

import pytest

from mintpilot.core.errors import InputError
from mintpilot.core.task import Action
from mintpilot.language import Capabilities, parse_with_model
from mintpilot.models.doubles import FunctionModel, NoModel

GERMAN = "Flieg zum roten Fass, aber bleib 3 m vom Rauch weg"
ENGLISH = "Somebody poor over at the red box could use the medicine, the injured person"


def says(*steps: tuple[str, str, str], keep_out: list[dict[str, object]] | None = None) -> FunctionModel:
    rows = [{"action": action, "target": target, "place": place} for action, target, place in steps]
    return FunctionModel(lambda _: json.dumps({"steps": rows, "keep_out": keep_out or []}))


def test_another_language_becomes_typed_steps_that_wait_for_a_yes() -> None:
    model = says(("go", "the red barrel", ""), keep_out=[{"what": "the smoke", "metres": 3}])
    task = parse_with_model(GERMAN, model)
    assert [str(step.text) for step in task.steps] == ["go to the red barrel"]
    assert task.keep_out == ("smoke", "smoke (3 m)")
    assert task.needs_confirmation
    assert task.instruction == GERMAN


def test_what_the_grammar_reads_needs_no_confirmation_and_no_model() -> None:
    def fails(_: str) -> str:
        raise AssertionError("the model was asked")

    assert not parse_with_model("Go to the red box", FunctionModel(fails)).needs_confirmation


@pytest.mark.parametrize(
    ("text", "model"),
    [
        (GERMAN, says(("go", "the red barrel", ""))),
        (GERMAN, says(("go", "the red barrel", ""), keep_out=[{"what": "the smoke", "metres": 30}])),
        ("Flieg nicht zum Fass", says(("go", "the barrel", ""))),
        ("Va vers la tour sauf si elle brûle", says(("go", "the tower", ""))),
        (ENGLISH, says(("go", "the blue box", ""))),
        (ENGLISH, says(("go", "the red box", ""))),
        ("Wander over to the lamp unless it is dark", says(("go", "the lamp", ""))),
        ("Flieg zum Turm", says(("go", "the tower and the lamp or me", ""))),
        ("Flieg zum Turm", says(("pick", "the tower", ""))),
        ("Flieg zum Turm", FunctionModel(lambda _: '{"steps": [{"action": "shoot", "target": "the tower"}]}')),
        ("Flieg zum Turm", NoModel()),
    ],
)
def test_what_adds_drops_or_cannot_be_done_is_refused_with_the_grammars_reason(text: str, model: FunctionModel) -> None:
    with pytest.raises(InputError, match="is not understood because of"):
        parse_with_model(text, model)


def test_the_steps_are_checked_against_the_vehicle() -> None:
    with pytest.raises(InputError):
        parse_with_model(
            "Nimm die Flasche", says(("pick", "the bottle", "")), Capabilities(actions=frozenset({Action.GO}))
        )
