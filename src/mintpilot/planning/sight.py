"""How much unknown space could be seen from a place."""

from __future__ import annotations

import math

import numba as nb
import numpy as np

from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.semantic_map import Cell, SemanticMap

RAYS = 400
"""Directions that are looked in."""


def visible_unknown_m3(
    map: SemanticMap, places_m: Floats, *, reach_m: float, elevation_rad: tuple[float, float]
) -> Floats:
    """Unknown space that a turn around on the spot would show, cubic metres, for each place (n, 3).

    Sight ends at occupied cells, at regions that are not known to be passable (smoke), and at ``reach_m``. Unknown
    cells are looked through: what lies behind the first of them may be seen too, or not.

    Args:
        map: what is known.
        places_m: where to look from.
        reach_m: how far to look, metres.
        elevation_rad: lowest and highest angle that the camera sees, against the horizon.
    """
    opaque: Bools = map.cells == Cell.OCCUPIED
    flat = opaque.reshape(-1)
    for region in map.regions:
        flat[region.cells] = True
    directions, solid_angle = _directions(elevation_rad)
    seen: Floats = _seen(
        np.ascontiguousarray(map.cells == Cell.UNKNOWN),
        opaque,
        np.ascontiguousarray(places_m, float),
        directions,
        solid_angle,
        np.asarray(map.frame.origin_m, float),
        map.frame.resolution_m,
        map.frame.resolution_m,
        reach_m,
    )
    return seen


def _directions(elevation_rad: tuple[float, float]) -> tuple[Floats, float]:
    """Unit vectors (n, 3) spread evenly over a band of the sphere, and the solid angle of each."""
    low, high = math.sin(elevation_rad[0]), math.sin(elevation_rad[1])
    z = low + (np.arange(RAYS) + 0.5) / RAYS * (high - low)
    turn = np.arange(RAYS) * math.pi * (3 - math.sqrt(5))
    level = np.sqrt(1 - z * z)
    return np.stack([level * np.cos(turn), level * np.sin(turn), z], axis=1), 2 * math.pi * (high - low) / RAYS


@nb.njit(cache=True)
def _seen(
    unknown: Bools,
    opaque: Bools,
    places: Floats,
    directions: Floats,
    solid_angle: float,
    origin: Floats,
    step: float,
    resolution: float,
    reach: float,
) -> Floats:
    nz, ny, nx = unknown.shape
    gain = np.zeros(places.shape[0])
    for p in range(places.shape[0]):
        for d in range(directions.shape[0]):
            r = step
            while r < reach:
                i = int((places[p, 0] + r * directions[d, 0] - origin[0]) // resolution)
                j = int((places[p, 1] + r * directions[d, 1] - origin[1]) // resolution)
                k = int((places[p, 2] + r * directions[d, 2] - origin[2]) // resolution)
                if i < 0 or j < 0 or k < 0 or i >= nx or j >= ny or k >= nz or opaque[k, j, i]:
                    break
                if unknown[k, j, i]:
                    gain[p] += solid_angle * r * r * step
                r += step
    return gain
