"""What holds along a flown way: against distances to squares, worked out at many points of it (method, section 14)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.rule import Rule
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.core.task import Task
from mintpilot.planning.rule_labels import RuleGrid
from mintpilot.planning.rule_letters import letters_along
from mintpilot.rules.compiling import compile_rules
from mintpilot.uncertainty import ruling_of

FRAME = GridFrame(origin_m=(0, 0, 0), resolution_m=0.5, shape=(1, 12, 12))
LIMITS = VehicleLimits(radius_m=0.2, margin_m=0.1)
SAID = {"in": "in(zone)", "inside": "inside(zone)", "touches": "touches(zone)", "within": "within(zone, 0.4)"}


def bound(about, cells):
    zone = Region(id="zone", kind=RegionKind.AREA, cells=np.array(sorted(cells), np.int64))
    map_ = SemanticMap(frame=FRAME, cells=np.full(FRAME.shape, Cell.FREE, np.uint8), regions=(zone,))
    rule = Rule(text="", formula=f"G {SAID[about]}")
    task = Task(instruction="", subgoals=(), rules=(rule,))
    return map_, ruling_of(map_, task, compile_rules((rule,)), ())


def away(point, cells):
    gaps = [np.hypot(*(max(i * 0.5 - p, p - i * 0.5 - 0.5, 0) for i, p in zip((c % 12, c // 12), point, strict=True)))
            for c in cells]  # fmt: skip
    return min(gaps, default=np.inf)


def truth(about, point, cells):
    rest = set(range(144)) - set(cells)
    match about:
        case "in":
            return away(point, cells) == 0
        case "inside":
            return away(point, rest) >= 0.2 and all(0.2 <= p <= 5.8 for p in point)
        case "touches":
            return away(point, cells) < 0.2
        case _:
            return away(point, cells) <= 0.6


points = st.tuples(st.floats(0.4, 5.6), st.floats(0.4, 5.6))
zones = st.tuples(st.integers(0, 10), st.integers(0, 10), st.integers(1, 5), st.integers(1, 5)).map(
    lambda z: [12 * y + x for y in range(z[1], min(12, z[1] + z[3])) for x in range(z[0], min(12, z[0] + z[2]))]
)


@pytest.mark.long
@settings(deadline=None)
@given(st.sampled_from(sorted(SAID)), zones, st.lists(points, min_size=1, max_size=4), st.sampled_from((0.0, 0.1)))
def test_what_is_said_of_a_way_is_true_of_all_its_points_and_of_those_beside_it(about, cells, way, spare):
    map_, ruling = bound(about, cells)
    way_m = np.array([(x, y, 0.25) for x, y in way])
    letters = letters_along(ruling, map_, LIMITS, way_m, spare_m=spare)
    sure, possible = any(yes for yes, _ in letters), any(may for _, may in letters)
    found = []
    for a, b in zip(way_m, [*way_m[1:], way_m[-1]], strict=True):
        for t in np.linspace(0, 1, 60):
            for angle in np.arange(0, 6.2, 0.7):
                x, y = (a + t * (b - a))[:2] + spare * np.array([np.cos(angle), np.sin(angle)])
                found.append(truth(about, (x, y), cells))
    assert possible or not any(found)
    assert not sure or any(found)
    if all(yes for yes, _ in letters):
        assert all(found)


@settings(deadline=None)
@given(st.sampled_from(sorted(SAID)), zones, st.lists(st.integers(0, 7), min_size=1, max_size=8), st.integers(0, 80))
def test_what_is_flown_along_cells_leaves_no_rule_where_the_plan_would_not(about, cells, moves, start):
    map_, ruling = bound(about, cells)
    grid = RuleGrid(ruling=ruling, map=map_, limits=LIMITS)
    y, x = divmod(start, 9)
    way = [(y + 1, x + 1)]
    for move in moves:
        dy, dx = [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)][move]
        y, x = way[-1]
        way.append((min(max(y + dy, 1), 10), min(max(x + dx, 1), 10)))
    flat = [12 * y + x for y, x in way]
    way_m = np.array([(0.5 * x + 0.25, 0.5 * y + 0.25, 0.25) for y, x in way])
    start_states = frozenset({0})
    planned = ruling.automaton.followed(start_states, [grid.labels[grid.kinds[c]] for c in flat], 0)
    flown = ruling.automaton.followed(start_states, letters_along(ruling, map_, LIMITS, way_m, spare_m=0.1), 0)
    assert flown <= planned


def test_a_way_that_grazes_a_region_between_its_points_is_noticed():
    map_, ruling = bound("touches", [12 * 6 + 6])  # 3 to 3.5 m
    beside = np.array([(0.5, 3.75, 0.25), (5.5, 3.75, 0.25)])
    assert letters_along(ruling, map_, LIMITS, beside, spare_m=0.0) == [(0, 0)]
    assert [may for _, may in letters_along(ruling, map_, LIMITS, beside, spare_m=0.1)] == [0, 1, 0]
    across = np.array([(0.5, 3.6, 0.25), (5.5, 3.6, 0.25)])
    assert (1, 1) in letters_along(ruling, map_, LIMITS, across, spare_m=0.0)


@pytest.mark.parametrize("about", sorted(SAID))
def test_no_region_is_nowhere(about):
    map_, ruling = bound(about, [])
    assert letters_along(ruling, map_, LIMITS, np.array([(1.0, 1.0, 0.25), (5.0, 5.0, 0.25)]), spare_m=0.1) == [(0, 0)]
