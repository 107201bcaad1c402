"""Somebody who tells, draws, confirms and takes back facts in any order, about what is there and what is not."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.kinds import FaultKind
from mintpilot.conformance.faults.ledger import Ledger
from mintpilot.core.inputs import FactConfirmed, FactTold, FactUndone, OperatorInput
from mintpilot.core.told import MOST_CORNERS, Fact, KeepOut, RegionBlocked, RegionPassable, RoomSearched, ThisOne

BETWEEN_S: Final = 1.5
"""Between two bursts, seconds at most."""
BURST: Final = 4
"""Most things that are told at once."""


class Teller:
    """Tells while `FaultKind.TOLD` is on.

    Args:
        draw: which faults come.
        ledger: knows the map, what was asked, and what was told before.
    """

    def __init__(self, draw: Draw, ledger: Ledger) -> None:
        self._fault, self._ledger = draw.first(FaultKind.TOLD), ledger
        self._rng = np.random.default_rng([draw.number, 17])
        self._next_s = 0.0

    def tells(self, time_s: float) -> list[OperatorInput]:
        """What is told now."""
        now_s = self._ledger.now_s
        if self._fault is None or not self._fault.is_on(now_s) or now_s < self._next_s:
            return []
        self._next_s = now_s + BETWEEN_S * float(self._rng.random())
        return [self._one(time_s) for _ in range(1 + int(self._rng.integers(BURST)))]

    def _one(self, time_s: float) -> OperatorInput:
        roll = self._rng.random()
        name = self._any([*self._ledger.facts, "told-0", ""])
        if roll < 0.3:
            return FactConfirmed(time_s=time_s, told=name, operator="teller")
        if roll < 0.5:
            return FactUndone(time_s=time_s, told=name, operator="teller")
        return FactTold(time_s=time_s, fact=self._fact(), operator="teller")

    def _fact(self) -> Fact:
        map = self._ledger.maps[-1][1] if self._ledger.maps else None
        regions = [region.id for region in map.regions] if map is not None else []
        rooms = [room.id for room in map.rooms] if map is not None else []
        shown = [one.question for one in self._ledger.shown.values()]
        things = [value for asked in shown for gap in asked.gaps for value in gap.values]
        roll = self._rng.random()
        if roll < 0.35:
            return RegionPassable(region=self._any([*regions, "nowhere"]))
        if roll < 0.55:
            return RegionBlocked(region=self._any([*regions, "nowhere"]))
        if roll < 0.65:
            return RoomSearched(room=self._any([*rooms, "nowhere"]))
        if roll < 0.75:
            return ThisOne(thing=self._any([*things, "nothing"]))
        return KeepOut(corners_m=self._outline())

    def _outline(self) -> tuple[tuple[float, float], ...]:
        """Around the drone, somewhere, huge, a point, or one that crosses itself."""
        rng = self._rng
        x, y = self._ledger.trace[-1][1:3]
        kind, count = int(rng.integers(5)), int(rng.choice([3, 4, 5, MOST_CORNERS]))
        if kind == 1:
            x, y = x + float(rng.normal()) * 4, y + float(rng.normal()) * 4
        size_m = (0.5, 1.0, 1e6, 0.0, 3.0)[kind] * float(rng.uniform(0.5, 1.5))
        angles = rng.uniform(0, 2 * math.pi, count) if kind == 4 else np.linspace(0, 2 * math.pi, count, endpoint=False)
        return tuple((x + size_m * math.cos(a), y + size_m * math.sin(a)) for a in angles)

    def _any(self, names: list[str]) -> str:
        return names[int(self._rng.integers(len(names)))]
