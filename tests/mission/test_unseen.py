"""What is sought and was not seen (method, section 9): zones of unseen space, looked at or asked about."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.core.gap import NOT_HERE, GapKind
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.ports import Ask, Fly
from mintpilot.core.query import Answer, Reply, answer_for
from mintpilot.core.semantic_map import Cell, MapObject, SemanticMap
from mintpilot.mission.rehearsal import begin
from mintpilot.mission.unseen import LOOKS_A_ZONE, MOST_ZONES, SEARCH, search_stop_id, unseen_zones
from mintpilot.mission_file.schema import MissionFile
from mintpilot.planning.flyable import flyable_cells

from .scenes import hall

LIMITS = VehicleLimits()
START_M = (1.5, 2.0, 1.2)


def searching(*, unseen_from_m: float, detour: bool) -> tuple[object, object]:
    """Deliberation in the hall with nobody on the map, all space east of there unseen."""
    file = hall(toxic=False, detour=detour).model_copy(update={"instruction": "Find everybody who needs help."})
    world = build_world(file, base=Path(), seed=0)
    cells = world.map.cells.copy()
    east = (world.map.frame.origin_m[0] + np.arange(cells.shape[2]) * world.map.frame.resolution_m) >= unseen_from_m
    cells[..., east] = Cell.UNKNOWN
    return deliberation_parts(world, Choices()), replace(world.map, cells=cells, objects=())


def test_where_all_is_seen_and_nobody_is_there_nothing_is_searched():
    parts, seen = searching(unseen_from_m=99.0, detour=True)
    found = begin(parts, seen).deliberated()
    assert not found.findings.stops
    assert SEARCH not in {gap.id for gap in found.findings.gaps}


def test_the_smoke_is_asked_about_when_only_smoke_hides_where_to_look():
    parts, seen = searching(unseen_from_m=7.0, detour=False)
    here = begin(parts, seen)
    asked = []
    for _ in range(6):
        found = here.deliberated()
        if isinstance(found.decision, Fly):
            break
        query = found.decision.scored.query
        asked += query.gap_ids
        reply = answer_for(query, 0) if "obstacle:cloud" in query.gap_ids else Answer(reply=Reply.UNSURE, latency_s=0.0)
        here = here.asked(found).answered(reply)
    assert "obstacle:cloud" in asked
    assert isinstance(found.decision, Fly)
    assert found.decision.plan is not None
    assert found.decision.plan.legs[0].stop.gap == SEARCH


def test_nobody_is_asked_about_smoke_that_hides_nothing():
    parts, seen = searching(unseen_from_m=99.0, detour=False)
    assert isinstance(begin(parts, seen).deliberated().decision, Fly)


def test_a_search_is_one_target_gap_of_zones_and_not_here():
    parts, seen = searching(unseen_from_m=7.0, detour=True)
    found = begin(parts, seen).deliberated()
    gap = next(gap for gap in found.findings.gaps if gap.id == SEARCH)
    assert gap.kind is GapKind.TARGET
    assert gap.values[-1] == NOT_HERE
    assert math.isclose(sum(gap.prior), 1.0)
    assert {stop.sites[0].value for stop in found.findings.stops} == set(gap.values) - {NOT_HERE}
    assert isinstance(found.decision, Ask | Fly)


def test_somebody_in_sight_ends_the_search():
    parts, seen = searching(unseen_from_m=7.0, detour=True)
    person = MapObject(id="person-1", label="person", box_m=Box(lo_m=(2.5, 4.0, 0.0), hi_m=(4.2, 4.6, 0.3)))
    found = begin(parts, replace(seen, objects=(person,))).deliberated()
    assert SEARCH not in {gap.id for gap in found.findings.gaps}


def test_a_zone_that_was_looked_around_in_often_enough_is_left_out():
    _, seen = searching(unseen_from_m=7.0, detour=True)
    zones = unseen_zones(seen, LIMITS, START_M)
    done = [search_stop_id(zones[0].id, n + 1) for n in range(LOOKS_A_ZONE)]
    assert zones[0].id not in {zone.id for zone in unseen_zones(seen, LIMITS, START_M, done)}
    assert zones[0].id in {zone.id for zone in unseen_zones(seen, LIMITS, START_M, done[:-1])}


@pytest.mark.long
@settings(deadline=None, max_examples=40)
@given(st.lists(st.integers(0, 23), max_size=16), st.integers(0, 2**31))
def test_zones_are_few_apart_and_looked_at_from_where_the_drone_can_be(columns: list[int], seed: int):
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.5, shape=(6, 16, 24))
    rng = np.random.default_rng(seed)
    cells = np.where(rng.random(frame.shape) < 0.05, Cell.OCCUPIED, Cell.FREE).astype(np.uint8)
    cells[..., columns] = Cell.UNKNOWN
    zones = unseen_zones(SemanticMap(frame=frame, cells=cells), LIMITS, START_M)
    flyable = flyable_cells(SemanticMap(frame=frame, cells=cells), LIMITS)
    assert len(zones) <= MOST_ZONES
    assert len({zone.id for zone in zones}) == len(zones)
    for zone in zones:
        assert flyable[tuple(frame.cells_of(zone.viewpoint_m)[0])]
        assert zone.unseen_m3 > 0
    assert columns or not zones


SCENES = {
    "behind the only smoke": {
        "solids": [("w1", (7.0, 0.0, 7.2, 3.0)), ("w2", (7.0, 5.0, 7.2, 8.0))],
        "smoke": (6.2, 2.8, 8.0, 5.2),
        "person": (12.0, 6.5),
        "longest_s": 240.0,
    },
    "out of sight, the survey cut short": {"solids": [], "smoke": None, "person": (9.0, 5.0), "longest_s": 1.0},
}


@pytest.mark.slow
@pytest.mark.sim
@pytest.mark.parametrize("name", SCENES)
def test_with_a_camera_somebody_unseen_is_found(name: str):
    scene = SCENES[name]
    smoke = scene["smoke"]
    file = MissionFile.model_validate(
        {
            "mintpilot": 1,
            "name": "unseen",
            "instruction": "Find everybody who needs help.",
            "survey": {"longest_s": scene["longest_s"]},
            "world": {
                "scene": {
                    "volume": {"lo_m": [0, 0, 0], "hi_m": [14, 8, 2.6]},
                    "start_m": [2, 4, 1.2],
                    "solids": [
                        {"id": i, "kind": "wall", "extent_m": {"lo_m": [a, b, 0], "hi_m": [c, d, 2.6]}}
                        for i, (a, b, c, d) in scene["solids"]
                    ],
                    "smokes": []
                    if smoke is None
                    else [
                        {
                            "id": "s1",
                            "extent_m": {"lo_m": [*smoke[:2], 0], "hi_m": [*smoke[2:], 2.6]},
                            "toxic": False,
                        }
                    ],
                    "persons": [{"id": "p1", "position_m": [*scene["person"], 0]}],
                }
            },
        }
    )
    record = run_mission(file, vehicle="mujoco")
    assert record.outcome.value == "success", record.reason
