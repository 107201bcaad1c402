"""The examples in docs/language.md are understood."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mintpilot.core.query import Reply
from mintpilot.language import parse_instruction, read_answer

from . import questions

PAGE = Path(__file__).resolve().parents[2] / "docs" / "language.md"
EXAMPLES = re.findall(r"^\| [^|]+ \| `([^`]+)` \|$", PAGE.read_text("utf-8"), re.MULTILINE)


def test_the_page_has_examples() -> None:
    assert len(EXAMPLES) >= 10


@pytest.mark.parametrize("text", EXAMPLES)
def test_the_examples_are_understood(text: str) -> None:
    assert parse_instruction(text, home_m=(0.0, 0.0, 1.0)).subgoals


def test_the_answers_are_read_as_the_page_says() -> None:
    assert read_answer("it is toxic", questions.SMOKE, guarded=(Reply.YES,)).label == "no"
    both = (Reply.YES, Reply.NO)
    more = read_answer("Not the red one, the blue one", questions.BOX, guarded=both)
    assert more.label == "evidence:colour!=red,colour=blue"
    assert read_answer("yes, perfectly safe, thanks", questions.SMOKE, guarded=(Reply.YES,)).label == "read-back:yes"
