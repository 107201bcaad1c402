"""Instruction in, task out, by rules."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.benchmark.language_cases import written
from mintpilot.core.errors import InputError
from mintpilot.core.task import Action
from mintpilot.language import Capabilities, parse_instruction

from .instructions import CASES, PARAPHRASES, PLAIN, REFUSED

HOME_M = (0.0, 0.0, 1.0)


@pytest.mark.parametrize(("text", "expected"), [case for group in CASES.values() for case in group.items()])
def test_instructions_are_understood(text: str, expected: tuple[str, ...]) -> None:
    home_m = HOME_M if {"back", "home"} & set(text.lower().split()) else None
    task = parse_instruction(text, home_m=home_m)
    assert written(task) == expected
    assert task.instruction == text


@pytest.mark.parametrize(("text", "reason"), REFUSED.items())
def test_what_is_unclear_or_impossible_is_refused_with_its_reason(text: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        parse_instruction(text)


def test_there_are_forty_of_them_and_half_are_paraphrases() -> None:
    assert len(PLAIN) >= 20
    assert len(PARAPHRASES) >= 20


def test_a_vehicle_without_a_gripper_is_not_sent_to_pick_things_up() -> None:
    eyes_only = Capabilities(actions=frozenset({Action.GO, Action.LOOK}))
    with pytest.raises(InputError, match=r"pick up at the box.*can only go to, look into"):
        parse_instruction("pick up the box", eyes_only)
    assert parse_instruction("find the box", eyes_only).subgoals[0].action is Action.GO


def test_an_endless_instruction_is_refused() -> None:
    with pytest.raises(InputError, match="keep it under"):
        parse_instruction("go to the box and " * 400 + "go to the box")


WORDS = st.sampled_from(
    [
        "go",
        "to",
        "the",
        "box",
        "and",
        ",",
        ".",
        ";",
        "(",
        "3",
        "it",
        "or",
        "red",
        "bring",
        "rooms",
        "every",
        "if",
        "smoke",
        "avoid",
        "check",
        "anyone",
        "from",
        "pick",
        "up",
    ]
)


@settings(deadline=None, max_examples=200)
@given(st.text(max_size=80) | st.lists(WORDS, max_size=14).map(" ".join))
def test_any_text_is_a_task_or_a_reason(text: str) -> None:
    try:
        task = parse_instruction(text)
    except InputError:
        return
    assert task.subgoals
    assert all(g.reference.position_m is not None or g.reference.label for g in task.subgoals)
