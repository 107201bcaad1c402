"""Flights under rules in time, judged by LTLf's own definition on what was flown (method, section 14)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mintpilot.assembly.components import Choices, components_for
from mintpilot.assembly.flown_trace import FlownTrace
from mintpilot.assembly.rule_judge import RuleJudge
from mintpilot.assembly.worlds import build_world
from mintpilot.core.events import LegFlown, OrderTaken
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import Site, Stop, VehicleLimits
from mintpilot.core.query import Order
from mintpilot.core.rule import Rule
from mintpilot.core.semantic_map import Cell, Knowledge, Region, Room, SemanticMap
from mintpilot.core.task import Action, Task
from mintpilot.mission.loop import fly_mission
from mintpilot.mission.rule_progress import RuleProgress, done, flown
from mintpilot.mission.rule_progress import ruling as rules_now
from mintpilot.mission_file.reader import read_mission
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.ruled_path import ruled_path
from mintpilot.planning.terrain import start_cell
from mintpilot.rules import monitor
from mintpilot.uncertainty import ruling

ZONE_M = ((4.0, 0.0), (6.0, 5.0))
RADIUS_M = 0.2
FILE = """mintpilot: 1
name: ruled
instruction: two places
world:
  map: hall.map
  resolution_m: 0.5
  height_m: 1.0
  start_m: [1.25, 1.25]
  regions: [{{id: zone, description: the zone, passable: true, box: {{lo_m: [4, 0, 0], hi_m: [6, 5, 2]}}}}]
goals: [{{action: go, position_m: [9.25, 1.25], id: far}}, {{action: go, position_m: [1.25, 7.25], id: near}}]
vehicle: {{radius_m: 0.2, margin_m: 0.1, return: {returns}}}
rules: [{rule}]
"""


class Listener:
    """Keeps what was flown."""

    def __init__(self):
        self.flown = []

    def record(self, event):
        if isinstance(event, LegFlown):
            self.flown.append(event)


def fly(tmp_path, rule, *, returns="none"):
    path, heard = tmp_path / "m.yaml", Listener()
    (tmp_path / "hall.map").write_text("type octile\nheight 16\nwidth 24\nmap\n" + ("." * 24 + "\n") * 16)
    path.write_text(FILE.format(rule=rule, returns=returns))
    world = build_world(read_mission(path), base=tmp_path, seed=0)
    with components_for(world, Choices(vehicle="kinematic"), operators=(), recorder=heard) as made:
        verdict = fly_mission(made)
    return world, verdict, heard.flown


def judged(tmp_path, rule, flown, *, order=False):
    """What the product's judge says of a flight, whatever rule it was flown under."""
    path = tmp_path / "judged.yaml"
    path.write_text(FILE.format(rule=rule, returns="none"))
    world = build_world(read_mission(path), base=tmp_path, seed=0)
    judge = RuleJudge(Pleased(), Listener(), world)
    for event in flown:
        judge.record(event)
    if order:
        judge.record(OrderTaken(order=Order.HOLD, operator="a", text="hold", answer="It holds.", time_s=1.0))
    return judge.final()


class Pleased:
    """Finds nothing wrong."""

    def verdict(self):
        return None

    def people(self):
        return (0, 0)

    def final(self):
        return Verdict(outcome=Outcome.SUCCESS, reason="Every goal was reached.")


@pytest.mark.long
@pytest.mark.parametrize(
    ("rule", "kept"),
    [
        ("{never: touches(zone)}", False),
        ("{never: in(zone)}", False),
        ("{never: 'within(zone, 0.5)'}", False),
        ("{never: touches(zone), before: did(near)}", False),
        ("{first: did(far), then: did(near)}", True),
        ("{first: did(near), then: did(far)}", False),
        ("{end: in(zone)}", True),
        ("{never: at(near)}", False),
    ],
)
def test_the_judge_fails_a_flight_under_rules_that_it_breaks(tmp_path, rule, kept):
    _, verdict, flown = fly(tmp_path, "{after: at(near), eventually: in(zone)}")
    assert verdict.rules_broken == ()
    found = judged(tmp_path, rule, flown)
    assert found.outcome is (Outcome.SUCCESS if kept else Outcome.RULE_BROKEN)
    assert bool(found.rules_broken) is not kept
    ordered = judged(tmp_path, rule, flown, order=True)
    assert (ordered.outcome, ordered.rules_broken) == (Outcome.SUCCESS, None), "orders go before rules"


def is_kept(world, flown):
    """Whether the flown flight keeps every rule, by exact distances and the definition of LTLf."""
    where, done, at = [], [], []
    finished: set[str] = set()
    for leg in flown:
        way = leg.log.position_m
        names = {g.id for i, g in enumerate(world.task.subgoals, 1) if leg.stop_id.split(":")[1:2] == [str(i)]}
        for i, point in enumerate([*way, way[-1]]):
            there = i == len(way)
            where.append(point)
            finished = finished | names if there else finished
            done.append(set(finished))
            at.append(names if there else set())
    points = np.array(where)
    lo, hi = np.array(ZONE_M)
    beyond = np.maximum(np.maximum(lo - points[:, :2], points[:, :2] - hi), 0)
    away, depth = np.hypot(*beyond.T), np.minimum(points[:, :2] - lo, hi - points[:, :2]).min(axis=1)

    def of(about, subject, metres):
        match about:
            case "in":
                return depth >= 0
            case "inside":
                return depth >= RADIUS_M
            case "touches":
                return away < RADIUS_M
            case "within":
                return away <= metres + RADIUS_M
            case "did":
                return np.array([subject in x for x in done])
            case _:
                return np.array([subject in x for x in at])

    return all(monitor.is_kept(rule.formula, of, len(points)) for rule in world.task.rules)


@pytest.mark.long
@pytest.mark.parametrize(
    ("rule", "does"),
    [
        ("{never: touches(zone)}", ["far", "near"]),
        ("{never: 'within(zone, 0.5)'}", ["far", "near"]),
        ("{never: touches(zone), before: did(near)}", ["far", "near"]),
        ("{first: did(far), then: in(zone)}", ["far", "near"]),
        ("{after: at(near), eventually: in(zone)}", ["far", "near", "end"]),
        ("{end: in(zone)}", ["far", "near", "end"]),
        ("{never: at(far)}", ["near"]),
        ("'(!in(zone) U did(near)) & F did(near)'", ["far", "near"]),
    ],
)
@pytest.mark.parametrize("returns", ["none", "required"])
def test_no_flight_breaks_a_rule(tmp_path, rule, does, returns):
    world, verdict, flown = fly(tmp_path, rule, returns=returns)
    names = {f"go:{i}": goal.id for i, goal in enumerate(world.task.subgoals, 1)}
    if returns == "required" and "end: " in rule:
        assert verdict.outcome is Outcome.NO_SAFE_PLAN
        return
    assert is_kept(world, flown), rule
    came_to = [names.get(leg.stop_id, leg.stop_id) for leg in flown if leg.phase == "mission"]
    assert came_to == [x for x in does if returns == "none" or x != "end"]
    assert verdict.outcome is (Outcome.PARTIAL if does == ["near"] else Outcome.SUCCESS)


def test_the_judge_of_these_tests_finds_a_broken_rule(tmp_path):
    world, _, flown = fly(tmp_path, "{after: at(near), eventually: did(far)}")
    assert is_kept(world, flown)
    assert not is_kept(world, flown[1:])


def test_the_judge_sees_what_happens_between_two_poses(tmp_path):
    """Two poses on both sides of the zone, none in it."""
    _, _, flown = fly(tmp_path, "{never: at(far)}")
    log = replace(flown[0].log, position_m=np.array([[3.0, 2.0, 1.0], [7.0, 2.0, 1.0]]))
    assert judged(tmp_path, "{never: in(zone)}", [replace(flown[0], log=log)]).rules_broken


def test_a_region_between_two_poses_counts_for_how_far_the_rules_have_come(tmp_path):
    (tmp_path / "hall.map").write_text("type octile\nheight 16\nwidth 24\nmap\n" + ("." * 24 + "\n") * 16)
    (tmp_path / "m.yaml").write_text(FILE.format(rule="{after: in(zone), eventually: did(near)}", returns="none"))
    world = build_world(read_mission(tmp_path / "m.yaml"), base=tmp_path, seed=0)
    way = np.array([[3.0, 2.0, 1.0], [7.0, 2.0, 1.0]])
    beside, across = (
        flown(world.task, RuleProgress(), world.map, world.mission.limits, way + offset)
        for offset in (np.zeros(3), np.array([0.0, 4.0, 0.0]))
    )
    assert beside.states != across.states
    assert across.states == RuleProgress().states


@pytest.mark.parametrize(("smoke", "wall", "seen"), [(False, False, True), (True, False, False), (False, True, False)])
def test_a_room_is_looked_into_only_where_its_door_can_be_seen(smoke, wall, seen):
    frame = GridFrame(origin_m=(0, 0, 0), resolution_m=0.5, shape=(1, 4, 12))
    cells = np.full(frame.shape, Cell.FREE, np.uint8)
    cells[0, :, 10:] = Cell.OCCUPIED  # the door, and what is behind
    cells[0, :, 5] = Cell.OCCUPIED if wall else Cell.FREE
    cloud = Region(id="smoke-1", kind=RegionKind.SMOKE, cells=np.array([12 + 6]))
    door = Box(lo_m=(5.0, 0.0, 0.0), hi_m=(5.2, 2.0, 1.0))
    map_ = SemanticMap(frame=frame, cells=cells, regions=(cloud,) if smoke else (),
                       rooms=(Room(id="room", door_m=door, viewpoint_m=(1.25, 0.75, 0.25)),))  # fmt: skip
    rule = Rule(text="", formula="F looked(room)")
    task = Task(instruction="", subgoals=(), rules=(rule,))
    stop = Stop(id="look:room", action=Action.LOOK, sites=(Site(position_m=(1.25, 0.75, 0.25), label="room"),))
    at_m = np.array([1.25, 0.75, 0.25])
    progress = done(task, RuleProgress(), map_, VehicleLimits(), stop, at_m)
    assert (progress.held == 1) is seen
    trace = FlownTrace(map_, task, 0.3)
    trace.fly(np.stack([at_m - (0.5, 0, 0), at_m]))
    trace.do("look:room")
    assert bool(trace.of("looked", "room", 0.0)[-1]) is seen


@pytest.mark.parametrize("hidden", [False, True])
def test_no_plan_counts_on_a_look_from_where_the_door_is_hidden(tmp_path, hidden):
    """A wall between viewpoint and door: what must come after the look is not flown to."""
    rows = [list("." * 24) for _ in range(16)]
    for y in range(4, 12):
        rows[y][20] = "@"  # the room's front
        if hidden:
            rows[y][18] = "@"
    (tmp_path / "hall.map").write_text(
        "type octile\nheight 16\nwidth 24\nmap\n" + "".join("".join(row) + "\n" for row in rows)
    )
    room = (
        "  rooms: [{id: room-1, description: the closed room, door: {lo_m: [9.9, 3.5, 0], hi_m: [10.1, 4.5, 2]}, "
        "viewpoint_m: [7.75, 4.25], truth: present}]\n"
    )
    text = FILE.format(rule="{first: looked(room-1), then: at(near)}", returns="none")
    text = text.replace("goals:", room + "seeks_people: true\ngoals:")
    (tmp_path / "m.yaml").write_text(text)
    world, heard = build_world(read_mission(tmp_path / "m.yaml"), base=tmp_path, seed=0), Listener()
    with components_for(world, Choices(vehicle="kinematic"), operators=(), recorder=heard) as made:
        verdict = fly_mission(made)
    assert not verdict.rules_broken
    came_to = {leg.stop_id for leg in heard.flown if leg.phase == "mission"}
    near = next(f"go:{i}" for i, goal in enumerate(world.task.subgoals, 1) if goal.id == "near")
    assert (near in came_to) is not hidden
    assert (verdict.outcome is Outcome.NO_SAFE_PLAN) is hidden  # the rule demands the look
    assert {one.resource for one in verdict.left} == ({"rule"} if hidden else set())


def test_a_look_that_shows_nothing_is_planned_anew(tmp_path, monkeypatch):
    """The door is in sight from the very viewpoint alone, and the drone looks from beside it."""
    view_m = (7.9, 4.1)
    monkeypatch.setattr(ruling, "sees_into", lambda map, room, at_m: bool(np.allclose(at_m[:2], view_m)))
    (tmp_path / "hall.map").write_text("type octile\nheight 16\nwidth 24\nmap\n" + ("." * 24 + "\n") * 16)
    room = (
        "  rooms: [{id: room-1, description: the closed room, door: {lo_m: [9.9, 3.5, 0], hi_m: [10.1, 4.5, 2]}, "
        f"viewpoint_m: [{view_m[0]}, {view_m[1]}], truth: absent}}]\n"
    )
    text = FILE.format(rule="{never: at(near), before: looked(room-1)}", returns="none")
    (tmp_path / "m.yaml").write_text(text.replace("goals:", room + "seeks_people: true\ngoals:"))
    world, heard = build_world(read_mission(tmp_path / "m.yaml"), base=tmp_path, seed=0), Listener()
    with components_for(world, Choices(vehicle="kinematic"), operators=(), recorder=heard) as made:
        fly_mission(made)
    came_to = [leg.stop_id for leg in heard.flown if leg.phase == "mission"]
    assert "look:room-1" in came_to
    assert "go:2" not in came_to


def test_the_way_home_ends_where_the_plan_begins(tmp_path):
    """The middle of the start's cell is nearer to a wall than the body may be: both use the cell beside it."""
    frame = GridFrame(origin_m=(0, 0, 0), resolution_m=0.5, shape=(1, 12, 12))
    cells = np.full(frame.shape, Cell.FREE, np.uint8)
    cells[0, :, 3] = Cell.OCCUPIED
    zone = Region(id="zone", kind=RegionKind.AREA, cells=np.array([5 * 12 + 8]), passable=Knowledge.YES)
    map_ = SemanticMap(frame=frame, cells=cells, regions=(zone,))
    limits = VehicleLimits(radius_m=0.3, margin_m=0.0)
    home, here = (2.35, 1.25, 0.25), (4.75, 4.75, 0.25)
    task = Task(instruction="", subgoals=(), rules=(Rule(text="", formula="G !in(zone)"),))
    way = ruled_path(map_, limits, rules_now(task, RuleProgress(), map_), start_m=here, goal_m=home)
    assert way is not None
    begins = frame.centres_of(start_cell(map_, limits, known_flyable(map_, limits), home)[None])[0]
    assert not known_flyable(map_, limits)[tuple(frame.cells_of(np.array([home]))[0])]
    assert tuple(way[-1]) == tuple(begins)
