"""A scene: what is really there. The truth of a simulated world; planning never sees it.

Shapes and extents are exact for collision and for rasterising; the MuJoCo builder dresses them (shelves, textures,
flames, limbs) without leaving their extents, so that both simulators fly in the same world.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.observation import Attribute


class Shape(StrEnum):
    """Shape of a solid inside its extent."""

    BOX = "box"
    CYLINDER = "cylinder"
    """Upright, its diameter the smaller horizontal edge of the extent."""
    SPHERE = "sphere"
    """Its diameter the smallest edge of the extent."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """Something that the drone can bump into."""

    id: str
    """Unique in the scene, e.g. ``box-red``."""
    kind: str
    """``wall``, ``partition``, ``rack``, ``crate``, ``box``, ``fire``, ``rubble``, ``pillar`` …"""
    extent_m: Box
    shape: Shape = Shape.BOX
    colour: str = ""
    """Plain colour word; empty: the usual look of its kind."""
    attributes: tuple[Attribute, ...] = ()
    """True attributes besides colour, size and shape (for scoring), e.g. ``contents: medicine``."""
    appears_s: float = 0.0
    """When it comes into the world, seconds of mission flight (something falls over); 0: from the start."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Smoke:
    """A cloud."""

    id: str
    extent_m: Box
    toxic: bool
    """Truth: a hull that reaches into it ends the mission."""
    prior_safe: float | None = None
    """Probability from which the truth was drawn."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Person:
    """Somebody lying on the floor."""

    id: str
    position_m: Vec3
    """Middle of the body, on the floor (z = 0)."""
    yaw_rad: float = 0.0
    """Direction from hips to head, 0 along x."""
    must_be_found: bool = True
    """Whether the mission fails without reaching (or seeing) this person."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ClosedRoom:
    """A roofed room with a shut door; the door has a pane, through which a drone in front of it can look in."""

    id: str
    extent_m: Box
    """Outer walls, floor to roof."""
    door_m: Box
    """The door leaf, in one of the walls."""
    viewpoint_m: Vec3
    """About 1.2 m in front of the door, at eye height."""
    occupant: Person | None = None
    """Truth: who is inside."""
    prior_occupied: float = 0.5
    """Probability from which the truth was drawn."""
    wall_m: float = 0.12
    """Thickness of its walls, metres."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Landmark:
    """Something that a map made by others names: a place to get to. What can be touched there is a solid of its own."""

    id: str
    """Unique in the scene, e.g. ``box-red``."""
    kind: str
    """``box``, ``person`` …"""
    extent_m: Box
    must_be_found: bool = False
    """For a person: whether the mission fails without hovering near."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A world and the truth about it."""

    name: str
    volume: Box
    """Inner space of the building, floor at z = 0; the drone must not leave it."""
    start_m: Vec3
    """Hover point above the pad."""
    solids: tuple[Solid, ...] = ()
    smokes: tuple[Smoke, ...] = ()
    rooms: tuple[ClosedRoom, ...] = ()
    persons: tuple[Person, ...] = ()
    """In the open; those in rooms are the rooms' occupants."""
    landmarks: tuple[Landmark, ...] = ()
    """Only in scenes made of a given map, which tells where things are but not what they look like."""
    goal_objects: tuple[str, ...] = ()
    """Ids of solids or landmarks that the instruction really means, in order: picking another one fails the mission.
    An empty id stands for one that nobody declared: whatever is reached then counts."""
    seed: int = 0
    """For looks that are drawn at random (goods on shelves, flames)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FlightRules:
    """What ends a simulated flight, and its disturbances."""

    radius_m: float = 0.27
    """Radius of the drone's hull, an upright cylinder, metres: any contact is a collision."""
    half_height_m: float = 0.06
    """Half the height of that hull, metres (it stays upright: tilt is not counted)."""
    endurance_s: float = float("inf")
    """Flight time of the mission (the survey is flown on another battery), seconds."""
    person_reach_m: float = 2.0
    """A person counts as reached when the drone hovered within this distance, metres."""
    pick_reach_m: float = 2.0
    """An object counts as picked when the drone's PICK was within this distance and it was the nearest object."""
    look_reach_m: float = 1.0
    """A room counts as searched after a LOOK within this distance of its viewpoint."""
    position_noise_m: float = 0.01
    """Standard deviation of the measured position, each axis."""
    wind_n: float = 0.2
    """Standard deviation of gusts, newtons (MuJoCo only)."""
