"""A scene made of a given map, so that missions on a map of one's own can be flown in the kinematic simulator."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from mintpilot.core.gap import BLOCKED, PRESENT
from mintpilot.core.geometry import Bools, Box, GridFrame, Vec3
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap
from mintpilot.simulation.scene import ClosedRoom, Landmark, Person, Scene, Smoke, Solid


def scene_of_map(
    map: SemanticMap,
    *,
    name: str,
    start_m: Vec3,
    truths: Mapping[str, str],
    goal_objects: tuple[str, ...] = (),
    places_m: Mapping[str, Vec3] | None = None,
    must_be_found: Collection[str] = (),
    occupants_sought: bool = True,
) -> Scene:
    """What the map says is there: walls of its occupied cells, and regions with their declared truth.

    A region counts as toxic when it is known or declared to be blocked; one of unknown truth counts as harmless, since
    nothing is known that could happen there. A region that is no box is split into boxes. Objects are landmarks to get
    to and, unless they are not solid or have no size, solids of their extent.

    Args:
        map: the map, with its regions and rooms.
        name: of the scene.
        start_m: where the drone takes off, metres.
        truths: id of a region or room → its true value.
        goal_objects: ids of the objects and places that the instruction really means, in order; empty ones are not
            known.
        places_m: id → those of them that are bare places.
        must_be_found: ids of objects that are people whom the mission has to find.
        occupants_sought: whether people in rooms must be found.
    """
    frame = map.frame
    walls = tuple(
        Solid(id=f"wall-{i}", kind="wall", extent_m=_tall(box, frame))
        for i, box in enumerate(boxes_of(map.cells == Cell.OCCUPIED, frame))
    )
    things = tuple(
        Solid(id=o.id, kind=o.label, extent_m=o.box_m) for o in map.objects if o.solid and any(o.box_m.size_m)
    )
    smokes = []
    for region in map.regions:
        mask = np.zeros(frame.size, bool)
        mask[region.cells] = True
        toxic = region.passable is Knowledge.NO or truths.get(region.id) == BLOCKED
        for i, box in enumerate(boxes_of(mask.reshape(frame.shape), frame)):
            smokes.append(Smoke(id=f"{region.id}/{i}", extent_m=_tall(box, frame), toxic=toxic))
    rooms = []
    for room in map.rooms:
        occupied = room.occupied is Knowledge.YES or truths.get(room.id) == PRESENT
        occupant = None
        if occupied:
            occupant = Person(id=f"{room.id}/person", position_m=room.door_m.centre_m, must_be_found=occupants_sought)
        rooms.append(
            ClosedRoom(
                id=room.id,
                extent_m=room.door_m,
                door_m=room.door_m,
                viewpoint_m=room.viewpoint_m,
                occupant=occupant,
            )
        )
    return Scene(
        name=name,
        volume=_tall(frame.box, frame),
        start_m=start_m,
        solids=(*things, *walls),
        smokes=tuple(smokes),
        rooms=tuple(rooms),
        landmarks=(
            *(
                Landmark(id=o.id, kind=o.label, extent_m=_tall(o.box_m, frame), must_be_found=o.id in must_be_found)
                for o in map.objects
            ),
            *(
                Landmark(id=name, kind="place", extent_m=_tall(Box(lo_m=place, hi_m=place), frame))
                for name, place in (places_m or {}).items()
            ),
        ),
        goal_objects=goal_objects,
    )


def boxes_of(mask: Bools, frame: GridFrame) -> tuple[Box, ...]:
    """The marked cells (nz, ny, nx) as few boxes that do not overlap: runs along x, merged along y, then along z."""
    open_runs: dict[tuple[int, int, int, int], int] = {}
    done: list[tuple[int, int, int, int, int, int]] = []
    for z in range(frame.shape[0]):
        rectangles = _rectangles(mask[z])
        current = dict.fromkeys(rectangles, z)
        for key, first in open_runs.items():
            if key in current:
                current[key] = first
            else:
                done.append((first, z, *key))
        open_runs = current
    done += [(first, frame.shape[0], *key) for key, first in open_runs.items()]
    lo, res = np.asarray(frame.origin_m), frame.resolution_m
    return tuple(
        Box(lo_m=_triple(lo + res * np.array([x0, y0, z0])), hi_m=_triple(lo + res * np.array([x1, y1, z1])))
        for z0, z1, y0, y1, x0, x1 in sorted(done)
    )


def _rectangles(layer: Bools) -> list[tuple[int, int, int, int]]:
    """One layer (ny, nx) as rectangles (y0, y1, x0, x1), ends exclusive."""
    growing: dict[tuple[int, int], int] = {}
    done: list[tuple[int, int, int, int]] = []
    for y in range(layer.shape[0] + 1):
        row = layer[y] if y < layer.shape[0] else np.zeros(layer.shape[1], bool)
        edges = np.flatnonzero(np.diff(np.concatenate(([False], row, [False])).astype(np.int8)))
        runs = {(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)}
        for run, first in list(growing.items()):
            if run not in runs:
                done.append((first, y, *run))
                del growing[run]
        for run in runs:
            growing.setdefault(run, y)
    return done


def _tall(box: Box, frame: GridFrame) -> Box:
    """On a flat map everything reaches well above and below its one layer, so that the layer's height never matters."""
    if not frame.is_flat:
        return box
    return Box(lo_m=(*box.lo_m[:2], box.lo_m[2] - 5.0), hi_m=(*box.hi_m[:2], box.hi_m[2] + 5.0))


def _triple(point: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Vec3:
    x, y, z = (float(v) for v in point)
    return (x, y, z)
