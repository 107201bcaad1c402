"""Denials and confirmations in the question's own words, whichever way they are put; and slips of typing."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.query import Question
from mintpilot.language import Reading, understand_answer

from . import questions

NEARBY = replace(
    questions.SMOKE,
    text="Is the grey smoke near the crates safe to fly through?",
    gaps=(replace(questions.SMOKE_GAP, description="the grey smoke near the crates"),),
)
LEFT = replace(
    questions.ROOM,
    text="Is somebody inside the room on the left?",
    gaps=(replace(questions.ROOM_GAP, description="the room on the left"),),
)
SURE = ("", "definitely ", "really ", "certainly ", "absolutely ")
IT = ("", "it is ", "it's ", "that's ", "the grey smoke is ", "the grey smoke near the crates is ")
SAFE = ("safe", "safe to fly through")
INSIDE = ("inside", "in there", "in the room on the left", "inside the room on the left")
THE_BOX = ("the red box", "the small red box", "the red one")


def wrong(texts: list[str], question: Question, right: Reading) -> dict[str, Reading]:
    read = {text: understand_answer(text, question).reading for text in texts}
    return {text: reading for text, reading in read.items() if reading is not right}


@pytest.mark.parametrize("lead", ["", "no, "])
def test_denials_in_the_question_s_words_are_a_no(lead: str) -> None:
    ways = [f"{lead}{it}{sure}not {safe}" for it, sure, safe in product(IT, SURE, SAFE)]
    nobody = ("nobody is ", "there is no one ", "there's nobody ", "no one is ", "there isn't anybody ", "nobody ")
    rooms = [f"{lead}{who}{where}" for who, where in product(nobody, INSIDE)]
    boxes = [f"{lead}{it}{sure}not {box}" for it, sure, box in product(("", "it is ", "that's "), SURE, THE_BOX)]
    assert wrong(ways, NEARBY, Reading.NO) == {}
    assert wrong(rooms, LEFT, Reading.NO) == {}
    assert wrong(boxes, questions.BOX, Reading.NO) == {}


@pytest.mark.parametrize("lead", ["", "yes, "])
def test_confirmations_in_the_question_s_words_are_a_yes(lead: str) -> None:
    ways = [f"{lead}{it}{sure}{safe}" for it, sure, safe in product(IT, SURE, SAFE)]
    somebody = ("somebody is ", "there is someone ", "there's definitely somebody ", "there are people ")
    rooms = [f"{lead}{who}{where}" for who, where in product(somebody, INSIDE)]
    boxes = [f"{lead}{it}{sure}{box}" for it, sure, box in product(("", "it is ", "that's "), SURE, THE_BOX)]
    assert wrong(ways, NEARBY, Reading.YES) == {}
    assert wrong(rooms, LEFT, Reading.YES) == {}
    assert wrong(boxes, questions.BOX, Reading.YES) == {}


@pytest.mark.parametrize(
    "text",
    [
        "the grey smoke by the door is safe", "yes, the black smoke is safe", "yes the smoke is over there",
        "yes, the one by the gate", "yeah it's grey", "yes we have smoke masks", "that room is fine",
        "safe to fly over", "it looks bad but it is probably safe, go through", "it's saef", "not dangrous",
        "next to the grey smoke it is safe", "it will be safe to fly through", "yes that is the smoke",
        "ok cool thanks", "yes, kep out", "ok stya out", "yes, on",
        "yes, it's near the crates", "go through, no wait", "nothing there can hurt you if you stay high",
        "ok thank you, bye", "alright, cheers", "yes, it's",
    ],
)  # fmt: skip
def test_what_is_beside_the_point_opens_no_region(text: str) -> None:
    assert understand_answer(text, NEARBY).reply.value == "unsure"


@pytest.mark.parametrize(
    "text",
    ["yes, no one else", "yes, nobody but my brother", "yes, nobody got out", "nobody in the other room", "nott empty"],
)
def test_a_room_is_not_called_empty_by_a_word_of_it(text: str) -> None:
    assert understand_answer(text, LEFT).reading is not Reading.NO


@pytest.mark.parametrize(
    "text", ["Yes, I checked, there's nobody in there.", "yeah, nobody's inside", "nobdy is inside"]
)
def test_a_yes_word_before_the_opposite_is_a_no(text: str) -> None:
    assert understand_answer(text, LEFT).reading is Reading.NO


@settings(deadline=None, max_examples=200)
@given(st.sampled_from(["not safe", "it is dangerous", "toxic", "keep out", "unsafe"]), st.data())
def test_no_slip_in_a_refusal_opens_a_region(refusal: str, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(refusal) - 1))
    here, after = refusal[at], refusal[at + 1 :]
    slipped = refusal[:at] + data.draw(st.sampled_from([after, here * 2 + after, after[:1] + here + after[1:]]))
    lead = data.draw(st.sampled_from(["", "it is ", "yes, "]))
    assert understand_answer(lead + slipped, NEARBY).reading is not Reading.YES
