"""The map builder: frames and detections in, semantic maps out (method, section 1)."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Bools, Box, GridFrame
from mintpilot.core.observation import Detection, Frame, RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.mapping.body_parts import with_parts_counted
from mintpilot.mapping.corridors import off_corridor
from mintpilot.mapping.fusion import FusionInput, fused_objects, fused_regions, fused_rooms
from mintpilot.mapping.glow import Glow
from mintpilot.mapping.identity import Names
from mintpilot.mapping.objects import Tracks
from mintpilot.mapping.rays import cast_rays
from mintpilot.mapping.settings import MappingSettings
from mintpilot.mapping.smoke import Clouds, SmokeEvidence, cells_in


class MapBuilder:
    """Gathers what was seen. It changes; the maps that it gives out are values.

    Args:
        frame: the lattice of the voxels.
        limits: the vehicle, for viewpoints that it can hover at.
        volume: where the vehicle may fly; voxels outside are never free. Places are described relative to it.
        prior_passable: probability that a cloud is passable, before any answer.
        prior_occupied: probability that somebody is in a closed room, before any answer.
        settings: sensor model and thresholds; None for the defaults.
    """

    def __init__(
        self,
        frame: GridFrame,
        *,
        limits: VehicleLimits,
        volume: Box,
        prior_passable: float = 0.5,
        prior_occupied: float = 0.5,
        settings: MappingSettings | None = None,
    ) -> None:
        self._frame = frame
        self._limits = limits
        self._volume = volume
        self._priors = (prior_passable, prior_occupied)
        self._settings = settings or MappingSettings()
        self._log_odds: NDArray[np.float32] = np.zeros(frame.shape, np.float32)
        self._stamp: NDArray[np.int32] = np.zeros(frame.shape, np.int32)
        self._solid: NDArray[np.int32] = np.zeros(frame.shape, np.int32)
        self._flown = np.zeros(frame.shape, bool)
        self._inside = cells_in(frame, volume)
        self._tick = 0
        self._tracks = Tracks()
        self._clouds = Clouds(frame)
        self._glow = Glow(frame)
        self._names = Names()
        self._last: SemanticMap | None = None

    @property
    def last(self) -> SemanticMap | None:
        """The map that was drawn last; None before the first one."""
        return self._last

    def integrate(self, frame: Frame, detections: Iterable[Detection]) -> None:
        """Learns from one picture and from what was found in it.

        Depth that is NaN, infinite or 0 teaches nothing. Where the frame shows smoke, space is cleared up to the
        cloud's front only, and the front is not taken for something solid.
        """
        found = tuple(detections)
        settings = self._settings
        smoke = self._clouds.add(found)
        self._glow.add(found)
        eye = np.asarray(frame.world_from_camera[:3, 3], float)
        for detection in found:
            if detection.label not in ("smoke", "glow"):
                self._tracks.add(detection, eye)
        lens = frame.camera
        stride = max(1, int(np.ceil(np.sqrt(frame.depth_m.size / settings.max_rays))))
        self._tick += 1
        cast_rays(
            np.ascontiguousarray(frame.depth_m, np.float32),
            stride,
            (lens.fx, lens.fy, lens.cx, lens.cy),
            np.ascontiguousarray(frame.world_from_camera, float),
            np.asarray(self._frame.origin_m, float),
            self._frame.resolution_m,
            self._log_odds,
            self._stamp,
            self._solid,
            self._tick,
            smoke,
            (settings.min_range_m, settings.near_m, settings.max_range_m),
            (settings.hit, settings.far_hit, settings.miss, settings.clamp),
        )
        self._clouds.contradict(self._stamp == 2 * self._tick)

    def mark_flown(self, points_m: ArrayLike, radius_m: float) -> None:
        """Takes the space around places (n, 3), metres, where the vehicle truly was as free, whatever depth says.

        The camera never sees the space that the vehicle itself is in, so its start would else be unknown for ever.
        Voxels whose centre lies within ``radius_m`` of a place count.
        """
        points = np.atleast_2d(np.asarray(points_m, float))
        n = int(np.ceil(radius_m / self._frame.resolution_m)) + 1
        steps = np.mgrid[-n : n + 1, -n : n + 1, -n : n + 1].reshape(3, -1).T
        # Places nearer to each other than half a voxel tell nothing new.
        points = np.unique(np.round(points / (0.5 * self._frame.resolution_m)), axis=0) * 0.5 * self._frame.resolution_m
        for point in points:
            cells = self._frame.cells_of(point) + steps
            near = np.linalg.norm(self._frame.centres_of(cells) - point, axis=1) <= radius_m
            z, y, x = cells[near & self._frame.contains(cells)].T
            self._flown[z, y, x] = True

    def snapshot(self, previous: SemanticMap | None = None) -> SemanticMap:
        """The map as known now.

        Args:
            previous: what is known besides: the answers in it (region passable, room occupied or searched) and its
                ids are carried over to the same things, and things in it that this builder has not seen stay. None:
                the last snapshot.

        Raises:
            MapError: ``previous`` is on another lattice.
        """
        known = previous if previous is not None else self._last
        if known is not None and known.frame != self._frame:
            raise MapError(
                f"previous map on {known.frame}, this builder on {self._frame}: they must be the same lattice"
            )
        cells = self._voxels()
        given = FusionInput(
            frame=self._frame,
            cells=cells,
            volume=self._volume,
            settings=self._settings,
            names=self._names,
            previous=known,
            hull_m=self._limits.clearance_m,
        )
        objects = with_parts_counted(fused_objects(self._tracks.all, given))
        flames = [thing.box_m for thing in objects if thing.label == "fire"]
        blazing = self._blazing(flames)
        evidence = SmokeEvidence(solid=self._solid, free=cells == Cell.FREE, blazing=blazing)
        clouds = self._clouds.clouds(evidence, self._volume, self._settings)
        cells[self._clouds.front_of(clouds, self._solid) & (cells == Cell.OCCUPIED)] = Cell.UNKNOWN
        blazing |= self._blazing(self._glow.boxes(clouds, flames, self._clouds.seen))
        cells[blazing] = Cell.OCCUPIED  # flames return hardly any depth, yet nobody flies through them
        cells[self._flown & self._inside] = Cell.FREE
        regions = fused_regions(clouds, given, self._priors[0])
        flat = cells.reshape(-1)
        for region in regions:
            # Inside a cloud unknown voxels count as free: the region may be entered only after an explicit yes for
            # the whole of it, and mapping goes on in flight, so that a solid thing hidden in it is seen when near.
            if region.kind is RegionKind.SMOKE:
                here = flat[region.cells]
                unsure = (here == Cell.UNKNOWN) & self._hugging(region, cells, blazing, known)
                flat[region.cells] = np.where((here == Cell.OCCUPIED) | unsure, here, Cell.FREE)
        rooms = fused_rooms(self._tracks.all, given, self._priors[1])
        self._last = SemanticMap(frame=self._frame, cells=cells, objects=objects, regions=regions, rooms=rooms)
        return self._last

    def _hugging(self, cloud: Region, cells: NDArray[np.uint8], blazing: Bools, known: SemanticMap | None) -> Bools:
        """Which of the cloud's cells (n,) are too near to something solid to be counted on.

        Once the drone may fly in it, its way there stays as it was: what was free in the map before stays so.
        """
        mask = np.zeros(cells.shape, bool)
        mask.reshape(-1)[cloud.cells] = True
        near = off_corridor(
            mask,
            cells == Cell.OCCUPIED,
            cells == Cell.FREE,
            ends=blazing,
            resolution_m=self._frame.resolution_m,
            hull_m=self._limits.clearance_m,
        )
        if known is not None and cloud.passable is Knowledge.YES:
            near &= known.cells != Cell.FREE
        return np.asarray(near.reshape(-1)[cloud.cells])

    def _blazing(self, flames: list[Box]) -> Bools:
        """Where flames may reach: they move, only their brightest part is recognised, and nobody flies over them."""
        blazing = np.zeros(self._frame.shape, bool)
        reach, floor, roof = self._settings.fire_margin_m, self._volume.lo_m[2], self._volume.hi_m[2]
        for box in flames:
            (x0, y0, z0), (x1, y1, z1) = box.lo_m, box.hi_m
            lo, hi = (x0 - reach, y0 - reach, min(floor, z0)), (x1 + reach, y1 + reach, max(roof, z1))
            blazing |= cells_in(self._frame, Box(lo_m=lo, hi_m=hi))
        blazing &= self._inside
        return blazing

    def _voxels(self) -> NDArray[np.uint8]:
        cells = np.full(self._frame.shape, Cell.UNKNOWN, np.uint8)
        cells[(self._log_odds < self._settings.free_below) & self._inside] = Cell.FREE
        cells[self._log_odds > self._settings.occupied_above] = Cell.OCCUPIED
        return cells
