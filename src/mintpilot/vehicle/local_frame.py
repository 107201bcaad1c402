"""Between the map (x, y, z up) and the autopilot's local frame (north, east, down). Nothing else converts."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mintpilot.core.geometry import Vec3


@dataclass(frozen=True, slots=True, kw_only=True)
class LocalFrame:
    """Where the origin of the autopilot's local frame lies on the map, and how the map is turned."""

    origin_m: Vec3 = (0.0, 0.0, 0.0)
    """Place on the map of the autopilot's local origin, metres."""
    heading_rad: float = 0.0
    """Compass direction of the map's y axis, clockwise from north; 0: x is east and y is north."""

    def velocity_to_ned(self, velocity_mps: Vec3) -> Vec3:
        """A velocity, or any difference of places, as (north, east, down)."""
        x, y, z = velocity_mps
        cos, sin = math.cos(self.heading_rad), math.sin(self.heading_rad)
        return (y * cos - x * sin, x * cos + y * sin, -z)

    def velocity_from_ned(self, ned_mps: Vec3) -> Vec3:
        """The inverse of `velocity_to_ned`."""
        north, east, down = ned_mps
        cos, sin = math.cos(self.heading_rad), math.sin(self.heading_rad)
        return (east * cos - north * sin, north * cos + east * sin, -down)

    def to_ned(self, position_m: Vec3) -> Vec3:
        """A place on the map as (north, east, down) from the autopilot's origin, metres."""
        (x, y, z), (ox, oy, oz) = position_m, self.origin_m
        return self.velocity_to_ned((x - ox, y - oy, z - oz))

    def from_ned(self, ned_m: Vec3) -> Vec3:
        """The inverse of `to_ned`."""
        x, y, z = self.velocity_from_ned(ned_m)
        ox, oy, oz = self.origin_m
        return (x + ox, y + oy, z + oz)

    def yaw_to_ned(self, yaw_rad: float) -> float:
        """A heading on the map (0 along x, counter-clockwise) as a compass heading in (-pi, pi]."""
        return wrapped(math.pi / 2 + self.heading_rad - yaw_rad)

    def yaw_from_ned(self, heading_rad: float) -> float:
        """The inverse of `yaw_to_ned`, in (-pi, pi]."""
        return wrapped(math.pi / 2 + self.heading_rad - heading_rad)


def frame_at(position_m: Vec3, ned_m: Vec3, heading_rad: float) -> LocalFrame:
    """The frame in which the autopilot's place (north, east, down) is that place on the map."""
    x, y, z = LocalFrame(heading_rad=heading_rad).from_ned(ned_m)
    return LocalFrame(
        origin_m=(position_m[0] - x, position_m[1] - y, position_m[2] - z),
        heading_rad=heading_rad,
    )


def wrapped(angle_rad: float) -> float:
    """The same angle in (-pi, pi]."""
    turned = math.remainder(angle_rad, 2 * math.pi)
    return math.pi if turned == -math.pi else turned
