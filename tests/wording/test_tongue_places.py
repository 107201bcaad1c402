"""Places of the map in other languages."""

from __future__ import annotations

import itertools

import pytest

from mintpilot.core.geometry import Box
from mintpilot.mapping.wording import describe_all
from mintpilot.wording.tongue_places import PLACES, split_places
from mintpilot.wording.tongues import TONGUES
from mintpilot.wording.translating import noun_phrase

HALL = Box(lo_m=(0.0, 0.0, 0.0), hi_m=(9.0, 9.0, 3.0))


def test_places_are_told_from_what_is_there() -> None:
    assert split_places("the grey smoke on the west side, the northern one") == (
        "the grey smoke",
        ["on the west side", "the northern one"],
    )
    assert split_places("the box next to the door") == ("the box next to the door", [])


@pytest.mark.parametrize("tongue", TONGUES.values(), ids=lambda tongue: tongue.name)
def test_every_place_that_the_map_words_is_said(tongue) -> None:  # type: ignore[no-untyped-def]
    spots = [(x, y, 1.0) for x, y in itertools.product((1.0, 4.5, 8.0), repeat=2)]
    alone = [describe_all(HALL, ["the grey smoke"], [spot])[0] for spot in spots]
    row = describe_all(HALL, ["the closed room"] * 2, [(1.0, 1.0, 1.0), (2.5, 1.0, 1.0)])
    column = describe_all(HALL, ["the closed room"] * 3, [(1.0, y, 1.0) for y in (0.5, 1.5, 2.5)])
    for english in (*alone, *row, column[0], column[-1]):
        said = noun_phrase(english, tongue)
        assert not any(mark in said for mark in "„«"), english
        assert not set(said.lower().split()) & {"the", "corner", "side", "one"}
    assert len({noun_phrase(english, tongue) for english in alone}) == 9
    assert PLACES.keys() == TONGUES.keys()


def test_an_order_of_many_stays_english() -> None:
    assert noun_phrase("the box on the west side, the second from the north", TONGUES["de"]).startswith("„")
