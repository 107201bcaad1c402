"""Where a local map lies on the earth (WGS 84)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Vec3

FARTHEST_M = 50_000.0
"""Places this far from the origin are refused: a flat map does not hold there, and most likely the place is wrong."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GeodeticPoint:
    """A place on the earth, WGS 84."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float
    """Above mean sea level, as the georeference has it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Georeference:
    """The geodetic place and heading of a map's origin.

    The map's frame is a plane tangent to the earth there. With heading 0 its x axis points east and its y axis north.

    Raises:
        MapError: a number is not finite or out of range.
    """

    latitude_deg: float
    longitude_deg: float
    altitude_m: float = 0.0
    """Of z = 0, above mean sea level."""
    heading_rad: float = 0.0
    """Compass direction of the map's y axis: clockwise from true north, seen from above."""

    def __post_init__(self) -> None:
        numbers = (self.latitude_deg, self.longitude_deg, self.altitude_m, self.heading_rad)
        if not all(math.isfinite(value) for value in numbers):
            raise MapError(f"georeference {numbers}: every number must be finite")
        if not (-90 <= self.latitude_deg <= 90 and -180 <= self.longitude_deg <= 180):
            raise MapError(
                f"georeference: latitude {self.latitude_deg} must be from -90 to 90 and longitude "
                f"{self.longitude_deg} from -180 to 180 degrees"
            )

    def geodetic(self, position_m: Vec3) -> GeodeticPoint:
        """The place on the earth of a position on the map (x, y, z), metres."""
        from pymap3d import enu2geodetic

        east, north = self._turned(position_m[0], position_m[1], self.heading_rad)
        latitude, longitude, altitude = enu2geodetic(
            east, north, position_m[2], self.latitude_deg, self.longitude_deg, self.altitude_m
        )
        return GeodeticPoint(latitude_deg=float(latitude), longitude_deg=float(longitude), altitude_m=float(altitude))

    def local(self, point: GeodeticPoint) -> Vec3:
        """The position on the map of a place on the earth, metres.

        Raises:
            MapError: it is further than `FARTHEST_M` from the origin.
        """
        from pymap3d import geodetic2enu

        east, north, up = geodetic2enu(
            point.latitude_deg,
            point.longitude_deg,
            point.altitude_m,
            self.latitude_deg,
            self.longitude_deg,
            self.altitude_m,
        )
        away_m = math.hypot(east, north)
        if not away_m <= FARTHEST_M:
            raise MapError(
                f"latitude {point.latitude_deg}, longitude {point.longitude_deg} is {away_m / 1000:.0f} km from "
                f"the map's origin ({self.latitude_deg}, {self.longitude_deg}); correct one of them"
            )
        x_m, y_m = self._turned(float(east), float(north), -self.heading_rad)
        return (x_m, y_m, float(up))

    @staticmethod
    def _turned(x_m: float, y_m: float, clockwise_rad: float) -> tuple[float, float]:
        cos, sin = math.cos(clockwise_rad), math.sin(clockwise_rad)
        return (x_m * cos + y_m * sin, -x_m * sin + y_m * cos)
