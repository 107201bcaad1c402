"""Perception measured in furnished rooms."""

from __future__ import annotations

import json

import numpy as np
import pytest

from mintpilot.benchmark.perception import Tally, calibration_error, measure_perception, rows_of
from mintpilot.cli.main import main
from mintpilot.core.observation import Detection, Frame
from mintpilot.core.ports import Perception
from mintpilot.simulation.furnished.people import POSTURES, person
from mintpilot.simulation.furnished.room import furnished_room
from mintpilot.simulation.furnished.styles import HELD_BACK, STYLES, TUNED


class Blind(Perception):
    """Sees nothing."""

    def detect(self, frame: Frame, index: int) -> tuple[Detection, ...]:
        return ()


def test_the_calibration_error_is_the_distance_of_what_is_said_from_what_is_right() -> None:
    assert calibration_error([(0.75, True)] * 3 + [(0.75, False)]) == pytest.approx(0.0)
    assert calibration_error([(0.9, False)] * 4) == pytest.approx(0.9)
    assert calibration_error([(0.9, True), (0.15, True)]) == pytest.approx((0.1 + 0.85) / 2)
    assert calibration_error([]) == 0.0


@pytest.mark.long
@pytest.mark.parametrize("name", STYLES)
def test_rooms_are_drawn_again_alike_and_nothing_in_them_overlaps(name: str) -> None:
    rooms = [furnished_room(STYLES[name], 4) for _ in range(2)]
    assert rooms[0] == rooms[1]
    assert furnished_room(STYLES[name], 5) != rooms[0]
    standing = [one for one in rooms[0].shown if one.kind in ("person", "furniture") and one.on_m == 0]
    for i, a in enumerate(standing):
        for b in standing[:i]:
            apart = np.linalg.norm(np.subtract(a.box_m.centre_m[:2], b.box_m.centre_m[:2]))
            assert apart > 0.3
    kinds = {one.kind for seed in range(6) for one in furnished_room(STYLES[name], seed).shown}
    assert kinds == {"thing", "person", "door", "furniture"}


@pytest.mark.parametrize("posture", POSTURES)
def test_people_are_as_large_as_people(posture: str) -> None:
    rng = np.random.default_rng(1)
    for style in STYLES.values():
        box = person(posture, style, rng).box_m
        assert -0.2 < box.lo_m[2] < 0.06
        lo, hi = {
            "standing": (1.45, 2.1), "sitting": (0.7, 1.6), "crouching": (0.7, 1.25), "lying": (0.15, 0.6),
            "covered": (0.2, 0.75), "child": (0.8, 1.6),
        }[posture]  # fmt: skip
        assert lo < box.hi_m[2] < hi


def test_no_rule_was_chosen_on_a_held_back_style() -> None:
    assert not TUNED.keys() & HELD_BACK.keys()


@pytest.mark.long
@pytest.mark.sim
def test_who_sees_nothing_finds_nothing_and_makes_no_mistake() -> None:
    tally = measure_perception([STYLES["office"]], 1, 0, Blind())
    rows = {row.name: row for row in rows_of(tally)}
    assert rows["people found, questions counted"].value == 0
    assert rows["people found, questions counted"].n > 0
    assert all(row.value == 0 for name, row in rows.items() if name.startswith("false"))
    assert isinstance(tally, Tally)


@pytest.mark.sim
@pytest.mark.slow
def test_people_and_things_are_found_in_a_style_that_rules_were_chosen_on(capsys) -> None:  # type: ignore[no-untyped-def]
    assert main(["bench", "perception", "--style", "office", "--scenes", "3", "--json"]) == 0
    rows = {row["name"]: row for row in json.loads(capsys.readouterr().out)["rows"]}
    assert rows["people found, questions counted"]["value"] >= 0.8
    assert rows["things found within 0.3 m"]["value"] >= 0.8
    assert rows["false: person, in a room"]["value"] <= 0.34
    assert rows["false: fire, in a room"]["value"] == rows["false: smoke, in a room"]["value"] == 0


def test_an_unknown_style_is_named(capsys) -> None:  # type: ignore[no-untyped-def]
    assert main(["bench", "perception", "--style", "offce"]) != 0
    assert "office" in capsys.readouterr().err
