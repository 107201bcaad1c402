"""A map on disk: what was seen, as a folder that missions can be thought about and flown on."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

from mintpilot.core.errors import LimitError, MapError, RecordError
from mintpilot.core.geometry import Box, GridFrame, Vec3
from mintpilot.core.observation import Attribute, NameGuess, RegionKind
from mintpilot.core.semantic_map import Cell, Knowledge, MapObject, Region, Room, SemanticMap
from mintpilot.mission_file.schema_base import Positive, Probability

CELLS, THINGS = "map.npz", "map.json"
LARGEST = 64_000_000
"""Voxels of the largest map that is read."""


class _Form(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, defer_build=True)


class _BoxForm(_Form):
    lo_m: Vec3
    hi_m: Vec3

    def box(self) -> Box:
        return Box(lo_m=self.lo_m, hi_m=self.hi_m)


class _ObjectForm(_Form):
    id: str
    label: str
    box_m: _BoxForm
    attributes: list[tuple[str, str]]
    score: Probability
    sightings: int
    names: list[tuple[str, Probability]]
    best_view: tuple[int, int, int, int, int] | None


class _RegionForm(_Form):
    id: str
    kind: RegionKind
    passable: Knowledge
    prior_passable: Probability | None
    description: str


class _RoomForm(_Form):
    id: str
    door_m: _BoxForm
    viewpoint_m: Vec3
    occupied: Knowledge
    searched: bool
    prior_occupied: Probability
    description: str


class _MapForm(_Form):
    """``map.json``; the voxels, and the cells of the regions in their order, are in ``map.npz``."""

    mintpilot_map: Literal[1]
    origin_m: Vec3
    resolution_m: Positive
    start_m: Vec3
    objects: list[_ObjectForm]
    regions: list[_RegionForm]
    rooms: list[_RoomForm]


def save_map(map: SemanticMap, folder: Path, *, start_m: Vec3) -> None:
    """Writes a map into a folder, which is made.

    Args:
        map: what was seen.
        folder: where to.
        start_m: a place known free, where a mission may begin.

    Raises:
        RecordError: the folder cannot be written.
    """
    form = _MapForm(
        mintpilot_map=1,
        origin_m=map.frame.origin_m,
        resolution_m=map.frame.resolution_m,
        start_m=start_m,
        objects=[_object_form(o) for o in map.objects],
        regions=[
            _RegionForm(
                id=r.id,
                kind=r.kind,
                passable=r.passable,
                prior_passable=r.prior_passable,
                description=r.description,
            )
            for r in map.regions
        ],
        rooms=[
            _RoomForm(
                id=r.id,
                door_m=_box_form(r.door_m),
                viewpoint_m=r.viewpoint_m,
                occupied=r.occupied,
                searched=r.searched,
                prior_occupied=r.prior_occupied,
                description=r.description,
            )
            for r in map.rooms
        ],
    )
    members = np.concatenate([np.zeros(0, np.int64), *(r.cells for r in map.regions)])
    ends = np.cumsum([r.cells.size for r in map.regions], dtype=np.int64)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with (folder / CELLS).open("wb") as file:
            np.savez_compressed(file, cells=map.cells, members=members, ends=ends)
        (folder / THINGS).write_text(form.model_dump_json(indent=1) + "\n", "utf-8")
    except OSError as error:
        raise RecordError(f"map folder '{folder}' cannot be written ({error.strerror}); choose another --out") from None


def load_map(folder: Path) -> tuple[SemanticMap, Vec3]:
    """The map in a folder that `save_map` wrote, and the place where a mission may begin.

    Raises:
        MapError: there is none, or it is broken.
        LimitError: it is too large.
    """
    try:
        form = _MapForm.model_validate_json((folder / THINGS).read_bytes())
        with np.load(folder / CELLS, allow_pickle=False) as arrays:
            cells, members, ends = (np.asarray(arrays[key]) for key in ("cells", "members", "ends"))
    except FileNotFoundError as error:
        raise MapError(
            f"'{folder}' is no folder of mintpilot see: there is no '{Path(str(error.filename)).name}'; make it with "
            "mintpilot see SOURCE --out DIR"
        ) from None
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(str(step) for step in first["loc"])
        raise MapError(f"map '{folder}' is broken at {place}: {first['msg']}; see it again") from None
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise MapError(f"map '{folder}' is broken ({error}); see it again") from None
    if cells.size > LARGEST:
        raise LimitError(f"map '{folder}' has {cells.size} voxels, at most {LARGEST} are read; see it more coarsely")
    return _checked_map(form, cells, members, ends, folder), form.start_m


def _checked_map(form: _MapForm, cells: np.ndarray, members: np.ndarray, ends: np.ndarray, folder: Path) -> SemanticMap:
    sound = cells.ndim == 3 and cells.dtype == np.uint8 and int(cells.max(initial=0)) <= max(Cell)
    sound &= members.dtype == np.int64 and members.ndim == 1 and ends.shape == (len(form.regions),)
    sound = sound and bool(((members >= 0) & (members < cells.size)).all())
    if not sound:
        raise MapError(f"map '{folder}' is broken: its arrays do not fit its regions; see it again")
    regions = np.split(members, ends[:-1]) if len(ends) else []
    return SemanticMap(
        frame=GridFrame(
            origin_m=form.origin_m,
            resolution_m=form.resolution_m,
            shape=(cells.shape[0], cells.shape[1], cells.shape[2]),
        ),
        cells=cells,
        objects=tuple(_object_of(o) for o in form.objects),
        regions=tuple(
            Region(
                id=r.id,
                kind=r.kind,
                cells=np.unique(own),
                passable=r.passable,
                prior_passable=r.prior_passable,
                description=r.description,
            )
            for r, own in zip(form.regions, regions, strict=True)
        ),
        rooms=tuple(
            Room(
                id=r.id,
                door_m=r.door_m.box(),
                viewpoint_m=r.viewpoint_m,
                occupied=r.occupied,
                searched=r.searched,
                prior_occupied=r.prior_occupied,
                description=r.description,
            )
            for r in form.rooms
        ),
    )


def _box_form(box: Box) -> _BoxForm:
    return _BoxForm(lo_m=box.lo_m, hi_m=box.hi_m)


def _object_form(thing: MapObject) -> _ObjectForm:
    return _ObjectForm(
        id=thing.id,
        label=thing.label,
        box_m=_box_form(thing.box_m),
        attributes=[(a.name, a.value) for a in thing.attributes],
        score=min(1.0, max(0.0, thing.score)),
        sightings=thing.sightings,
        names=[(g.label, min(1.0, max(0.0, g.probability))) for g in thing.names],
        best_view=thing.best_view,
    )


def _object_of(form: _ObjectForm) -> MapObject:
    return MapObject(
        id=form.id,
        label=form.label,
        box_m=form.box_m.box(),
        attributes=tuple(Attribute(name=name, value=value) for name, value in form.attributes),
        score=form.score,
        sightings=form.sightings,
        names=tuple(NameGuess(label=label, probability=p) for label, p in form.names),
        best_view=form.best_view,
    )
