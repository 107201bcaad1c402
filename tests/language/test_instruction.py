"""Instruction in, steps out: what is read, and that nothing is read wrong without a word."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import InputError
from mintpilot.core.observation import RegionKind
from mintpilot.core.task import Action, Task, step_lines
from mintpilot.language import Capabilities, InstructionError, parse_instruction, parse_phrase

HOME_M = (0.0, 0.0, 1.0)
SEEK = "look for everybody who needs help"


def read(text: str) -> Task:
    return parse_instruction(text, home_m=HOME_M)


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("Fly over to the green drum.", ["go to the green drum"]),
        ("Could you please locate the wounded diver?", ["go to the wounded diver"]),
        ("Go to the lamp and the sofa, then come back", ["go to the lamp", "go to the sofa", "go to the start"]),
        ("Visit the red cone, then the yellow one", ["go to the red cone", "go to the yellow one"]),
        ("take off, fly to the mast and return to launch", ["go to the mast", "go to the start"]),
        ("RTL", ["go to the start"]),
        ("Hover at the fountain for half a minute", ["go to the fountain, stay there for 30 s"]),
        ("Go to 2, 5 at a height of 3 m", ["go to 2, 5, at a height of 3 m"]),
        ("Grab the rope from the bench", ["pick up the rope from the bench"]),
        ("Get the pills out of the white cabinet", None),
        ("Hand the torch to the nurse", ["pick up the torch", "bring the torch to the nurse"]),
        (
            "Find the lost hiker and bring her the blanket",
            ["go to the lost hiker", "pick up the blanket", "bring the blanket to the lost hiker"],
        ),
        (
            "Find the radio, pick it up and take it to the pilot",
            ["go to the radio", "pick up the radio", "bring the radio to the pilot"],
        ),
        ("Put the cup on the table", ["pick up the cup", "bring the cup to the table"]),
        ("Search the garage for the ladder", ["look into the garage for the ladder"]),
        ("Look for the wallet in the bedroom", ["look into the bedroom for the wallet"]),
        ("Is there somebody in the cellar?", ["look into the cellar for anyone"]),
        ("Check if anyone is stuck in the workshop", ["look into the workshop for anyone stuck"]),
        ("Look into the pantry and the attic", ["look into the pantry", "look into the attic"]),
        ("Look behind the blue door", ["look into the room behind the blue door"]),
        ("Find the trapped miner and see if anybody else is hurt", ["go to the trapped miner", SEEK]),
        ("Make sure nobody is left behind", [SEEK]),
        ("Count the chairs", ["count the chairs"]),
        ("How many people are in the library?", ["count people in the library"]),
        ("Take a photo of the statue", ["photograph the statue"]),
        ("Count the vans and photograph each of them", ["count the vans", "photograph the vans"]),
        ("Go to the pump and report what you see", ["go to the pump", "report what is seen at the pump"]),
        ("Before you visit the lake, go to the hut", ["go to the hut", "go to the lake"]),
        ("Go to the hut after checking the boat", ["go to the boat", "go to the hut"]),
    ],
)
def test_what_people_say_is_read_as_they_mean_it(text: str, steps: list[str] | None) -> None:
    if steps is None:
        with pytest.raises(InstructionError):
            read(text)
    else:
        assert [str(step.text) for step in read(text).steps] == steps


@pytest.mark.parametrize(
    ("text", "keep_out"),
    [
        ("Go to the desk without entering the smoke or any doors", ("smoke", "door")),
        ("Avoid the fumes, if possible, and go to the desk", ("smoke, if possible",)),
        ("Stay 3 m away from people and go to the desk", ("people (3 m)",)),
        ("Go to the desk, keeping at least one metre from the horses", ("horses (1 m)",)),
        ("Go to the desk, but stay away from the fire", ("fire (2 m)",)),
        ("Stay 1.5 m away from the smoke and go to the desk", ("smoke", "smoke (1.5 m)")),
        ("Don't fly through the smoke. Go to the desk.", ("smoke",)),
    ],
)
def test_what_is_stayed_out_of_is_read_whole(text: str, keep_out: tuple[str, ...]) -> None:
    task = read(text)
    assert [str(step.text) for step in task.steps] == ["go to the desk"]
    assert task.keep_out == keep_out


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("Visit every rack except the tall one", "except"),
        ("Go to the desk unless it is on fire", "unless"),
        ("Inspect only the lobby", "only"),
        ("Go to the chair that isn't blue", "isn't"),
        ("Go to the lamp or the sofa", "or"),
        ("Look into the lobby again", "again"),
        ("Go to the sofa in 15 seconds", "seconds"),
        ("Find three bottles", "three"),
        ("Go to the two lamps", "two"),
        ("Go to the lamp, not the sofa", "not"),
        ("Bring me the cup", "me"),
        ("Take the cup to us", "us"),
        ("Bring them the cup", "them"),
        ("Find the nurse and the pilot and bring him the cup", "him"),
        ("Go to the lamp and land", "land"),
        ("Film the parade", "film"),
        ("Go to the gizmo lamp", "gizmo"),
        ("Follow the boat", "follow"),
        ("Pick up the nurse", "the nurse"),
        ("Take the stairs to the roof", "the stairs"),
    ],
)
def test_a_word_that_is_not_understood_refuses_and_is_named(text: str, word: str) -> None:
    with pytest.raises(InstructionError) as refused:
        read(text)
    assert refused.value.word == word
    assert f"'{word}'" in str(refused.value)
    assert refused.value.reason


@pytest.mark.parametrize(
    "text",
    [
        "", "12 34", "!!!", "the red box", "go", "Go to the hut now and then", "Go to the hut, then to the lake first",
        "Go to the box next to the rack and the gate", "Take a selfie", "Give the man a hand", "Hello there",
        "Make sure everyone is injured", "Avoid the hut. Go to the hut.", "Go to the lamp over the bridge",
        "Bring the cup with the nurse to the lamp", "Go to the tower with the box", "Take a picture",
        "Find the nurse and the dog and photograph them", "Check the battery", "Go to the lamp at 5 pm",
        "Go to the lamp at 3 m/s", "Count the people and the boxes", "Bring the cup to the nurse and the pilot",
        "Pick up the cup and the plate", "There is a fire. Go to the lamp", "Avoid the smoke",
        "Stay 0 m away from people and go to the lamp",
        "go to the box and " * 400 + "go to the box", "Go to the lamp and the sofa at 3 m",
    ],
)  # fmt: skip
def test_what_is_unclear_or_impossible_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        read(text)


def test_a_wish_may_be_given_up_and_an_order_not() -> None:
    wished, ordered = read("Skip the smoke if you can and go to the hut"), read("Never enter the smoke. Go to the hut")
    assert (wished.avoid, wished.rules) == ((RegionKind.SMOKE,), ())
    assert (ordered.avoid, [rule.formula for rule in ordered.rules]) == ((), ["G !touches(smoke)"])


def test_slowly_is_of_the_whole_flight() -> None:
    task = read("Go slowly to the hut")
    assert task.slowly
    assert list(map(str, step_lines(task))) == ["1 go to the hut", "the whole flight slowly"]


def test_words_of_the_map_count_as_known() -> None:
    with pytest.raises(InstructionError):
        read("Go to the frobnicated lamp")
    task = parse_instruction("Go to the frobnicated lamp", known={"frobnicated"})
    assert task.subgoals[0].reference.attributes[0].value == "frobnicated"


def test_out_of_a_container_it_is_the_container_that_is_flown_to() -> None:
    (pick,) = read("Take the medicine from the red box").subgoals
    assert pick.reference.label == "box"
    assert {(a.name, a.value) for a in pick.reference.attributes} == {("colour", "red"), ("contents", "medicine")}
    (stands,) = read("Take the medicine from the table").subgoals
    assert (stands.reference.label, stands.reference.attributes[0].value) == ("medicine", "the table")


def test_without_a_start_nobody_comes_back() -> None:
    with pytest.raises(InstructionError, match="not known here"):
        parse_instruction("come back")


def test_a_vehicle_without_a_gripper_is_not_sent_to_pick_things_up() -> None:
    eyes_only = Capabilities(actions=frozenset({Action.GO, Action.LOOK}))
    with pytest.raises(InputError, match=r"pick up the box.*can only go to, look into"):
        parse_instruction("pick up the box", eyes_only)
    assert parse_instruction("find the box", eyes_only).subgoals[0].action is Action.GO


def test_a_phrase_by_itself_is_one_thing_or_refused() -> None:
    assert parse_phrase("the small red box").label == "box"
    for phrase in ("the box and the rack", "the", "not the box", ""):
        with pytest.raises(InstructionError):
            parse_phrase(phrase)


NOUNS = ("hut", "lamp", "sofa", "boat", "tree", "van")
CLAUSES = (
    "go to the {}", "find the {}", "photograph the {}", "approach the {}", "count the {}", "fly to the red {}",
)  # fmt: skip
plans = st.lists(st.tuples(st.sampled_from(CLAUSES), st.sampled_from(NOUNS)), min_size=1, max_size=5)


@pytest.mark.long
@given(plans, st.sampled_from((" and ", ", then ", ". ", "; ")))
def test_steps_keep_their_order(plan: list[tuple[str, str]], joint: str) -> None:
    task = read(joint.join(clause.format(noun) for clause, noun in plan))
    assert [goal.reference.label for goal in task.subgoals] == [noun for _, noun in plan]


STRANGE = st.text("bcdfghjklmnpqrstvwxz", min_size=4, max_size=9)


@pytest.mark.long
@given(plans, STRANGE, st.data())
def test_an_unknown_word_put_in_anywhere_refuses(plan: list[tuple[str, str]], word: str, data: st.DataObject) -> None:
    words = " and ".join(clause.format(noun) for clause, noun in plan).split()
    at = data.draw(st.integers(0, len(words)))
    with pytest.raises(InstructionError):
        read(" ".join((*words[:at], word, *words[at:])))


@pytest.mark.long
@pytest.mark.parametrize("word", ["except", "unless", "only", "not", "or", "again", "twice", "if", "until", "two"])
@given(plans, st.data())
def test_a_word_that_turns_the_meaning_round_refuses_wherever_it_stands(
    word: str, plan: list[tuple[str, str]], data: st.DataObject
) -> None:
    words = " and ".join(clause.format(noun) for clause, noun in plan).split()
    at = data.draw(st.integers(0, len(words)))
    with pytest.raises(InstructionError):
        read(" ".join((*words[:at], word, *words[at:])))


VOCABULARY = (
    "go to|the|box|and|,|.|;|(|3|it|or|red|bring|rooms|every|if|smoke|avoid|check|anyone|from|pick up|at 2 m|stay away|"
    "them|there|is|hover|in|kitchen|for|seconds|before|after|you"
)


@pytest.mark.long
@settings(deadline=None, max_examples=300)
@given(st.text(max_size=80) | st.lists(st.sampled_from(VOCABULARY.split("|")), max_size=14).map(" ".join))
def test_any_text_is_a_task_or_a_reason(text: str) -> None:
    try:
        task = read(text)
    except InputError:
        return
    assert task.steps
    assert all(goal.reference.position_m is not None or goal.reference.label for goal in task.subgoals)
