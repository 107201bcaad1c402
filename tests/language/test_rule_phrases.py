"""Phrases of instructions that are rules in time (method, section 14)."""

import pytest

from mintpilot.core.errors import InputError
from mintpilot.core.task import step_lines
from mintpilot.language.instruction import parse_instruction

HOME_M = (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("text", "steps", "formula"),
    [
        ("Look into the room before you go through the smoke.", ["look into the room"],
         "(looked(step-1) R (!touches(smoke) | looked(step-1)))"),
        ("Before you cross the hall, look into the kitchen, then go to the gate.",
         ["look into the kitchen", "go to the gate"], "(looked(step-1) R (!touches(hall) | looked(step-1)))"),
        ("Don't enter the smoke before you find the nurse. Go to the van", ["go to the nurse", "go to the van"],
         "(did(step-1) R (!touches(smoke) | did(step-1)))"),
        ("Check the kitchen. Never go through the smoke until you check the kitchen. Then go to the van.",
         ["look into the kitchen", "go to the van"], "(looked(step-1) R (!touches(smoke) | looked(step-1)))"),
        ("Bring the cup to the nurse before going through the smoke", ["pick up the cup", "bring the cup to the nurse"],
         "(did(step-1) R (!touches(smoke) | did(step-1)))"),
        ("Go to the gate before you go to the van", ["go to the gate", "go to the van"],
         "(did(step-2) R (!did(step-1) | did(step-2)))"),
        ("Go to the van after visiting the gate", ["go to the gate", "go to the van"],
         "(did(step-2) R (!did(step-1) | did(step-2)))"),
        ("Always stay within the hall and go to the gate", ["go to the gate"], "G inside(hall)"),
        ("Go to the gate. Stay in the hall at all times.", ["go to the gate"], "G inside(hall)"),
        ("Never leave the yard and go to the gate", ["go to the gate"], "G inside(yard)"),
        ("Come back at the end. Look into the kitchen and count the boxes",
         ["look into the kitchen", "count the boxes", "go to the start"], "F G did(step-1)"),
        ("Go to the gate and return to the start at the end", ["go to the gate", "go to the start"], "F G did(step-1)"),
        ("Never enter the lab. Go to the van", ["go to the van"], "G !touches(lab)"),
        ("Avoid the loading area and go to the van", ["go to the van"], "G !touches(loading area)"),
        ("Go to the van without entering the smoke", ["go to the van"], "G !touches(smoke)"),
        ("The marked area is off limits. Go to the van", ["go to the van"], "G !touches(area)"),
    ],
)  # fmt: skip
def test_a_phrase_becomes_a_rule_beside_the_steps(text: str, steps: list[str], formula: str) -> None:
    task = parse_instruction(text, home_m=HOME_M)
    assert [str(step.text) for step in task.steps] == steps
    assert [rule.formula for rule in task.rules] == [formula]
    assert f"rule: {task.rules[0].text}" in map(str, step_lines(task))


@pytest.mark.parametrize(
    "text",
    [
        "Check whether anyone is hurt before you go through the smoke",
        "Check every room before you go through the smoke",
        "Check whether anyone is hurt and come back at the end",
        "Always stay within the smoke and go to the gate",
        "Stay within 5 m of the gate",
        "Always stay within the room and go to the gate",
        "Never enter the room. Go to the van",
        "Always go to the gate",
        "Go to the gate before the battery is empty",
        "Never enter the smoke before",
        "Avoid the hall if possible and go to the van",
        "Go to the gate before you go near the van",
    ],
)
def test_a_rule_without_one_meaning_refuses_the_instruction(text: str) -> None:
    with pytest.raises(InputError):
        parse_instruction(text, home_m=HOME_M)


def test_many_things_before_a_step_are_an_order_and_no_rule() -> None:
    task = parse_instruction("Check every room before you go to the van", home_m=HOME_M)
    assert [str(step.text) for step in task.steps] == ["look into every room", "go to the van"]
    assert task.rules == ()
