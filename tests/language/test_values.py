"""Lengths as answers: units, commas, words; what is no length; and how clear an estimate must be (section 13)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.core.gap import BLOCKED, PASSABLE, GapKind, KnowledgeGap
from mintpilot.core.query import Query, Reply
from mintpilot.core.reading import AnsweredBy, guarded_replies
from mintpilot.core.threshold import Threshold, ValueKind
from mintpilot.elicitation.candidates import passable_literal
from mintpilot.elicitation.wording import word_question
from mintpilot.language.answer_values import length_in
from mintpilot.language.answers import read_answer


def part(number: int, at_least_m: float, kind: ValueKind = ValueKind.CEILING) -> KnowledgeGap:
    threshold = Threshold(of="edge", subject="the grey smoke", kind=kind, at_least_m=at_least_m)
    return KnowledgeGap(
        id=f"obstacle:smoke-{number}", kind=GapKind.OBSTACLE, subject=f"smoke-{number}", description="the grey smoke",
        values=(PASSABLE, BLOCKED), prior=(0.5, 0.5), position_m=(0.0, 0.0, 0.0), threshold=threshold,
    )  # fmt: skip


GAPS = (part(1, 1.0), part(2, 2.0))
QUESTION = word_question(Query(literals=tuple(map(passable_literal, GAPS))), GAPS, None)


def read(text: str, by: str = "typed") -> str:
    return read_answer(text, QUESTION, guarded=guarded_replies(QUESTION), by=AnsweredBy(by)).label


@pytest.mark.parametrize(
    ("text", "metres"),
    [("0.9", 0.9), ("0.9 m", 0.9), ("3,5 m", 3.5), ("90 cm", 0.9), ("90cm", 0.9), ("three feet", 0.9144),
     ("3 ft.", 0.9144),
     ("about two metres", 2.0), ("half a metre", 0.5), ("zwei Meter", 2.0), ("environ deux mètres", 2.0),
     ("dos metros", 2.0), ("It is 2 m high.", 2.0), ("12 inches", 0.3048)],
)  # fmt: skip
def test_a_length_with_its_unit(text: str, metres: float) -> None:
    assert length_in(text) == pytest.approx(metres)


@pytest.mark.parametrize(
    "text",
    ["", "one", "wide", "m", "2 m or 3 m", "-2 m", "1e3", "2 kg", "2..5", "between 1 and 2 m", "two", "1.2.3", "0,9,1",
     "∞", "nan", "2 m if it stays", "not 2 m", "2 parsecs"],
)  # fmt: skip
def test_what_is_no_length(text: str) -> None:
    assert length_in(text) is None


@pytest.mark.parametrize(
    ("text", "label"),
    [("1.5 m", "no"), ("five feet", "no"), ("2 m", "again"), ("2.5 m", "again"), ("3 m", "read-back:yes"),
     ("ten feet", "read-back:yes"), ("3 m?", "again"), ("yes", "yes"), ("no", "no"), ("it is safe", "again"),
     ("it is burning", "no"), ("two kilos", "again")],
)  # fmt: skip
def test_what_a_length_says_to_a_threshold(text: str, label: str) -> None:
    assert QUESTION.text == "Is the lower edge of the grey smoke at least 2 m high?"
    assert read(text) == label


@given(st.floats(0, 50), st.sampled_from(["m", "cm", "feet", ""]))
def test_a_length_is_never_a_plain_yes(number: float, unit: str) -> None:
    assert read(f"{number:.2f} {unit}".strip()) in ("no", "again", "read-back:yes")
    assert guarded_replies(QUESTION) == {Reply.YES}
