"""What reaches the link's control machine, and what it gives out. Immutable values; all times on one clock, seconds."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from mintpilot.core.geometry import Vec3
from mintpilot.core.inputs import Link
from mintpilot.core.motion import Motion, MotionEnd
from mintpilot.core.trajectory import FlightLog
from mintpilot.vehicle.course import SetPoint


class Mode(StrEnum):
    """Flight modes, as far as the link tells them apart."""

    OURS = "ours"
    """It follows our set-points: OFFBOARD on PX4, GUIDED on ArduPilot."""
    TAKE_OFF = "take-off"
    HOLD = "hold"
    LAND = "land"
    RETURN = "return"
    OTHER = "other"
    """Flown by somebody else: a pilot's mode, a mission of a ground station."""


class Start(StrEnum):
    """How its motors are started. Neither firmware may be armed in just any mode, e.g. in that of the last landing."""

    HOLD = "hold"
    """PX4: in Hold, then its own take-off."""
    GUIDED = "guided"
    """ArduPilot: in GUIDED, then its own take-off."""
    SET_POINTS = "set-points"
    """PX4 without a global position, which Hold needs: in OFFBOARD, and it climbs after our set-points."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Seen:
    """What was heard from the autopilot so far, in the map's frame."""

    message_s: float = -1e9
    """When anything was heard last."""
    heartbeat_s: float = -1e9
    heartbeat_every_s: float = 1.0
    """How often it comes."""
    position_s: float = -1e9
    position_m: Vec3 = (0.0, 0.0, 0.0)
    velocity_mps: Vec3 = (0.0, 0.0, 0.0)
    yaw_rad: float = 0.0
    tilt_rad: tuple[float, float] = (0.0, 0.0)
    """Roll to the right, pitch nose up."""
    position_known: bool = False
    """Whether the autopilot itself counts its local position as good."""
    mode: Mode = Mode.OTHER
    mode_name: str = ""
    start: Start = Start.HOLD
    armed: bool = False
    on_ground: bool = True
    not_ready: str = ""
    """Why it cannot be armed yet; empty: it can."""
    status: str = ""
    """The last warning that the autopilot sent in words."""
    battery: float | None = None
    """Share of the battery that is left; None: not told."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Brake:
    """Brake along the trajectory and hover."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Settle:
    """No command follows: land where that is known free."""


Command: TypeAlias = Motion | Brake | Settle


class Action(StrEnum):
    """What the autopilot is asked to do besides set-points. Each is answered by `Did`."""

    STAND_BY = "stand by"
    """Go into the mode in which it is armed: Hold on PX4, GUIDED on ArduPilot."""
    ARM = "arm"
    DISARM = "disarm"
    TAKE_OFF = "take-off"
    ENGAGE = "engage"
    """Follow our set-points."""
    LAND = "land"
    RETURN = "return"
    GRAB = "grab"
    RELEASE = "release"
    SILENCE = "silence"
    """Send no set-points any more; this one is not answered."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """The loop gave a command."""

    time_s: float
    command: Command


@dataclass(frozen=True, slots=True, kw_only=True)
class Fed:
    """The loop is alive."""

    time_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Tick:
    """Time has passed; this is what was heard until now."""

    time_s: float
    seen: Seen


@dataclass(frozen=True, slots=True, kw_only=True)
class Did:
    """The autopilot answered."""

    time_s: float
    action: Action
    error: str = ""
    """Why not; empty: it does it."""


LinkEvent: TypeAlias = Told | Fed | Tick | Did


@dataclass(frozen=True, slots=True, kw_only=True)
class Act:
    """Ask the autopilot to do something."""

    action: Action
    height_m: float = 0.0
    """For a take-off: above where it stands."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ended:
    """A motion ended."""

    motion: int
    end: MotionEnd
    reason: str = ""
    log: FlightLog | None = None
    by_hand: str = ""
    """What a person must do before the act counts; empty: nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Changed:
    """A link went down, or came up again."""

    link: Link
    up: bool
    reason: str = ""


Order: TypeAlias = SetPoint | Act | Ended | Changed
"""What the machine gives out: for the autopilot, and for the loop."""
