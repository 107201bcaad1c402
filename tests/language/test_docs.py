"""The examples in docs/language.md are understood."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mintpilot.language import Reading, parse_instruction, understand_answer

from . import questions

PAGE = Path(__file__).resolve().parents[2] / "docs" / "language.md"
EXAMPLES = re.findall(r"^\| [^|]+ \| `([^`]+)` \|$", PAGE.read_text("utf-8"), re.MULTILINE)


def test_the_page_has_examples() -> None:
    assert len(EXAMPLES) >= 10


@pytest.mark.parametrize("text", EXAMPLES)
def test_the_examples_are_understood(text: str) -> None:
    assert parse_instruction(text, home_m=(0.0, 0.0, 1.0)).subgoals


def test_the_answers_are_read_as_the_page_says() -> None:
    assert understand_answer("it is toxic", questions.SMOKE).reading is Reading.NO
    more = understand_answer("Not the red one, the blue one", questions.BOX)
    assert more.reading is Reading.NO
    assert more.also is not None
