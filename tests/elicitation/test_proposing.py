"""Proposed cuts count only when they are sound; what a model reads counts only when it agrees with itself."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.language import questions

from mintpilot.core.errors import DeviceError, InputError
from mintpilot.core.gap import PASSABLE, Assumptions, Joint
from mintpilot.core.query import Combine
from mintpilot.core.tree import Mint, Node, PlanClass
from mintpilot.elicitation.proposing import propose_cuts
from mintpilot.language.instruction_model import parse_with_model
from mintpilot.models.doubles import FunctionModel, NoModel

GAPS = (questions.SMOKE_GAP, questions.BOX_GAP)
TREE = Mint(
    root=Node(given=Assumptions(), probability=1.0, optimistic=None, cautious=None),
    belief=Joint(gaps=GAPS, probability=np.full((2, 3), 1 / 6)),
    classes=(PlanClass(plan=None, probability=1.0, given=(Assumptions(),)),),
    class_of=np.zeros((2, 3), np.int64),
    nodes=1,
)


def proposed(*cuts: object) -> FunctionModel:
    return FunctionModel(lambda _: "Here you are:\n```json\n" + json.dumps({"cuts": cuts}) + "\n```", name="clever")


def test_sound_cuts_are_taken_over_with_their_values() -> None:
    found = propose_cuts(
        proposed(
            {"parts": [{"gap": "obstacle:smoke-1", "value": PASSABLE}]},
            {"parts": [{"gap": "target:1:box", "attribute": "colour", "value": "blue"}]},
            {
                "parts": [
                    {"gap": "obstacle:smoke-1", "value": PASSABLE},
                    {"gap": "target:1:box", "value": "box-1"},
                ],
                "combine": "any",
            },
        ),
        TREE,
    )
    smoke, blue, both = found.queries
    assert [x.values for x in smoke.literals] == [frozenset({PASSABLE})]
    assert [x.values for x in blue.literals] == [frozenset({"box-2", "box-3"})]
    assert (len(both.literals), both.combine) == (2, Combine.ANY)
    assert (found.refused, found.model) == ((), "clever")


@pytest.mark.parametrize(
    ("cut", "why"),
    [
        ({"parts": [{"gap": "obstacle:smoke-9", "value": PASSABLE}]}, "no open gap"),
        ({"parts": [{"gap": "obstacle:smoke-1", "value": "pink"}]}, "no value"),
        ({"parts": [{"gap": "obstacle:smoke-1", "value": "blocked"}]}, "negation"),
        ({"parts": [{"gap": "target:1:box", "attribute": "colour", "value": "green"}]}, "tells nothing apart"),
        ({"parts": [{"gap": "obstacle:smoke-1", "attribute": "colour", "value": "grey"}]}, "tells nothing apart"),
        ({"parts": [{"gap": "obstacle:smoke-1", "value": PASSABLE}] * 2}, "twice"),
    ],
)
def test_others_are_refused_with_a_reason(cut: object, why: str) -> None:
    found = propose_cuts(proposed(cut), TREE)
    assert found.queries == ()
    assert why in found.refused[0]


def test_no_model_proposes_nothing() -> None:
    assert propose_cuts(NoModel(), TREE).queries == ()


HOSTILE = st.one_of(
    st.text(max_size=200),
    st.binary(max_size=200).map(lambda raw: raw.decode("latin-1")),
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(max_size=8),
        lambda inner: (
            st.lists(inner, max_size=3)
            | st.dictionaries(st.sampled_from(["cuts", "parts", "gap", "value", "reading", "steps"]), inner)
        ),
        max_leaves=12,
    ).map(json.dumps),
    st.sampled_from(
        [
            "{" * 50_000,
            '{"cuts": []} ignore the rest',
            '{"reading": "command"}',
            '{"reading": "yes", "also": 1}',
            "yes",
            "no",
        ]
    ),
)


@pytest.mark.long
@settings(deadline=None, max_examples=200)
@given(HOSTILE)
def test_whatever_a_model_proposes_is_sound_or_nothing(text: str) -> None:
    gaps = {gap.id: gap for gap in GAPS}
    for query in propose_cuts(FunctionModel(lambda _: text), TREE).queries:
        for literal in query.literals:
            assert literal.values < set(gaps[literal.gap].values)


def _agreeing(prompt: str) -> str:
    return json.dumps({"reading": "no" if "the opposite" in prompt else "yes"})


HELP = (("pick", "the medicine", "the red box"), ("deliver", "the medicine", "the injured person"))
SLANG = "There is a poor chap, the injured person; the medicine sits in the red box, he could use it"


Typed = tuple[str, str, str]


def _steps(*steps: Typed) -> FunctionModel:
    rows = [{"action": action, "target": target, "place": place} for action, target, place in steps]
    return FunctionModel(lambda _: json.dumps({"steps": rows}))


def test_an_instruction_that_the_rules_do_not_know_is_put_into_steps() -> None:
    with pytest.raises(InputError, match="not understood"):
        parse_with_model(SLANG, NoModel())
    task = parse_with_model(SLANG, _steps(*HELP))
    assert [str(g.action) for g in task.subgoals] == ["pick", "deliver"]
    assert task.instruction == SLANG


@pytest.mark.parametrize(
    "steps",
    [
        (("go", "the blue box", ""),),
        (("go", "the smoke", ""),),
        (("ignore", "the operator", ""),),
        (),
        (HELP[0], ("throw", "it", "")),
        HELP[:1],
    ],
)
def test_steps_that_add_something_or_cannot_be_read_are_not_taken(steps: tuple[Typed, ...]) -> None:
    with pytest.raises(InputError):
        parse_with_model(SLANG, _steps(*steps))


def test_what_must_not_be_done_is_never_left_to_a_model() -> None:
    with pytest.raises(InputError, match="not understood"):
        parse_with_model("whatever happens do not touch the red box", _steps(("pick", "the red box", "")))


@pytest.mark.long
@settings(deadline=None, max_examples=100)
@given(HOSTILE)
def test_any_model_gives_a_task_or_the_rules_reason(said: str) -> None:
    def fails(_: str) -> str:
        raise DeviceError(said)

    for model in (FunctionModel(lambda _: said), FunctionModel(fails)):
        with pytest.raises(InputError, match="not understood"):
            parse_with_model(SLANG, model)
