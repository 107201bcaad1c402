from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.core.geometry import Box
from mintpilot.core.observation import OBJECT, Attribute, NameGuess
from mintpilot.core.semantic_map import MapObject
from mintpilot.uncertainty.doubts import doubtful_people, referents, said_of


def thing(number: int, label: str = OBJECT, **names: float) -> MapObject:
    return MapObject(
        id=f"thing-{number}",
        label=label,
        box_m=Box(lo_m=(number, 0, 0), hi_m=(number + 0.3, 0.3, 0.3)),
        attributes=(Attribute(name="colour", value="grey"), Attribute(name="place", value="on the table")),
        names=tuple(NameGuess(label=n, probability=p) for n, p in names.items()),
    )


@given(st.lists(st.floats(0.0, 1.0), max_size=6), st.floats(0.0, 0.9))
def test_what_a_phrase_means_is_a_distribution(chances: list[float], unseen: float) -> None:
    found = referents("can", [thing(i, can=p) for i, p in enumerate(chances)], unseen=unseen)
    total = sum(p for _, p in found.things) + found.none_of_them + found.not_yet_seen
    assert total == pytest.approx(1.0)
    assert found.not_yet_seen == unseen
    assert list(found.things) == sorted(found.things, key=lambda pair: (-pair[1], pair[0]))


def test_the_surer_name_is_likelier_and_weak_names_leave_none_of_them() -> None:
    found = dict(referents("can", [thing(1, can=0.6), thing(2, can=0.3)]).things)
    assert found["thing-1"] > found["thing-2"]
    weak = referents("can", [thing(1, can=0.2)])
    assert weak.none_of_them > weak.things[0][1]
    alike = dict(referents("can", [thing(1, can=0.99), thing(2, can=0.95)], unseen=0.0).things)
    assert alike["thing-2"] > 0.45, "two things that are surely cans stay a question"
    assert referents("can", [thing(1, can=0.76)], unseen=0.1).none_of_them == pytest.approx(0.9 * 0.24)
    medicine = referents("box", [thing(1, label="medicine box"), thing(2, label="barrel")])
    assert [i for i, _ in medicine.things] == ["thing-1"]
    sure = referents("box", [thing(1, label="box")])
    assert sure.none_of_them < 0.01


def test_a_doubtful_person_is_a_gap_and_a_sure_one_or_none_is_not() -> None:
    (gap,) = doubtful_people([thing(1, person=0.4), thing(2, person=0.95), thing(3, person=0.1), thing(4)])
    assert gap.subject == "thing-1"
    assert gap.prior == (0.4, 0.6)
    assert gap.description == "the grey thing on the table"


def test_what_nobody_can_name_is_a_thing_and_no_box() -> None:
    assert said_of(thing(1)) == "the grey object on the table"
    assert "box" not in said_of(thing(1, box=0.3))
