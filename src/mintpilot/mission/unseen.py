"""What is sought and was not seen: zones of unseen space, as one target gap with a look at each (method, section 9)."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage

from mintpilot.core.gap import NOT_HERE, Candidate, GapKind, KnowledgeGap, target_id
from mintpilot.core.geometry import Bools, Floats, Ints, Vec3
from mintpilot.core.plan import Site, Stop, VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap
from mintpilot.core.task import Action
from mintpilot.mapping.wording import describe_all
from mintpilot.planning.flyable import flyable_cells, region_reach
from mintpilot.planning.reach import LookAround
from mintpilot.planning.sight import view_gain_m3
from mintpilot.uncertainty.findings import Findings
from mintpilot.uncertainty.gaps import LOOK_REACH_M

SEARCH = target_id(0, "unseen")
"""Id of the gap that asks where the sought thing is."""
MOST_ZONES = 6
LOOKS_A_ZONE = 2
"""A zone is looked around in so often; what could not be seen then cannot be seen."""
HERE = 0.5
"""Probability, before anything was seen, that what is sought is here at all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Zone:
    """A part of the map in which space was not seen yet."""

    id: str
    viewpoint_m: Vec3
    """From here the most of it can be seen."""
    unseen_m3: float
    """Unseen space in view from there."""


def with_search(
    findings: Findings, map: SemanticMap, limits: VehicleLimits, start_m: Vec3, finished: Collection[str]
) -> Findings:
    """The findings with a search for what is sought and was not seen; as they are where no unseen space is in reach.

    The gap's values are the zones and `NOT_HERE`: what is sought is here with probability `HERE`, anywhere alike, and
    was not where it was looked.
    """
    zones = unseen_zones(map, limits, start_m, finished)
    if not zones:
        return findings
    unseen_m3 = np.array([zone.unseen_m3 for zone in zones])
    seen_m3 = float((map.cells == Cell.FREE).sum()) * map.frame.resolution_m**3
    here = HERE * unseen_m3 / (unseen_m3.sum() + seen_m3)
    chances = here / (here.sum() + 1 - HERE)
    words = describe_all(map.frame.box, ["the unseen space"] * len(zones), [zone.viewpoint_m for zone in zones])
    gap = KnowledgeGap(
        id=SEARCH,
        kind=GapKind.TARGET,
        subject=findings.sought,
        description=findings.sought,
        values=(*(zone.id for zone in zones), NOT_HERE),
        prior=(*(float(p) for p in chances), 1.0 - float(chances.sum())),
        position_m=zones[0].viewpoint_m,
        candidates=tuple(
            Candidate(id=zone.id, position_m=zone.viewpoint_m, description=said)
            for zone, said in zip(zones, words, strict=True)
        ),
    )
    looks = tuple(
        Stop(
            id=search_stop_id(zone.id, 1 + _looks(zone.id, finished)),
            action=Action.LOOK,
            sites=(Site(position_m=zone.viewpoint_m, reach_m=LOOK_REACH_M, value=zone.id, label=zone.id),),
            gap=SEARCH,
            optional=True,
            informs=True,
        )
        for zone in zones
    )
    gaps = tuple(sorted((*findings.gaps, gap), key=lambda one: one.id))
    left = tuple(problem for problem in findings.problems if problem not in findings.unseen)
    return replace(findings, gaps=gaps, stops=(*findings.stops, *looks), problems=left)


def unseen_zones(
    map: SemanticMap, limits: VehicleLimits, start_m: Vec3, finished: Collection[str] = ()
) -> tuple[Zone, ...]:
    """At most `MOST_ZONES` parts of the map, by id, each with the place from which most unseen space is in view.

    Places may lie in clouds that are not known to be blocked: from inside, the cloud hides nothing.

    Args:
        map: what is known.
        limits: size of the vehicle.
        start_m: where it is, metres.
        finished: ids of stops that were done: a zone that was looked around in `LOOKS_A_ZONE` times is left out.
    """
    look = LookAround()
    cells, clouded = _places(map, limits, start_m, look)
    if not len(cells):
        return ()
    centres = map.frame.centres_of(cells)
    gain_m3 = np.where(clouded, _gain_m3(replace(map, regions=()), centres, look), _gain_m3(map, centres, look))
    tiles = _tiles(map, centres)
    zones = []
    for tile in sorted(set(tiles.tolist())):
        best = int(np.argmax(np.where(tiles == tile, gain_m3, -1.0)))
        name = f"zone-{tile + 1}"
        if gain_m3[best] >= look.least_gain_m3 and _looks(name, finished) < LOOKS_A_ZONE:
            x, y, z = (float(v) for v in centres[best])
            zones.append(Zone(id=name, viewpoint_m=(x, y, z), unseen_m3=float(gain_m3[best])))
    return tuple(zones)


def search_stop_id(zone: str, number: int) -> str:
    """Id of the stop at which it is looked around in a zone for that time, from 1 on."""
    return f"look:{zone}:{number}"


def is_search(stop: Stop) -> bool:
    """Whether a stop looks around for what was not seen."""
    return stop.gap == SEARCH


def _looks(zone: str, finished: Collection[str]) -> int:
    return sum(name.startswith(f"look:{zone}:") for name in finished)


def _places(map: SemanticMap, limits: VehicleLimits, start_m: Vec3, look: LookAround) -> tuple[Ints, Bools]:
    """Cells (n, 3) to look around from that can be reached if clouds turn out well, and which of them are in clouds."""
    free, clouds = flyable_cells(map, limits), np.zeros(map.frame.shape, bool)
    for region in map.regions:
        if region.passable is Knowledge.NO:
            free.reshape(-1)[region_reach(map, region, limits)] = False
        else:
            clouds.reshape(-1)[region_reach(map, region, limits)] = True
    parts, _ = ndimage.label(free, np.ones((3, 3, 3)))
    found = np.argwhere(free)
    if not len(found):
        return found, np.zeros(0, bool)
    start = found[int(np.argmin(np.linalg.norm(map.frame.centres_of(found) - np.asarray(start_m), axis=1)))]
    cells = np.argwhere(parts == parts[tuple(start)])
    high = map.frame.centres_of(cells)[:, 2] >= map.frame.origin_m[2] + look.lowest_m
    inside = clouds[tuple(cells.T)]
    chosen = [part[:: max(1, len(part) // look.places)] for part in (cells[high & ~inside], cells[high & inside])]
    cells = np.concatenate(chosen)
    return cells, clouds[tuple(cells.T)]


def _gain_m3(map: SemanticMap, places_m: Floats, look: LookAround) -> Floats:
    return view_gain_m3(
        map,
        np.ones(map.frame.shape, bool),
        places_m,
        reach_m=look.reach_m,
        close_m=look.close_m,
        elevation_rad=look.elevation_rad,
    )


def _tiles(map: SemanticMap, places_m: Floats) -> Ints:
    """In which of at most `MOST_ZONES` parts of the map, as square as they come, each place (n, 3) lies."""
    lo, size = np.asarray(map.frame.box.lo_m), np.asarray(map.frame.box.size_m)
    splits = [(i, j) for i in range(1, MOST_ZONES + 1) for j in range(1, MOST_ZONES + 1) if i * j == MOST_ZONES]
    nx, ny = min(splits, key=lambda n: abs(np.log((size[0] / n[0]) / (size[1] / n[1]))))
    at = (places_m - lo) / size * (nx, ny, 1)
    column, row = (np.clip(at[:, axis].astype(np.int64), 0, n - 1) for axis, n in ((0, nx), (1, ny)))
    tiles: Ints = row * nx + column
    return tiles
