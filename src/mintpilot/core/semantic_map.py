"""The semantic map [M]: what the drone believes of the world. A value: replaced, never changed in place."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum, StrEnum

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Box, GridFrame, Ints, Vec3, frozen
from mintpilot.core.observation import Attribute, NameGuess, RegionKind
from mintpilot.core.threshold import Threshold


class Cell(IntEnum):
    """State of a voxel. Only ``FREE`` ones may be flown through."""

    UNKNOWN = 0
    FREE = 1
    OCCUPIED = 2


class Knowledge(StrEnum):
    """What is known of a yes/no property. ``OPEN`` means: not known, hence a knowledge gap."""

    OPEN = "open"
    YES = "yes"
    NO = "no"


@dataclass(frozen=True, slots=True, kw_only=True)
class MapObject:
    """A thing in the world, fused over frames."""

    id: str
    """Stable name, e.g. ``box-2``."""
    label: str
    """Semantic class, e.g. ``box``."""
    box_m: Box
    """Extent in the world."""
    attributes: tuple[Attribute, ...] = ()
    """What can be said of it, in plain words."""
    score: float = 1.0
    """Confidence, 0 to 1."""
    sightings: int = 1
    """In how many frames it was seen."""
    best_view: tuple[int, int, int, int, int] | None = None
    """Provenance: frame index and pixel box (left, top, right, bottom) of its largest view."""
    solid: bool = True
    """Whether it can be bumped into; False for marks and other things without matter. One without size never can."""
    names: tuple[NameGuess, ...] = ()
    """What it may be, likeliest first; what is missing to 1 is for none of them. Empty: it is what ``label`` says."""

    @property
    def position_m(self) -> Vec3:
        """Centre of the extent, metres."""
        return self.box_m.centre_m

    def values(self, name: str) -> frozenset[str]:
        """All values of the attribute with that name."""
        return frozenset(a.value for a in self.attributes if a.name == name)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Region:
    """A volume that is passable or not as a whole (smoke, a declared area)."""

    id: str
    """Stable name, e.g. ``smoke-1``."""
    kind: RegionKind
    """What it is."""
    cells: Ints
    """Flat indices (n,) into the grid, sorted, without repetition."""
    passable: Knowledge = Knowledge.OPEN
    """``YES`` only after it was seen free or an explicit answer said so (method, section 6)."""
    prior_passable: float | None = None
    """Probability that it is passable, before any answer; None: that of the mission."""
    description: str = ""
    """What the operator can see of it, e.g. ``the grey smoke near the red rack``."""
    best_view: tuple[int, int, int, int, int] | None = None
    """Provenance: frame index and pixel box."""
    threshold: Threshold | None = None
    """From which value of an ordered measure on it is passable; None: nothing is measured."""

    def __post_init__(self) -> None:
        frozen(self.cells)
        if self.prior_passable is not None and not 0 <= self.prior_passable <= 1:
            raise MapError(f"region '{self.id}': prior {self.prior_passable} is not a probability from 0 to 1")


@dataclass(frozen=True, slots=True, kw_only=True)
class Room:
    """A place that cannot be looked into from where the drone has been (behind a closed door)."""

    id: str
    """Stable name, e.g. ``room-1``."""
    door_m: Box
    """The closed door."""
    viewpoint_m: Vec3
    """From here, in front of the door, the drone can look in."""
    occupied: Knowledge = Knowledge.OPEN
    """Whether somebody is inside."""
    searched: bool = False
    """True once the drone has looked in."""
    prior_occupied: float = 0.5
    """Probability that somebody is inside, before any answer."""
    description: str = ""
    """What the operator can see of it, e.g. ``the closed room with the brown door``."""
    best_view: tuple[int, int, int, int, int] | None = None
    """Provenance: frame index and pixel box."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SemanticMap:
    """Voxels, objects, regions and rooms on one lattice."""

    frame: GridFrame
    """The lattice."""
    cells: NDArray[np.uint8]
    """State of each voxel (nz, ny, nx), values of `Cell`. Cells of a region are what they would be without it."""
    objects: tuple[MapObject, ...] = ()
    regions: tuple[Region, ...] = ()
    rooms: tuple[Room, ...] = ()

    def __post_init__(self) -> None:
        if self.cells.shape != self.frame.shape:
            raise MapError(f"voxels of shape {self.cells.shape} on a lattice of {self.frame.shape}: they must agree")
        frozen(self.cells)

    def object(self, object_id: str) -> MapObject:
        """The object with that id. Raises `KeyError` where there is none."""
        for candidate in self.objects:
            if candidate.id == object_id:
                return candidate
        raise KeyError(object_id)

    def best_view(self, name: str) -> tuple[int, int, int, int, int] | None:
        """The picture that shows a thing, region or room best, and its box there; None where there is none."""
        known: tuple[MapObject | Room | Region, ...] = (*self.objects, *self.rooms, *self.regions)
        return next((one.best_view for one in known if one.id == name), None)

    def with_region(self, region_id: str, passable: Knowledge) -> SemanticMap:
        """The map with that region's passability known (or open again)."""
        regions = tuple(replace(r, passable=passable) if r.id == region_id else r for r in self.regions)
        return replace(self, regions=regions)

    def with_room(
        self, room_id: str, *, occupied: Knowledge | None = None, searched: bool | None = None
    ) -> SemanticMap:
        """The map with more known about that room."""
        rooms = tuple(
            replace(
                r,
                occupied=r.occupied if occupied is None else occupied,
                searched=r.searched if searched is None else searched,
            )
            if r.id == room_id
            else r
            for r in self.rooms
        )
        return replace(self, rooms=rooms)
