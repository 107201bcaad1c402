"""A map source between the mission and the world: the camera goes, freezes, or measures what is not there."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.kinds import FaultKind
from mintpilot.conformance.faults.ledger import Ledger
from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mission.map_source import MapSource

PHANTOMS = 12
"""Most things that are measured where there is nothing."""
PHANTOM_M = 0.6
"""Edge of such a thing, metres."""


class FaultySource(MapSource):
    """The map source that the mission looks through. Wrong depth adds what is not there; it never takes matter away.

    Args:
        inner: the true one.
        draw: which faults come.
        ledger: is told what was handed over.
    """

    def __init__(self, inner: MapSource, draw: Draw, ledger: Ledger) -> None:
        self._inner, self._draw, self._ledger = inner, draw, ledger
        self._rng = draw.rng
        self._gone_told = False

    def look(self) -> None:
        """A picture, where the camera is there."""
        self._check()
        if not self._on(FaultKind.CAMERA_FROZEN):
            self._inner.look()

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        """The map, with phantoms while depth is wrong; nothing new while the picture stands still."""
        self._check()
        frozen = self._on(FaultKind.CAMERA_FROZEN) and previous is not None
        newer = previous if frozen and previous is not None else self._inner.draw(previous)
        if self._on(FaultKind.DEPTH_WRONG):
            newer = self._haunted(newer)
        self._ledger.maps.append((self._ledger.now_s, newer))
        return newer

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """See `MapSource.flown`."""
        self._inner.flown(points_m, radius_m)

    def _check(self) -> None:
        if self._on(FaultKind.CAMERA_GONE):
            if not self._gone_told:
                self._gone_told = True
                self._ledger.tell(FaultKind.CAMERA_GONE)
            raise DeviceError("the camera does not answer any more")

    def _on(self, kind: FaultKind) -> bool:
        fault = self._draw.first(kind)
        return fault is not None and fault.is_on(self._ledger.now_s)

    def _haunted(self, map: SemanticMap) -> SemanticMap:
        fault = self._draw.first(FaultKind.DEPTH_WRONG)
        assert fault is not None
        cells, edge = map.cells.copy(), max(1, round(PHANTOM_M / map.frame.resolution_m))
        for _ in range(1 + int(fault.size * PHANTOMS)):
            low = [int(self._rng.integers(0, n)) for n in cells.shape]
            block = tuple(slice(a, a + edge) for a in low)
            cells[block] = Cell.OCCUPIED if self._rng.random() < 0.7 else Cell.UNKNOWN
        return replace(map, cells=cells)
