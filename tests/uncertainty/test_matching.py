"""Which things a phrase may mean, and the words that tell them apart."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mintpilot.core.observation import Attribute
from mintpilot.core.semantic_map import MapObject
from mintpilot.core.task import Action, Reference, SubGoal, Task
from mintpilot.uncertainty import find_gaps
from mintpilot.uncertainty.describing import describe_apart
from mintpilot.uncertainty.matching import Standpoint, match
from mintpilot.uncertainty.things import things_of

from .worlds import START_M, thing, world

GUESS_WHO = Path(__file__).resolve().parents[3] / "shared" / "data" / "twentyq" / "guess_who.json"
VIEW = Standpoint(start_m=START_M, towards_m=(10.0, 7.5, 2.0))
OBJECTS = (
    thing("box-1", "box", (5, 3, 0.2), edge_m=0.3, colour="red"),
    thing("box-2", "box", (9, 9, 0.2), edge_m=0.9, colour="blue"),
    thing("box-3", "box", (14, 11, 0.2), edge_m=0.5, colour="grey"),
    thing("rack-1", "rack", (14, 9.5, 1.0), edge_m=1.0, colour="red"),
    thing("ext-1", "fire extinguisher", (19, 1, 0.5)),
    thing("drum-1", "barrel", (3, 12, 0.5), colour="blue", pattern=["striped", "dotted"]),
)


def found(phrase: str, label: str, **attributes: str) -> list[str]:
    pairs = tuple(Attribute(name=key, value=value) for key, value in attributes.items())
    things = things_of(world(OBJECTS))
    return [t.id for t in match(Reference(phrase=phrase, label=label, attributes=pairs), things, VIEW)]


@pytest.mark.parametrize(
    ("label", "attributes", "expected"),
    [
        ("box", {}, ["box-1", "box-2", "box-3"]),
        ("parcel", {}, ["box-1", "box-2", "box-3"]),
        ("drum", {}, ["drum-1"]),
        ("shelf", {}, ["rack-1"]),
        ("box", {"colour": "red"}, ["box-1"]),
        ("box", {"color": "Gray"}, ["box-3"]),
        ("box", {"colour": "green"}, []),
        ("", {"colour": "red"}, ["box-1", "rack-1"]),
        ("box", {"extreme": "largest"}, ["box-2"]),
        ("box", {"extreme": "nearest"}, ["box-1"]),
        ("box", {"extreme": "farthest"}, ["box-3"]),
        ("box", {"extreme": "rightmost"}, ["box-1"]),
        ("box", {"side": "left"}, ["box-2", "box-3"]),
        ("box", {"side": "right"}, ["box-1"]),
        ("box", {"near": "the red rack"}, ["box-3"]),
        ("box", {"near": "the ladder"}, ["box-1", "box-2", "box-3"]),
        ("barrel", {"pattern": "dotted"}, ["drum-1"]),
        ("box", {"contents": "medicine"}, ["box-1", "box-2", "box-3"]),
        ("", {"": "striped"}, ["drum-1"]),
        ("helicopter", {}, []),
        ("extinguisher", {"": "fire"}, ["ext-1"]),
    ],
)
def test_phrases_mean_what_fits(label: str, attributes: dict[str, str], expected: list[str]) -> None:
    assert found("the thing", label, **attributes) == expected


def test_the_label_itself_counts_before_its_synonyms() -> None:
    things = things_of(world([thing("crate-1", "crate", (1, 1, 0)), thing("box-1", "box", (2, 2, 0))]))
    assert [t.id for t in match(Reference(phrase="the crate", label="crate"), things, VIEW)] == ["crate-1"]


def test_extremes_that_are_as_good_as_equal_are_not_chosen_among() -> None:
    things = things_of(world([thing("a", "box", (1, 1, 0), 0.5), thing("b", "box", (2, 2, 0), 0.501)]))
    largest = Reference(phrase="", label="box", attributes=(Attribute(name="extreme", value="largest"),))
    assert len(match(largest, things, VIEW)) == 2


@pytest.mark.parametrize(
    ("objects", "expected"),
    [
        (
            [thing("a", "box", (1, 7, 0), colour="red"), thing("b", "box", (4, 7, 0), colour="red")],
            ["the nearest red box", "the second nearest red box"],
        ),
        (
            [
                thing("a", "box", (1, 1, 0), colour="red"),
                thing("b", "box", (9, 9, 0), colour="red"),
                thing("z", "rack", (9, 10, 1), colour="blue"),
            ],
            ["the nearest red box", "the red box next to the blue rack"],
        ),
        (
            [
                thing("a", "person", (1, 1, 0), hair_color="brown", accessories=["glasses", "hat"]),
                thing("b", "person", (2, 2, 0), hair_color="brown", accessories=["glasses"]),
                thing("c", "person", (3, 3, 0), hair_color="white"),
            ],
            [
                "the person with glasses and hat and brown hair",
                "the nearest person with glasses and brown hair",
                "the person with white hair",
            ],
        ),
    ],
)
def test_words_tell_apart(objects: list[MapObject], expected: list[str]) -> None:
    things = things_of(world(objects))
    words = describe_apart([t for t in things if t.id != "z"], things, START_M)
    assert sorted(set(words)) == sorted(t.id for t in things if t.id != "z")
    assert len(set(words.values())) == len(words)
    assert list(words.values()) == expected


@pytest.mark.skipif(not GUESS_WHO.exists(), reason=f"{GUESS_WHO} is not there")
def test_two_dozen_people_of_any_attributes_are_one_gap_told_apart() -> None:
    people = []
    for i, row in enumerate(json.loads(GUESS_WHO.read_text())):
        looks = {key: value for key, value in row.items() if key != "name"}
        people.append(thing(row["name"].lower(), "person", (1.0 + i % 6, 1.0 + i // 6, 0.2), **looks))
    task = Task(
        instruction="", subgoals=(SubGoal(action=Action.GO, reference=Reference(phrase="the person", label="person")),)
    )
    (gap,) = find_gaps(world(people), task, start_m=START_M).gaps
    assert len(gap.candidates) == len(people) == len({c.description for c in gap.candidates})
    assert sum(gap.prior) == pytest.approx(1)
    bald = Reference(phrase="", label="person", attributes=(Attribute(name="hair_style", value="bald"),))
    assert {t.id for t in match(bald, things_of(world(people)), VIEW)} == {
        row["name"].lower() for row in json.loads(GUESS_WHO.read_text()) if row["hair_style"] == "bald"
    }
