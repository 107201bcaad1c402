"""Parts of one body together make a question about a person, never a person."""

from __future__ import annotations

import pytest

from mintpilot.core.geometry import Box
from mintpilot.core.observation import NameGuess
from mintpilot.core.semantic_map import MapObject
from mintpilot.mapping.body_parts import MOST_CHANCE, with_parts_counted


def part(id: str, x: float, person: float, *, label: str = "object", size: float = 0.3, bowl: float = 0.0) -> MapObject:
    names = [NameGuess(label="person", probability=person)] if person else []
    names += [NameGuess(label="bowl", probability=bowl)] if bowl else []
    box = Box(lo_m=(x, 0.0, 0.0), hi_m=(x + size, size, size))
    return MapObject(id=id, label=label, box_m=box, score=0.9, names=tuple(names))


def persons(objects) -> dict[str, float]:
    return {o.id: {g.label: g.probability for g in o.names}.get("person", 0.0) for o in objects}


def test_the_largest_of_touching_parts_is_asked_about():
    made = persons(with_parts_counted([part("a", 0.0, 0.1, size=0.5), part("b", 0.55, 0.15), part("c", 0.9, 0.1)]))
    assert made["a"] == pytest.approx(1 - 0.9 * 0.85 * 0.9)
    assert (made["b"], made["c"]) == (0.15, 0.1)


def test_together_they_are_never_surely_a_person():
    made = persons(with_parts_counted([part(n, 0.3 * i, 0.45) for i, n in enumerate("abcdef")]))
    assert max(made.values()) == MOST_CHANCE


@pytest.mark.parametrize(
    "others",
    [
        [part("b", 0.8, 0.2)],  # too far away
        [part("b", 0.35, 0.0)],  # nothing of a person
        [part("b", 0.35, 0.2, label="box")],  # known to be something else
    ],
)
def test_what_is_no_part_counts_for_nothing(others):
    objects = (part("a", 0.0, 0.1), *others)
    assert with_parts_counted(objects) == objects


def test_a_chain_longer_than_a_body_is_not_one():
    made = persons(with_parts_counted([part(f"o{i}", 0.35 * i, 0.1) for i in range(12)]))
    assert max(made.values()) == pytest.approx(1 - 0.9**6, abs=0.06)


def test_what_else_a_part_may_be_shares_the_rest():
    (first, _) = with_parts_counted([part("a", 0.0, 0.2, bowl=0.4, size=0.4), part("b", 0.45, 0.2)])
    assert {g.label: g.probability for g in first.names} == pytest.approx({"person": 0.36, "bowl": 0.4 * 0.64 / 0.8})
