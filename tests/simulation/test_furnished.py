"""Rooms of the styles that were written without knowledge of the rules of perception."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mintpilot.simulation.furnished import doors, fittings, furniture, people, room, things
from mintpilot.simulation.furnished.library_style import LIBRARY
from mintpilot.simulation.furnished.people import MORE_POSTURES, person
from mintpilot.simulation.furnished.room import HEIGHT_M, furnished_room, world_of
from mintpilot.simulation.furnished.style import Style
from mintpilot.simulation.furnished.styles import FRESH, HELD_BACK, STYLES, TUNED

SEEDS = range(10)


@pytest.mark.long
@pytest.mark.parametrize("style", (FRESH | {"library": LIBRARY}).values(), ids=[*FRESH, "library"])
def test_rooms_can_be_drawn_and_all_in_them_is_within_their_walls(style: Style) -> None:
    mujoco: Any = pytest.importorskip("mujoco")
    for seed in SEEDS:
        drawn = furnished_room(style, seed)
        model = world_of(drawn, mujoco).compile()
        assert sum(model.geom(i).name.startswith("shown:") for i in range(model.ngeom)) == sum(
            len(one.parts) for one in drawn.shown
        )
        for one in drawn.shown:
            lo, hi = one.box_m.lo_m, one.box_m.hi_m
            out = 0.2 if one.kind == "door" else 0.05
            assert lo[0] > -out, one.name
            assert lo[1] > -out, one.name
            assert hi[0] < drawn.size_m[0] + out, one.name
            assert hi[1] < drawn.size_m[1] + out, one.name
            assert -0.2 < lo[2] <= hi[2] < HEIGHT_M, one.name


def test_all_that_a_style_names_can_be_made() -> None:
    for style in STYLES.values():
        assert set(style.clutter) <= things.MAKERS.keys()
        assert set(style.clutter) & things.SMALL
        assert {*style.furniture, *style.lying_on} <= furniture.MAKERS.keys()
        assert set(style.fittings) <= fittings.MAKERS.keys()
        assert set(style.door_forms) <= doors.FORMS.keys()
        assert set(style.postures) <= {*people.POSTURES, *people.MORE_POSTURES}
        assert set(style.wear) <= {"", *people.WEAR}
        assert {style.floor_pattern, style.wall_pattern} <= room.PATTERNS.keys()


def test_a_fresh_style_is_still_held_back() -> None:
    assert FRESH.keys() & HELD_BACK.keys()
    assert FRESH.keys() <= HELD_BACK.keys() | TUNED.keys()


@pytest.mark.parametrize("posture", MORE_POSTURES)
def test_people_in_more_postures_are_as_large_as_people(posture: str) -> None:
    lo, hi = {
        "reaching": (1.55, 2.5), "carrying": (1.4, 2.2), "bending": (0.9, 1.6), "kneeling": (0.95, 1.6),
        "slumped": (0.6, 1.1), "sprawled": (0.15, 0.5), "curled": (0.25, 0.7), "tucked in": (0.2, 0.6),
        "child crawling": (0.35, 0.8), "child cross-legged": (0.4, 0.9),
    }[posture]  # fmt: skip
    rng = np.random.default_rng(1)
    for style in FRESH.values():
        box = person(posture, style, rng).box_m
        assert -0.2 < box.lo_m[2] < 0.06
        assert lo < box.hi_m[2] < hi


@pytest.mark.parametrize("kind", things.MAKERS)
def test_things_are_no_larger_than_asked_for_and_stand_on_the_floor(kind: str) -> None:
    for seed in SEEDS:
        made = things.thing(kind, np.random.default_rng(seed), largest_m=0.6)
        box = made.box_m
        assert max(np.subtract(box.hi_m, box.lo_m)) < 0.75
        assert box.lo_m[2] == pytest.approx(0.0, abs=0.04)
        assert made.name in made.labels
