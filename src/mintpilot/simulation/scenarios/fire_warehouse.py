"""The paper's simulated disaster: an on-fire warehouse, an injured person, a cloud of smoke and a closed room.

What the paper says (section "Simulation Experiments"): a region covered by volumetric smoke that may be toxic or may be
a shortcut, a closed room that may or may not hold a second victim, and a spatial configuration of both that varies
relative to the optimal path, so that they matter in some worlds and not in others. All defaults below follow from that
description; none was chosen for its effect on a result. Where the paper gives no figure, the choice is an even one
(each kind of place for the smoke a third, each place for the room alike, both priors one half).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import MissionError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.mission import Mission
from mintpilot.core.plan import VehicleLimits
from mintpilot.simulation.scenarios.floor import Floor, block, standing
from mintpilot.simulation.scenarios.furniture import add_clutter, add_racks
from mintpilot.simulation.scenarios.hall_plan import (
    ROOM_PLACES,
    VOLUME,
    WALL_M,
    HallPlan,
    Way,
    draw_plan,
    room_place,
)
from mintpilot.simulation.scenarios.hazards import SmokeChances, draw_fires, draw_smokes
from mintpilot.simulation.scenarios.scenario import Scenario, check_numbers, read_parameters
from mintpilot.simulation.scene import ClosedRoom, FlightRules, Person, Scene, Solid

NAME = "fire-warehouse"
INSTRUCTION = "Find the injured person in the burning warehouse and check whether anyone else is hurt."
START_HEIGHT_M = 1.2
STAY_S = 2.0
"""How long the drone stays with the person; counted in the shortest mission."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FireWarehouseParameters:
    """What a fire-warehouse is drawn from."""

    prior_toxic: float = 0.5
    """Probability that a cloud is toxic; its truth is drawn from it."""
    prior_occupied: float = 0.5
    """Probability that somebody is in a closed room; its truth is drawn from it."""
    smokes: int = 1
    """Number of clouds (the paper: one)."""
    rooms: int = 1
    """Number of closed rooms (the paper: one); at most four."""
    on_way: float = 1 / 3
    """Probability that a cloud fills a gate or hall of the shortest way."""
    other_way: float = 1 / 3
    """Probability that it fills a gate or hall of another way. What is left: somewhere off every way."""
    link: float = 0.5
    """Probability that the two halls are joined by a gate of their own: four ways instead of two."""
    endurance_least: float = 1.2
    """The battery lasts for at least this multiple of the shortest mission's time (smoke harmless, room empty)."""
    endurance_most: float = 2.2
    """… and for at most this one. Drawn evenly in between, independently of the truths."""
    thinking_s: float = 0.0
    """Seconds that the battery lasts longer than that: for a person to think in."""
    reserve: float = 0.25
    """Share of the battery that plans leave for braking, corners and gusts: costs are lengths at cruise speed."""
    cruise_mps: float = 1.5
    """Cruise speed."""
    gate_m: float = 2.0
    """Width of gates; they reach up to the roof."""

    def __post_init__(self) -> None:
        probabilities = ("prior_toxic", "prior_occupied", "on_way", "other_way", "link", "reserve")
        check_numbers(self, probabilities=probabilities, positive=("endurance_least", "cruise_mps"))
        if self.on_way + self.other_way > 1:
            raise MissionError(f"on_way {self.on_way} + other_way {self.other_way}: together at most 1")
        if not (self.smokes == int(self.smokes) and 0 <= self.smokes <= 6):
            raise MissionError(f"smokes = {self.smokes}: must be a whole number from 0 to 6")
        if not (self.rooms == int(self.rooms) and 0 <= self.rooms <= 4):
            raise MissionError(f"rooms = {self.rooms}: must be a whole number from 0 to 4")
        if not 0 <= self.thinking_s < math.inf:
            raise MissionError(f"thinking_s = {self.thinking_s}: must be finite and not below 0")
        if not self.endurance_least <= self.endurance_most:
            raise MissionError(
                f"endurance_least {self.endurance_least} is above endurance_most {self.endurance_most}: swap them"
            )
        if not 1.6 <= self.gate_m <= 2.4:
            raise MissionError(f"gate_m = {self.gate_m}: must be from 1.6 to 2.4 m, or gates clash with walls")
        if not self.reserve < 1:
            raise MissionError(f"reserve = {self.reserve}: must be below 1, or nothing is left to fly with")


def fire_warehouse(seed: int, **parameters: float) -> Scenario:
    """Draws one fire-warehouse; the same seed and parameters give the same world.

    Truths (toxic, occupied) and endurance come from random streams of their own: neither changes the floor plan.

    Args:
        seed: 0 or above.
        **parameters: fields of `FireWarehouseParameters`.

    Raises:
        UnknownNameError: a parameter is not known.
        MissionError: a parameter's value breaks a rule.
    """
    p = read_parameters(FireWarehouseParameters, parameters, NAME)
    layout, truth, battery, looks = (np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(4))
    plan = draw_plan(layout, gate_m=p.gate_m, link_probability=p.link)
    places = tuple(ROOM_PLACES[i] for i in layout.permutation(len(ROOM_PLACES))[: int(p.rooms)])
    rooms = tuple(_room(plan, place, i, p, truth) for i, place in enumerate(places))
    floor = Floor(taken=[*plan.partitions(), *(r.extent_m for r in rooms)])
    start = _free_place(floor, layout, (1.0, 2.0))
    floor.keep_clear([(r.viewpoint_m[0], r.viewpoint_m[1]) for r in rooms], 1.5)
    goal = _free_place(floor, layout, (17.0, 18.4))
    ways = plan.ways(start, goal)
    _keep_open(floor, plan, ways, start, goal)
    racks = add_racks(floor, plan, places, layout)
    chances = SmokeChances(count=int(p.smokes), on_way=p.on_way, other_way=p.other_way, toxic=p.prior_toxic)
    smokes, kinds = draw_smokes(floor, plan, ways, rooms, chances, layout, truth)
    fires = draw_fires(floor, smokes, layout)
    scene = Scene(
        name=NAME,
        volume=VOLUME,
        start_m=(*start, START_HEIGHT_M),
        solids=(*_walls(plan), *racks, *fires, *add_clutter(floor, plan, looks)),
        smokes=smokes,
        rooms=rooms,
        persons=(Person(id="injured", position_m=(*goal, 0.0), yaw_rad=float(looks.uniform(-math.pi, math.pi))),),
        seed=seed,
    )
    shortest_s = ways[0].length_m / p.cruise_mps + STAY_S
    planned_s = shortest_s * float(battery.uniform(p.endurance_least, p.endurance_most)) + p.thinking_s
    notes: dict[str, str | float] = {
        "smoke_places": ",".join(kinds),
        "room_places": ",".join(places),
        "shortest_way": ways[0].name,
        "shortest_s": shortest_s,
    }
    return Scenario(
        scene=scene,
        mission=_mission(scene, p, planned_s),
        rules=FlightRules(endurance_s=planned_s / (1 - p.reserve)),
        parameters=p,
        notes=notes,
    )


def _mission(scene: Scene, p: FireWarehouseParameters, planned_s: float) -> Mission:
    return Mission(
        name=NAME,
        instruction=INSTRUCTION,
        start_m=scene.start_m,
        volume=scene.volume,
        limits=VehicleLimits(cruise_mps=p.cruise_mps, endurance_s=planned_s),
        prior_passable=1 - p.prior_toxic,
        prior_occupied=p.prior_occupied,
    )


def _room(plan: HallPlan, place: str, index: int, p: FireWarehouseParameters, truth: np.random.Generator) -> ClosedRoom:
    walls, door, viewpoint = room_place(plan, place)
    occupied = bool(truth.random() < p.prior_occupied)
    inward = math.copysign(1.0, door.centre_m[1] - viewpoint[1])
    lying: Vec3 = (door.centre_m[0], door.centre_m[1] + inward * 1.9, 0.0)
    occupant = Person(id=f"trapped-{index + 1}", position_m=lying) if occupied else None
    return ClosedRoom(
        id=f"room-{index + 1}",
        extent_m=walls,
        door_m=door,
        viewpoint_m=viewpoint,
        occupant=occupant,
        prior_occupied=p.prior_occupied,
    )


def _free_place(floor: Floor, rng: np.random.Generator, x_m: tuple[float, float]) -> tuple[float, float]:
    """A place in the open between two x, anywhere from south to north, a body's length away from walls and doors."""

    def draw(rng: np.random.Generator) -> Box:
        return standing((float(rng.uniform(*x_m)), float(rng.uniform(1.5, 13.5))), (0.2, 0.2, 0.3), VOLUME)

    place = Floor(taken=[*floor.taken], clear=[*floor.clear]).place(rng, draw, spacing_m=1.3)
    if place is None:
        raise MissionError("no place is left for the drone or the injured person: ask for fewer rooms")
    return (place.centre_m[0], place.centre_m[1])


def _keep_open(
    floor: Floor, plan: HallPlan, ways: tuple[Way, ...], start: tuple[float, float], goal: tuple[float, float]
) -> None:
    """Nothing may stand on the ways outside the halls, in or before a gate, at the start or next to the person."""
    for way in ways:
        floor.keep_way_clear(way.points[:2], 0.9)
        floor.keep_way_clear(way.points[-2:], 0.9)
    half = plan.gate_m / 2
    for _, x, y in plan.gates:
        floor.clear.append((block((x - 1.2, x + 1.2), (y - half, y + half), (0.0, 0.0)), 0.1))
    if plan.link_x_m is not None:
        x, y = plan.link_x_m, plan.y_m + WALL_M / 2
        floor.clear.append((block((x - half, x + half), (y - 1.2, y + 1.2), (0.0, 0.0)), 0.1))
    floor.keep_clear([start], 1.2)
    floor.keep_clear([goal], 1.9)


def _walls(plan: HallPlan) -> tuple[Solid, ...]:
    return tuple(Solid(id=f"partition-{i + 1}", kind="partition", extent_m=b) for i, b in enumerate(plan.partitions()))
