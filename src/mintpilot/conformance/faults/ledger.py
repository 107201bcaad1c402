"""What happened in one mission, seen from outside at its ports. The monitors judge by it alone."""

from __future__ import annotations

import mmap
from dataclasses import dataclass, field

import numpy as np

from mintpilot.conformance.faults.kinds import FaultKind
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.inputs import FactConfirmed, FactTold, FactUndone
from mintpilot.core.motion import Motion
from mintpilot.core.query import Answer, Question
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.told import ToldFact

INTRUDER = "intruder"
"""Whoever calls themselves so has no right to be heard."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Commanded:
    """A motion that the vehicle was told to make."""

    time_s: float
    motion: Motion
    at_m: Vec3
    """Where the vehicle was told that it is."""
    maps: int
    """How many maps had been handed over."""
    said: int | None = None
    """How many answers had been: of one moment only those that came before count. None: all until then."""
    told: int | None = None
    """The same of facts that were told, confirmed or taken back."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Said:
    """An answer that was handed over."""

    time_s: float
    question: str
    answer: Answer
    operator: str = ""
    """Who gave it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """Something that was told, confirmed or taken back."""

    time_s: float
    event: FactTold | FactConfirmed | FactUndone


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """A question that was shown; ``question`` as it was shown last."""

    time_s: float
    question: Question
    maps: int


class Counter:
    """Two numbers that outlive the process that counts: shared between a process and those that it forks."""

    def __init__(self) -> None:
        self._memory = mmap.mmap(-1, 16)

    def set(self, number: int) -> None:
        """Keeps how many events were recorded."""
        self._memory[:8] = number.to_bytes(8, "little")

    def get(self) -> int:
        """How many events were recorded."""
        return int.from_bytes(self._memory[:8], "little")

    def refuse(self) -> None:
        """The disk has refused one write more."""
        self._memory[8:] = (self.refused + 1).to_bytes(8, "little")

    @property
    def refused(self) -> int:
        """How many writes the disk has refused."""
        return int.from_bytes(self._memory[8:], "little")


@dataclass(slots=True)
class Ledger:
    """All of one mission. Times are those of the true clock, not of one that jumps."""

    trace: list[tuple[float, float, float, float]] = field(default_factory=list)
    """(seconds, x, y, z): where the vehicle truly was, at most 0.05 s apart."""
    known: list[tuple[float, FaultKind, str]] = field(default_factory=list)
    """When the mission was told of a fault, of which, and what exactly."""
    commands: list[Commanded] = field(default_factory=list)
    maps: list[tuple[float, SemanticMap]] = field(default_factory=list)
    """Maps that were handed over, oldest first."""
    shown: dict[str, Shown] = field(default_factory=dict)
    withdrawn: dict[str, float] = field(default_factory=dict)
    """When questions were withdrawn first."""
    said: list[Said] = field(default_factory=list)
    told: list[Told] = field(default_factory=list)
    facts: dict[str, ToldFact] = field(default_factory=dict)
    """What the mission made of what was told: by id, as it was said first. The monitors go by ids and words alone."""
    spoken: list[tuple[float, str]] = field(default_factory=list)
    """What truly sounded at a microphone, and when."""
    heard: set[str] = field(default_factory=set)
    """Everybody of whom something was heard."""
    beyond_s: float = np.inf
    """From when on physics leaves no control that could keep the vehicle in the air."""
    simulated: bool = True
    """Whether a simulator tells the mission what was touched; a real vehicle's cannot know."""
    on_the_wall: bool = False
    """Whether mission time passes as on the wall, so that a busy machine delays the mission."""
    crashed: str = ""
    """What the double at the other end of a link says that it flew into; empty: nothing."""
    left_flying: str = ""
    """How it flies on long after the mission, in nobody's care; empty: it does not."""
    over_s: float = np.inf
    """When the vehicle was told to hold at the end."""
    held: bool = False
    """Whether the vehicle was told to hold at the end."""
    now_s: float = 0.0

    def tell(self, kind: FaultKind, what: str = "") -> None:
        """The mission is told of a fault now."""
        self.known.append((self.now_s, kind, what))

    def at(self, time_s: float) -> Vec3:
        """Where the vehicle truly was."""
        row = int(np.searchsorted([at_s for at_s, *_ in self.trace], time_s))
        _, x, y, z = self.trace[min(row, len(self.trace) - 1)]
        return (x, y, z)

    def array(self) -> Floats:
        """The trace (n, 4)."""
        return np.asarray(self.trace, float).reshape(-1, 4)
