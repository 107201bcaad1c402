"""The paper's real-world task: several boxes, one of which holds the medicine, and an injured person.

What the paper says (section "Real-World Deployment"): multiple boxes of varying sizes, shapes and colours, arranged
differently in each trial. How many is not said: from three to eight here, evenly.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import MissionError
from mintpilot.core.geometry import Box
from mintpilot.core.mission import Mission
from mintpilot.core.observation import Attribute
from mintpilot.core.plan import VehicleLimits
from mintpilot.simulation.materials import COLOURS
from mintpilot.simulation.scenarios.floor import Floor, standing
from mintpilot.simulation.scenarios.scenario import Scenario, check_numbers, read_parameters
from mintpilot.simulation.scene import FlightRules, Person, Scene, Shape, Solid

NAME = "medicine-boxes"
INSTRUCTION = "Pick up the medicine from the box and bring it to the injured person."
VOLUME = Box(lo_m=(0.0, 0.0, 0.0), hi_m=(12.0, 10.0, 4.0))
START_HEIGHT_M = 1.2
SPACING_M = 0.8
"""Boxes stand at least this far apart."""
EDGES_M = {"small": 0.3, "medium": 0.5, "large": 0.8}
"""Edge, or diameter and height, of each size."""
Look = tuple[str, str, Shape]
"""Colour word, size word and shape of one box."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MedicineBoxesParameters:
    """What a medicine-boxes world is drawn from."""

    fewest: int = 3
    """Smallest number of boxes, the right one included."""
    most: int = 8
    """Largest number."""
    cruise_mps: float = 1.5
    """Cruise speed."""

    def __post_init__(self) -> None:
        check_numbers(self, probabilities=(), positive=("cruise_mps",))
        whole = self.fewest == int(self.fewest) and self.most == int(self.most)
        if not whole or not 2 <= self.fewest <= self.most <= 12:
            raise MissionError(
                f"boxes from {self.fewest} to {self.most}: must be whole numbers, in order, from 2 to 12"
            )


def medicine_boxes(seed: int, **parameters: float) -> Scenario:
    """Draws one arrangement of boxes; the same seed and parameters give the same world.

    No two boxes agree in colour, size and shape together, and from three boxes on no one of these tells all apart.

    Args:
        seed: 0 or above.
        **parameters: fields of `MedicineBoxesParameters`.

    Raises:
        UnknownNameError: a parameter is not known.
        MissionError: a parameter's value breaks a rule.
    """
    p = read_parameters(MedicineBoxesParameters, parameters, NAME)
    layout, truth = (np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(2))
    start = (float(layout.uniform(0.9, 1.6)), float(layout.uniform(3.0, 7.0)))
    goal = (float(layout.uniform(10.2, 10.8)), float(layout.uniform(1.6, 8.4)))
    floor = Floor()
    floor.keep_clear([start], 1.5)
    floor.keep_clear([goal], 1.8)
    looks = _looks(int(layout.integers(int(p.fewest), int(p.most) + 1)), layout)
    right = int(truth.integers(len(looks)))
    boxes = tuple(_box(i, look, floor, layout, holds=i == right) for i, look in enumerate(looks))
    scene = Scene(
        name=NAME,
        volume=VOLUME,
        start_m=(*start, START_HEIGHT_M),
        solids=boxes,
        persons=(Person(id="injured", position_m=(*goal, 0.0), yaw_rad=float(layout.uniform(-math.pi, math.pi))),),
        goal_objects=(boxes[right].id,),
        seed=seed,
    )
    mission = Mission(
        name=NAME,
        instruction=INSTRUCTION,
        start_m=scene.start_m,
        volume=VOLUME,
        limits=VehicleLimits(cruise_mps=p.cruise_mps),
    )
    return Scenario(scene=scene, mission=mission, rules=FlightRules(), parameters=p, notes={"boxes": float(len(boxes))})


def _looks(count: int, rng: np.random.Generator) -> list[Look]:
    """Looks of all boxes, drawn until they are distinct, but not so by one attribute alone."""
    colours, sizes, shapes = sorted(COLOURS), sorted(EDGES_M), list(Shape)
    while True:
        looks = [
            (
                colours[int(rng.integers(len(colours)))],
                sizes[int(rng.integers(len(sizes)))],
                shapes[int(rng.integers(len(shapes)))],
            )
            for _ in range(count)
        ]
        if len(set(looks)) == count and (count < 3 or not _one_tells_all(looks)):
            return looks


def _one_tells_all(looks: Sequence[Look]) -> bool:
    return any(len(set(values)) == len(looks) for values in zip(*looks, strict=True))


def _box(index: int, look: Look, floor: Floor, rng: np.random.Generator, *, holds: bool) -> Solid:
    colour, size, shape = look
    edge = EDGES_M[size]

    def draw(rng: np.random.Generator) -> Box:
        centre = (float(rng.uniform(2.8, 9.4)), float(rng.uniform(1.2, 8.8)))
        return standing(centre, (edge, edge, edge), VOLUME)

    place = floor.place(rng, draw, spacing_m=SPACING_M)
    if place is None:
        raise MissionError(f"no place is left for box {index + 1}: ask for fewer boxes")
    return Solid(
        id=f"box-{index + 1}",
        kind="box",
        extent_m=place,
        shape=shape,
        colour=colour,
        attributes=(Attribute(name="contents", value="medicine"),) if holds else (),
    )
