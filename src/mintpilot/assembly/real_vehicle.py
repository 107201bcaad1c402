"""A real vehicle for a mission: what its link must know of the map, and the process that deliberates beside it."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from mintpilot.assembly.registry import load
from mintpilot.assembly.worlds import World
from mintpilot.core.geometry import Box
from mintpilot.core.ports import Vehicle
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mission.navigation import landable_cells
from mintpilot.vehicle.envelope import SafetyEnvelope
from mintpilot.vehicle.mavlink_vehicle import MavlinkVehicle

ABOVE_LAYER_M = 0.5
"""A flat map says nothing of heights: the vehicle stays this near to its one layer, metres."""


class RealVehicle(Vehicle, Protocol):
    """A vehicle that is not simulated."""

    def close(self) -> None:
        """Ends on the ground, or in hands that are not ours."""
        ...


def make_vehicle(
    world: World, address: str, *, accept_failsafes: bool = False, known: SemanticMap | None = None
) -> RealVehicle:
    """The vehicle at ``NAME://PLACE``, prepared on the ground.

    ``NAME`` is that of a plug-in for the port ``vehicle``; it is called with the whole address and a `SafetyEnvelope`,
    and by name with ``endurance_s``, ``georeference`` and ``accept_failsafes``. See `MavlinkVehicle` for what may go
    wrong. ``known`` is all that is known before the flight, where a camera makes the map; None: the world's map.
    """
    vehicle: RealVehicle = load("vehicle", address.partition("://")[0])(
        address,
        envelope_of(world, known),
        endurance_s=world.rules.endurance_s,
        georeference=world.mission.georeference,
        accept_failsafes=accept_failsafes,
    )
    return vehicle


def checked_vehicle(world: World, address: str, *, accept_failsafes: bool) -> MavlinkVehicle:
    """As `make_vehicle`, for preflight: every check is made, and nothing refused."""
    return MavlinkVehicle(
        address,
        envelope_of(world),
        endurance_s=world.rules.endurance_s,
        georeference=world.mission.georeference,
        accept_failsafes=accept_failsafes,
        only_check=True,
    )


def envelope_of(world: World, known: SemanticMap | None = None) -> SafetyEnvelope:
    """What the link must know to end a flight by itself, of the map as it is before the flight.

    Only what is seen free down to the ground is landed on; a flat map shows no ground: what is free there may be. A
    straight return is never flown without a georeference, nor on a flat map, which does not say how high things are,
    nor where a camera makes the map: ``known`` is then all that is known.
    """
    mission, frame, map = world.mission, world.map.frame, known or world.map
    (x0, y0, z0), (x1, y1, z1) = mission.volume.lo_m, mission.volume.hi_m
    volume = mission.volume
    if frame.is_flat:
        volume = Box(lo_m=(x0, y0, min(z0, 0.0)), hi_m=(x1, y1, z1 + ABOVE_LAYER_M))
    return SafetyEnvelope(
        volume=volume,
        hover_m=mission.start_m,
        ground_m=0.0 if frame.is_flat else z0,
        frame=frame,
        landable=landable_cells(map, mission.limits),
        tallest_m=None if frame.is_flat or known is not None else tallest_m(map),
        outdoors=mission.georeference is not None,
    )


def tallest_m(map: SemanticMap) -> float:
    """Top of the highest cell that is occupied, metres; the map's floor where none is."""
    occupied = np.nonzero((map.cells == Cell.OCCUPIED).any(axis=(1, 2)))[0]
    levels = int(occupied[-1]) + 1 if len(occupied) else 0
    return float(map.frame.origin_m[2] + levels * map.frame.resolution_m)
