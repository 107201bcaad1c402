"""A trial is drawn from its number alone: the world, the faults, when and how bad."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from mintpilot.conformance.faults.kinds import Adapter, Fault, FaultKind

WORLDS: Final = ("sample", "sample", "fire-warehouse", "medicine-boxes", "fire-warehouse-dark")
"""Of kinematic missions; each name is drawn equally often."""
LATEST_S: Final = 30.0
"""No fault begins later, seconds of mission clock."""
LAST_EVENT: Final = 110
"""No process is killed after a later event."""
_ALONE: Final = {FaultKind.KILLED, FaultKind.MEMORY_SHORT}
_PHYSICS: Final = (
    FaultKind.WIND,
    FaultKind.MOTOR_LOST,
    FaultKind.MOTOR_WEAK,
    FaultKind.CAMERA_GONE,
    FaultKind.CAMERA_FROZEN,
    FaultKind.DEPTH_WRONG,
    FaultKind.POSE_JUMPS,
    FaultKind.ORDERS,
    FaultKind.OPERATOR_SILENT,
)
_LINKED: Final = (
    FaultKind.LINK_LOST,
    FaultKind.PILOT,
    FaultKind.POSITION_LOST,
    FaultKind.POSE_JUMPS,
    FaultKind.LATE,
    FaultKind.DOUBLED,
    FaultKind.REORDERED,
    FaultKind.CORRUPT,
    FaultKind.BATTERY,
    FaultKind.REFUSALS,
    FaultKind.ORDERS,
    FaultKind.OPERATOR_SILENT,
)
_BROWSER: Final = (
    FaultKind.CLIENT_SLOW,
    FaultKind.TAB_KILLED,
    FaultKind.FLOODING,
    FaultKind.DOUBLED,
    FaultKind.LATE,
    FaultKind.SECOND,
    FaultKind.WRONG_TOKEN,
    FaultKind.ORDERS,
    FaultKind.TOLD,
)
_SOUND: Final = (
    FaultKind.MISHEARD,
    FaultKind.NOISE,
    FaultKind.TRUNCATED,
    FaultKind.FLOODING,
    FaultKind.OPERATOR_WRONG,
    FaultKind.OPERATOR_GONE,
    FaultKind.DOUBLED,
)
_ELSEWHERE: Final = {
    FaultKind.WIND, FaultKind.MOTOR_WEAK, FaultKind.CORRUPT, FaultKind.NOISE, FaultKind.TRUNCATED,
    FaultKind.CLIENT_SLOW, FaultKind.TAB_KILLED, FaultKind.WRONG_TOKEN,
}  # fmt: skip
KINDS: Final[dict[Adapter, tuple[FaultKind, ...]]] = {
    Adapter.KINEMATIC: tuple(kind for kind in FaultKind if kind not in _ELSEWHERE),
    Adapter.LINK: (),
    Adapter.MUJOCO: _PHYSICS,
    Adapter.DOUBLES: _LINKED,
    Adapter.CONSOLE: _BROWSER,
    Adapter.VOICE: _SOUND,
}
"""What may go wrong with each; a link's faults are drawn in flight."""
_WORLDS: Final = {
    Adapter.KINEMATIC: WORLDS,
    Adapter.MUJOCO: ("medicine-boxes", "medicine-boxes", "fire-warehouse"),
    Adapter.DOUBLES: ("medicine-boxes",),
    Adapter.VOICE: ("sample", "sample", "medicine-boxes"),
}
"""The sample where nothing else is said."""
_SOONEST_S: Final = {Adapter.DOUBLES: 8.0}
"""On the ground a fault keeps the vehicle there, which is soon tried out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Draw:
    """One trial."""

    adapter: Adapter
    number: int
    world: str
    world_seed: int
    faults: tuple[Fault, ...]

    def first(self, kind: FaultKind) -> Fault | None:
        """The fault of that kind, if it is drawn."""
        return next((fault for fault in self.faults if fault.kind is kind), None)

    @property
    def rng(self) -> np.random.Generator:
        """A fresh source of chance for what happens inside the faults."""
        return np.random.default_rng([self.number, 77])


def drawn(adapter: Adapter, number: int) -> Draw:
    """The trial with that number: one fault in half of them, two in four of ten, else three."""
    rng = np.random.default_rng([list(Adapter).index(adapter), number])
    kinds = KINDS[adapter]
    count = 0 if not kinds else 1 + int(rng.choice(3, p=[0.5, 0.4, 0.1]))
    chosen = [kinds[int(i)] for i in rng.choice(len(kinds), size=count, replace=False)] if kinds else []
    ends = [kind for kind in chosen if kind in _ALONE]
    if len(ends) > 1:
        chosen.remove(ends[1])
    worlds = _WORLDS.get(adapter, ("sample",))
    world = worlds[int(rng.integers(len(worlds)))]
    return Draw(
        adapter=adapter,
        number=number,
        world=world,
        world_seed=int(rng.integers(10_000)),
        faults=tuple(_fault(kind, rng, _SOONEST_S.get(adapter, 0.0)) for kind in chosen),
    )


def _fault(kind: FaultKind, rng: np.random.Generator, soonest_s: float) -> Fault:
    at_s = float(rng.uniform(soonest_s, LATEST_S))
    lasts_s = math.inf if rng.random() < 0.5 else float(np.exp(rng.uniform(np.log(0.3), np.log(30.0))))
    if kind is FaultKind.KILLED:
        at_s = float(rng.integers(1, LAST_EVENT))
    return Fault(kind=kind, at_s=round(at_s, 3), lasts_s=round(lasts_s, 3), size=float(rng.random()))
