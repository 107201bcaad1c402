"""What the mission wants done: the directives that `step` gives and the loop carries out (method, section 8)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from mintpilot.core.geometry import Floats
from mintpilot.core.message import Message
from mintpilot.core.mission import Verdict
from mintpilot.core.motion import Motion
from mintpilot.core.query import Question
from mintpilot.mission.requests import Request


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Move:
    """Begin this motion. The vehicle is at rest."""

    motion: Motion
    monitored_m: Floats | None = None
    """The path (n, 3) that is watched while the motion goes on, metres; None: the camera looks, nothing is assessed."""
    assume_passable: frozenset[str] = frozenset()
    """Regions that a deliberately unsafe baseline flies through; empty for all others."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Brake:
    """Brake along the checked path and hover. Without a motion: nothing to do."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Observe:
    """Look from here, and draw the map anew."""

    look: bool = True
    """False: draw it from what was seen already."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BeginTask:
    """The survey is over: from now on flight time counts. A simulator brings a fresh battery."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Deliberate:
    """Work this out. The decision comes back as an event."""

    request: Request


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShowQuestion:
    """Put the question to all operators; the same id again: in better words."""

    question: Question
    patience_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class WithdrawQuestion:
    """The question is no longer open."""

    question: str
    """Its id."""
    why: Message


@dataclass(frozen=True, slots=True, kw_only=True)
class Tell:
    """Say this to all operators."""

    text: Message


@dataclass(frozen=True, slots=True, kw_only=True)
class Note:
    """Worth a line in the report."""

    kind: str
    """A short stable name, e.g. ``contradiction``."""
    text: Message


@dataclass(frozen=True, slots=True, kw_only=True)
class Finish:
    """The mission is over."""

    verdict: Verdict


Directive: TypeAlias = (
    Move | Brake | Observe | BeginTask | Deliberate | ShowQuestion | WithdrawQuestion | Tell | Note | Finish
)
