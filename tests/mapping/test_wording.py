from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.geometry import Box
from mintpilot.mapping.wording import describe_all, place_in

HALL = Box(lo_m=(0, 0, 0), hi_m=(20, 15, 4))
PLACES = st.tuples(st.floats(0, 20), st.floats(0, 15), st.floats(0, 4))


def test_places_are_named_by_thirds() -> None:
    assert place_in(HALL, (10, 7, 1)) == "in the middle of the hall"
    assert place_in(HALL, (19, 14, 1)) == "in the north-east corner"
    assert place_in(HALL, (1, 7, 1)) == "on the west side"
    assert place_in(HALL, (10, 1, 1)) == "on the south side"


def test_things_in_one_place_are_told_apart_along_the_axis_that_parts_them() -> None:
    texts = describe_all(HALL, ["the grey smoke"] * 3, [(15, 14, 1), (19, 14, 1), (10, 7, 1)])
    assert texts == [
        "the grey smoke in the north-east corner, the western one",
        "the grey smoke in the north-east corner, the eastern one",
        "the grey smoke in the middle of the hall",
    ]


@given(st.lists(PLACES, max_size=12))
@settings(deadline=None, max_examples=50)
def test_no_two_descriptions_are_equal(places: list[tuple[float, float, float]]) -> None:
    texts = describe_all(HALL, ["the grey smoke"] * len(places), places)
    assert len(set(texts)) == len(places)
