"""Which faults there are, and the safe state that each must lead to, within which time."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Final


class Adapter(StrEnum):
    """What the missions are flown with."""

    KINEMATIC = "kinematic"
    """The kinematic simulator, with every port of the mission faulty."""
    LINK = "link"
    """The control of a real link against the double's autopilot, on a clock turned by hand."""
    MUJOCO = "mujoco"
    """Physics and camera: wind, motors, pictures, a position that is wrong."""
    DOUBLES = "doubles"
    """Both vehicle doubles, over MAVLink and UDP, in real time."""
    CONSOLE = "console"
    """The web console with a real browser, in real time."""
    VOICE = "voice"
    """Sound alone, with real recognisers: noise, cut and misheard words."""


class FaultKind(StrEnum):
    """What goes wrong."""

    CAMERA_GONE = "camera-gone"
    CAMERA_FROZEN = "camera-frozen"
    DEPTH_WRONG = "depth-wrong"
    POSE_JUMPS = "pose-jumps"
    POSITION_LOST = "position-lost"
    MOTOR_LOST = "motor-lost"
    MOTOR_WEAK = "motor-weak"
    WIND = "wind"
    LINK_LOST = "link-lost"
    PILOT = "pilot"
    REFUSALS = "refusals"
    STOPS = "stops"
    LATE = "late"
    DOUBLED = "doubled"
    REORDERED = "reordered"
    CORRUPT = "corrupt"
    BATTERY = "battery"
    OPERATOR_WRONG = "operator-wrong"
    OPERATOR_SILENT = "operator-silent"
    OPERATOR_GONE = "operator-gone"
    CONTRADICTORY = "contradictory"
    SECOND = "second"
    """Somebody else answers too, on another link, and says the opposite."""
    TOLD = "told"
    """Facts are told, drawn, confirmed and taken back in any order."""
    FLOODING = "flooding"
    ORDERS = "orders"
    MISHEARD = "misheard"
    NOISE = "noise"
    TRUNCATED = "truncated"
    """Sound that is cut off."""
    CLIENT_SLOW = "client-slow"
    TAB_KILLED = "tab-killed"
    WRONG_TOKEN = "wrong-token"
    MODEL_HOSTILE = "model-hostile"
    THINKING_LATE = "thinking-late"
    THINKING_FAILS = "thinking-fails"
    DISK_FULL = "disk-full"
    DISK_SLOW = "disk-slow"
    DISK_GONE = "disk-gone"
    KILLED = "killed"
    CLOCK_JUMPS = "clock-jumps"
    MEMORY_SHORT = "memory-short"


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """What must follow a fault."""

    state: str
    """The safe state, in words."""
    within_s: float
    """From when the mission could know of the fault to that state, seconds of mission clock."""


AT_REST_S: Final = 4.0
"""A tick, and braking from cruise speed along the path that is being flown, with room."""
OVER_S: Final = 420.0
"""A mission that a fault leaves to itself is over within this time, seconds: its questions run out."""

_RESTS = Rule(state="at rest", within_s=AT_REST_S)
_HANDS_OFF = Rule(state="nothing is commanded any more, and the mission is over", within_s=1.0)
ENDS: Final = Rule(state="the mission is over, at rest", within_s=OVER_S)
"""What must follow a fault that the mission is not told of."""
_READABLE = Rule(state="all that was written is readable", within_s=0.0)

RULES: Final[dict[FaultKind, Rule]] = {
    FaultKind.CAMERA_GONE: _RESTS,
    FaultKind.POSITION_LOST: _RESTS,
    FaultKind.ORDERS: _RESTS,
    FaultKind.DEPTH_WRONG: Rule(state="out of what is not known free, or at rest", within_s=AT_REST_S),
    FaultKind.LINK_LOST: _HANDS_OFF,
    FaultKind.PILOT: _HANDS_OFF,
    FaultKind.MOTOR_LOST: _HANDS_OFF,
    FaultKind.KILLED: _READABLE,
    FaultKind.MEMORY_SHORT: Rule(state="the vehicle holds, and what was written is readable", within_s=OVER_S),
}
"""All others: the mission is over, at rest, within `OVER_S`."""


def rule_of(kind: FaultKind) -> Rule:
    """What must follow a fault of that kind."""
    return RULES.get(kind, ENDS)


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """One fault of one mission."""

    kind: FaultKind
    at_s: float
    """When it begins, seconds of the mission clock; of `FaultKind.KILLED` the event after which it comes."""
    lasts_s: float
    """How long it lasts, seconds; infinite: to the end."""
    size: float
    """How bad it is, 0 to 1; each kind makes its own of it."""

    def is_on(self, time_s: float) -> bool:
        """Whether it is on at that time of the mission clock."""
        return self.at_s <= time_s < self.at_s + self.lasts_s
