"""An explicit scene in a mission file. Its fields are those of the simulation's scene."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from mintpilot.mission_file.schema_base import (
    Attributes,
    BoxSpec,
    Name,
    NotNegative,
    Point3,
    Positive,
    Probability,
    Several,
    Spec,
)


class SolidSpec(Spec):
    """Something that the drone can bump into."""

    id: Name
    """Unique in the scene, e.g. `box-red`."""
    kind: Name
    """`wall`, `partition`, `rack`, `crate`, `box`, `fire`, `rubble`, `pillar` …"""
    extent_m: BoxSpec
    """Where it is."""
    shape: Literal["box", "cylinder", "sphere"] = "box"
    """Its shape inside the extent."""
    colour: str = ""
    """Plain colour word; empty: the usual look of its kind."""
    attributes: Attributes = Field(default_factory=dict)
    """True attributes that are not seen, such as `{contents: medicine}`."""
    appears_s: NotNegative = 0.0
    """When it comes into the world, seconds of mission flight; 0: from the start."""


class SmokeSpec(Spec):
    """A cloud of smoke."""

    id: Name
    """Unique in the scene."""
    extent_m: BoxSpec
    """Where it is."""
    toxic: bool
    """The truth: flying through it ends the mission."""
    prior_safe: Probability | None = None
    """Probability that it is safe, before any answer."""


class PersonSpec(Spec):
    """Somebody lying on the floor."""

    id: Name
    """Unique in the scene."""
    position_m: Point3
    """Middle of the body, on the floor (z = 0)."""
    yaw_rad: float = 0.0
    """Direction from hips to head, 0 along x, counter-clockwise."""
    must_be_found: bool = True
    """Whether the mission fails without reaching this person."""


class ClosedRoomSpec(Spec):
    """A roofed room with a shut door."""

    id: Name
    """Unique in the scene."""
    extent_m: BoxSpec
    """Outer walls, floor to roof."""
    door_m: BoxSpec
    """The door leaf, in one of the walls."""
    viewpoint_m: Point3
    """About 1.2 m in front of the door, at eye height."""
    occupant: PersonSpec | None = None
    """The truth: who is inside."""
    prior_occupied: Probability = 0.5
    """Probability that somebody is inside, before any answer."""
    wall_m: Positive = 0.12
    """Thickness of its walls, metres."""


class SceneSpec(Spec):
    """A world and the truth about it."""

    volume: BoxSpec
    """Inner space of the building, floor at z = 0; the drone must not leave it."""
    start_m: Point3
    """Hover point above the pad."""
    solids: Several[SolidSpec] = ()
    """What the drone can bump into."""
    smokes: Several[SmokeSpec] = ()
    """Clouds."""
    rooms: Several[ClosedRoomSpec] = ()
    """Closed rooms."""
    persons: Several[PersonSpec] = ()
    """People in the open; those in rooms are the rooms' occupants."""
    goal_objects: Several[Name] = ()
    """Ids of solids that the instruction really means, in order: picking another one fails the mission."""
    seed: Annotated[int, Field(ge=0)] = 0
    """For looks that are drawn at random (goods on shelves, flames)."""
