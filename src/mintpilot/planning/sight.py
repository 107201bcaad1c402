"""Information gain of a place to look from: unknown space, and surfaces that were never looked at closely."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.semantic_map import Cell, SemanticMap

RAYS = 400
"""Number of directions that are looked in."""
SURFACE_M = 0.2
"""Value of a square metre of surface that was never looked at closely, in cubic metres of unknown space."""
FLOOR_M = 0.45
"""Height below which surfaces are floor, metres."""


def view_gain_m3(
    map: SemanticMap,
    inspected: Bools,
    places_m: Floats,
    *,
    reach_m: float,
    close_m: float,
    elevation_rad: tuple[float, float],
) -> Floats:
    """Information gain of a turn around on the spot, as cubic metres of space not seen before, for each place (n, 3).

    Unknown space counts by its volume, surfaces not inspected yet by their area times `SURFACE_M`. Sight ends at
    occupied cells, at regions that are not known to be passable (smoke), and at ``reach_m``. Unknown cells are looked
    through: what lies behind the first of them may be seen too, or not.

    Args:
        map: what is known.
        inspected: flags (nz, ny, nx) of surface cells that were looked at from near.
        places_m: where to look from.
        reach_m: how far unknown space counts, metres.
        close_m: how near one must be to a surface to have looked at it, metres.
        elevation_rad: lowest and highest angle that the camera sees, against the horizon.
    """
    directions, solid_angle = _directions(elevation_rad)
    seen: Floats = _seen(
        np.ascontiguousarray(map.cells == Cell.UNKNOWN),
        _opaque(map),
        inspected,
        np.ascontiguousarray(places_m, float),
        directions,
        solid_angle,
        np.asarray(map.frame.origin_m, float),
        map.frame.resolution_m,
        (reach_m, close_m, map.frame.origin_m[2] + FLOOR_M),
        False,
    )
    return seen


def inspect(
    map: SemanticMap, inspected: Bools, place_m: Floats, *, close_m: float, elevation_rad: tuple[float, float]
) -> None:
    """Marks in ``inspected`` the surfaces that a turn around at a place (3,) has shown from near. Works in place."""
    directions, solid_angle = _directions(elevation_rad, rays=4 * RAYS)
    _seen(
        np.zeros_like(inspected),
        _opaque(map),
        inspected,
        np.ascontiguousarray(place_m, float).reshape(1, 3),
        directions,
        solid_angle,
        np.asarray(map.frame.origin_m, float),
        map.frame.resolution_m,
        (close_m, close_m, map.frame.origin_m[2] + FLOOR_M),
        True,
    )


def _opaque(map: SemanticMap) -> Bools:
    opaque: Bools = map.cells == Cell.OCCUPIED
    for region in map.regions:
        opaque.reshape(-1)[region.cells] = True
    return opaque


def _directions(elevation_rad: tuple[float, float], rays: int = RAYS) -> tuple[Floats, float]:
    """Unit vectors (n, 3) spread evenly over a band of the sphere, and the solid angle of each."""
    low, high = math.sin(elevation_rad[0]), math.sin(elevation_rad[1])
    z = low + (np.arange(rays) + 0.5) / rays * (high - low)
    turn = np.arange(rays) * math.pi * (3 - math.sqrt(5))
    level = np.sqrt(1 - z * z)
    return np.stack([level * np.cos(turn), level * np.sin(turn), z], axis=1), 2 * math.pi * (high - low) / rays


@compiled()
def _seen(
    unknown: Bools,
    opaque: Bools,
    inspected: Bools,
    places: Floats,
    directions: Floats,
    solid_angle: float,
    origin: Floats,
    resolution: float,
    limits: tuple[float, float, float],
    mark: bool,
) -> Floats:
    reach, close, floor = limits
    nz, ny, nx = unknown.shape
    gain = np.zeros(places.shape[0])
    for p in range(places.shape[0]):
        for d in range(directions.shape[0]):
            r = resolution
            while r < reach:
                z = places[p, 2] + r * directions[d, 2]
                i = int((places[p, 0] + r * directions[d, 0] - origin[0]) // resolution)
                j = int((places[p, 1] + r * directions[d, 1] - origin[1]) // resolution)
                k = int((z - origin[2]) // resolution)
                if i < 0 or j < 0 or k < 0 or i >= nx or j >= ny or k >= nz:
                    break
                if opaque[k, j, i]:
                    if r <= close and z > floor and not inspected[k, j, i]:
                        gain[p] += SURFACE_M * solid_angle * r * r
                        inspected[k, j, i] |= mark
                    break
                if unknown[k, j, i]:
                    gain[p] += solid_angle * r * r * resolution
                r += resolution
    return gain
