"""The double's autopilot: modes, arming, take-off, landing, and what it does when nobody is heard any more."""

from __future__ import annotations

import math
from enum import StrEnum

from mintpilot.conformance.vehicle_double.body import CLIMB_MPS, SINK_MPS, Body, Ned, Target
from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.fence import Fence
from mintpilot.conformance.vehicle_double.parameters import Flavour, Parameters

LANDED_S = 1.0
"""It stops its motors after having stood for so long."""
BEFORE_OFFBOARD_S = 1.0
"""PX4 follows set-points only if they have come for so long ..."""
BETWEEN_POINTS_S = 0.5
"""... with no longer pause than this."""
IDLE_S = 10.0
"""Motors that run on the ground for so long without a take-off are stopped."""
LOW, CRITICAL = 0.15, 0.07
"""Shares of the battery at which its fail-safes act."""
BLIND_S = 2.0
"""Without a position it lands after this time."""
JUMP_M = 4.0


class DoubleMode(StrEnum):
    """Its modes."""

    HOLD = "hold"
    TAKE_OFF = "take-off"
    FOLLOW = "follow"
    """OFFBOARD or GUIDED."""
    RETURN = "return"
    LAND = "land"
    PILOT = "pilot"


class DoubleAutopilot:
    """State and rules. Time is given from outside, seconds, ascending.

    Attributes:
        faults: those that are on.
        texts: warnings in words, to be sent.
    """

    def __init__(self, flavour: Flavour, *, endurance_s: float = 1200.0, position_after_s: float = 0.3) -> None:
        self.flavour = flavour
        self.parameters = Parameters(flavour)
        self.body = Body()
        self.mode = self._standing = DoubleMode.PILOT
        self.armed = False
        self.faults: frozenset[Fault] = frozenset()
        self.texts: list[str] = []
        self.gripper = "open"
        self.battery = 1.0
        self.jump_m = 0.0
        self.fence = Fence()
        self._endurance_s, self._position_after_s = endurance_s, position_after_s
        self._now_s = 0.0
        self._point: Target | None = None
        self._point_s = self._gcs_s = -math.inf
        self._streaming_s = 0.0
        self._armed_s = 0.0
        self._climbs = False
        self._target: Target | None = None
        self._stood_s: float | None = None
        self._blind_since_s: float | None = None
        self._failsafe: tuple[float, DoubleMode] | None = None

    @property
    def knows_position(self) -> bool:
        """Whether it knows where it is."""
        return Fault.POSITION_LOST not in self.faults and self._now_s >= self._position_after_s

    @property
    def knows_global(self) -> bool:
        """Whether it knows where it is on the earth."""
        return self.knows_position and Fault.NO_GPS not in self.faults

    @property
    def may_arm(self) -> bool:
        """Whether its checks before arming pass, as it tells them: those of the mode that it is in."""
        return not self._mode_refusal() and not (self.flavour is Flavour.PX4 and self._px4_refusal())

    @property
    def airborne(self) -> bool:
        """Whether it is off the ground."""
        return not self.body.on_ground

    def switch_on(self, fault: Fault) -> None:
        """A fault begins."""
        self.faults |= {fault}
        match fault:
            case Fault.POSITION_JUMP:
                self.jump_m = JUMP_M
            case Fault.PILOT:
                self._enter(DoubleMode.PILOT)
            case Fault.BATTERY:
                self.battery = min(self.battery, 0.1)
            case _:
                pass

    def arm(self) -> str:
        """Starts the motors; the reason why not, or nothing."""
        if Fault.REFUSE_ARM in self.faults:
            return "Arming denied: compass variance"
        if not self.knows_position:
            return "Arming denied: no position"
        refusal = self._mode_refusal()
        if refusal:
            return refusal
        refusal = self._px4_refusal() if self.flavour is Flavour.PX4 else self._ardupilot_refusal()
        if refusal:
            return refusal
        self.armed, self._stood_s, self._armed_s, self._climbs = True, None, self._now_s, False
        return ""

    def _mode_refusal(self) -> str:
        """Why it may not be armed in the mode that it is in. ArduPilot's pilot modes ask for no position."""
        if self.mode in (DoubleMode.LAND, DoubleMode.RETURN):
            return f"Mode {self.mode.value} not armable"
        if self.flavour is Flavour.ARDUPILOT:
            return "" if self.knows_position or self.mode is DoubleMode.PILOT else "Need Position Estimate"
        needs = {
            DoubleMode.PILOT: "No manual control input",
            DoubleMode.FOLLOW: "" if self._streams() else "No offboard signal",
            DoubleMode.HOLD: "" if self.knows_global else "No valid global position estimate",
        }
        return needs.get(self.mode, "")

    def _px4_refusal(self) -> str:
        """A loss of the data link that is acted on must not be there from the beginning."""
        get = self.parameters
        lost = self._now_s - self._gcs_s > get["COM_DL_LOSS_T"]
        return "Preflight Fail: No connection to the GCS" if get["NAV_DLL_ACT"] > 0 and lost else ""

    def _ardupilot_refusal(self) -> str:
        """A fence that counts must be there, and around it."""
        get = self.parameters
        if not get["FENCE_ENABLE"]:
            return ""
        if int(get["FENCE_TYPE"]) & 4 and not self.fence.corners_m:
            return "Arm: Polygon fence not loaded"
        return "" if self.fence.holds(self.body.ned_m, self._top_m) else "Arm: vehicle outside fence"

    @property
    def _top_m(self) -> float:
        """Height of the fence, metres; 0: none counts."""
        get = self.parameters
        if self.flavour is Flavour.PX4:
            return get["GF_MAX_VER_DIST"] if get["GF_ACTION"] > 0 else 0.0
        return get["FENCE_ALT_MAX"] if get["FENCE_ENABLE"] and int(get["FENCE_TYPE"]) & 1 else 0.0

    def disarm(self) -> str:
        """Stops the motors; the reason why not, or nothing."""
        if self.airborne:
            return "Disarming denied: not landed"
        self._stop_motors()
        return ""

    def _stop_motors(self) -> None:
        """PX4 goes back to the last mode in which it may be armed; ArduPilot stays in LAND."""
        self.armed = False
        if self.flavour is Flavour.PX4:
            self.mode = self._standing

    def take_off(self, height_m: float) -> str:
        """Climbs; the reason why not, or nothing."""
        ready = self.flavour is Flavour.PX4 or self.mode is DoubleMode.FOLLOW
        if not self.armed or not ready or Fault.PILOT in self.faults:
            return "Takeoff denied"
        if self.flavour is Flavour.PX4:
            self._enter(DoubleMode.TAKE_OFF)
            self._standing = DoubleMode.TAKE_OFF
        n, e, _ = self.body.ned_m
        self._point, self._point_s, self._climbs = None, -math.inf, True
        self._target = Target(ned_m=(n, e, -height_m), fastest_mps=CLIMB_MPS)
        return ""

    def change_mode(self, mode: DoubleMode) -> str:
        """Goes into a mode; the reason why not, or nothing."""
        px4 = self.flavour is Flavour.PX4
        if mode is DoubleMode.FOLLOW and px4 and not self._streams():
            return "no offboard signal"
        if mode in (DoubleMode.HOLD, DoubleMode.RETURN) and px4 and self.armed and not self.knows_global:
            return "no global position"
        if Fault.PILOT in self.faults and mode is not DoubleMode.PILOT:
            return "the pilot's switch decides"
        self._failsafe = None
        self._enter(mode)
        if mode not in (DoubleMode.LAND, DoubleMode.RETURN):
            self._standing = mode
        return ""

    def _streams(self) -> bool:
        """Whether set-points come, and have come for long enough."""
        fresh = self._now_s - self._point_s <= BETWEEN_POINTS_S
        return fresh and self._point_s - self._streaming_s >= BEFORE_OFFBOARD_S

    def set_point(self, point: Target) -> None:
        """A set-point came. ArduPilot takes none outside of its fence, nor before a take-off."""
        if self.flavour is Flavour.ARDUPILOT:
            fenced = self.parameters["FENCE_ENABLE"] and not self.fence.holds(point.ned_m, self._top_m)
            if self.mode is not DoubleMode.FOLLOW or not self._climbs or fenced:
                return
        if self._now_s - self._point_s > BETWEEN_POINTS_S:
            self._streaming_s = self._now_s
        self._point, self._point_s = point, self._now_s

    def heard_ground(self, system_id: int, *, station: bool = True) -> None:
        """A heartbeat came: PX4 counts those of ground stations, ArduPilot those of one system."""
        counts = station if self.flavour is Flavour.PX4 else system_id == int(self.parameters["MAV_GCS_SYSID"])
        if counts:
            self._gcs_s = self._now_s

    def step(self, now_s: float) -> None:
        """Lets time pass."""
        elapsed_s, self._now_s = now_s - self._now_s, now_s
        if self.armed:
            drain = 0.02 if Fault.BATTERY in self.faults else 1 / self._endurance_s
            self.battery = max(self.battery - drain * elapsed_s, 0.0)
            self._fail_safe()
            self.body.follow(self._wanted(), elapsed_s)
            self._land_when_down()
        else:
            self.body.stand()

    def reported_ned(self) -> Ned:
        """Where it says it is."""
        n, e, d = self.body.ned_m
        return (n + self.jump_m, e, d)

    def _enter(self, mode: DoubleMode) -> None:
        self.mode = mode
        self._target = Target(ned_m=self.body.ned_m) if mode is not DoubleMode.FOLLOW or self.airborne else None

    def _wanted(self) -> Target:
        """Where it goes now."""
        n, e, d = self.body.ned_m
        here = self._target or Target(ned_m=self.body.ned_m)
        match self.mode:
            case DoubleMode.FOLLOW if self._point is not None:
                return self._followed(self._point)
            case DoubleMode.LAND:
                return Target(ned_m=(here.ned_m[0], here.ned_m[1], d + 1.0), fastest_mps=SINK_MPS)
            case DoubleMode.RETURN:
                return self._returning(n, e, d)
            case DoubleMode.TAKE_OFF if math.dist((n, e, d), here.ned_m) < 0.1:
                self._enter(DoubleMode.HOLD)
        return here

    def _followed(self, point: Target) -> Target:
        """The set-point; on ArduPilot without its velocity once that has expired. A position never does."""
        if self.flavour is Flavour.ARDUPILOT and self._now_s - self._point_s > self.parameters["GUID_TIMEOUT"]:
            return Target(ned_m=point.ned_m, heading_rad=point.heading_rad)
        return point

    def _returning(self, n: float, e: float, d: float) -> Target:
        height = self.parameters["RTL_RETURN_ALT" if self.flavour is Flavour.PX4 else "RTL_ALT_M"]
        if math.hypot(n, e) > 0.5:
            return Target(ned_m=(n, e, -height)) if d > -height + 0.3 else Target(ned_m=(0.0, 0.0, d))
        self._enter(DoubleMode.LAND)
        return Target(ned_m=(n, e, d))

    def _land_when_down(self) -> None:
        if not self.airborne and not self._climbs and self._now_s - self._armed_s > IDLE_S:
            self._stop_motors()
        if self.airborne or self.mode is not DoubleMode.LAND:
            self._stood_s = None
            return
        self._stood_s = self._now_s if self._stood_s is None else self._stood_s
        if self._now_s - self._stood_s >= LANDED_S:
            self._stop_motors()

    def _fail_safe(self) -> None:
        """Nobody is heard, the battery is low, or it does not know where it is."""
        if not self.airborne or self.mode in (DoubleMode.LAND, DoubleMode.PILOT):
            return
        if self._failsafe is not None:
            at_s, action = self._failsafe
            if self._now_s >= at_s:
                self._failsafe = None
                self._act(action, "Failsafe activated")
            return
        if not self.knows_position:
            since = self._blind_since_s = self._now_s if self._blind_since_s is None else self._blind_since_s
            if self._now_s - since > BLIND_S:
                self._act(DoubleMode.LAND, "Failsafe: position lost, landing")
            return
        fenced = self.parameters["GF_ACTION" if self.flavour is Flavour.PX4 else "FENCE_ENABLE"] > 0
        if fenced and self.mode is DoubleMode.FOLLOW and not self.fence.holds(self.body.ned_m, self._top_m):
            self._act(DoubleMode.HOLD, "Geofence breached")
            return
        self._px4_fail_safe() if self.flavour is Flavour.PX4 else self._ardupilot_fail_safe()

    def _px4_fail_safe(self) -> None:
        get = self.parameters
        lost = {0: DoubleMode.PILOT, 3: DoubleMode.RETURN, 4: DoubleMode.LAND, 5: DoubleMode.HOLD}
        if self.mode is DoubleMode.FOLLOW and self._now_s - self._point_s > get["COM_OF_LOSS_T"]:
            self._hold_then(lost.get(int(get["COM_OBL_RC_ACT"]), DoubleMode.HOLD), "Failsafe: no offboard signal")
        elif self._now_s - self._gcs_s > get["COM_DL_LOSS_T"] and get["NAV_DLL_ACT"] >= 1:
            acts = {1: DoubleMode.HOLD, 2: DoubleMode.RETURN, 3: DoubleMode.LAND}
            self._hold_then(acts.get(int(get["NAV_DLL_ACT"]), DoubleMode.HOLD), "Failsafe: data link lost")
        elif self.battery <= CRITICAL and get["COM_LOW_BAT_ACT"] >= 2 and self.mode is not DoubleMode.RETURN:
            self._act(
                DoubleMode.LAND if get["COM_LOW_BAT_ACT"] == 2 else DoubleMode.RETURN, "Critical battery: failsafe"
            )

    def _ardupilot_fail_safe(self) -> None:
        get = self.parameters
        acts = {1: DoubleMode.RETURN, 5: DoubleMode.LAND}
        enabled = get["FS_GCS_ENABLE"] and math.isfinite(self._gcs_s)
        if enabled and self._now_s - self._gcs_s > get["FS_GCS_TIMEOUT"]:
            self._act(acts.get(int(get["FS_GCS_ENABLE"]), DoubleMode.LAND), "GCS failsafe")
        elif self.battery <= LOW and get["BATT_FS_LOW_ACT"] >= 1 and self.mode is not DoubleMode.RETURN:
            self._act(DoubleMode.LAND if get["BATT_FS_LOW_ACT"] == 1 else DoubleMode.RETURN, "Battery failsafe")

    def _hold_then(self, action: DoubleMode, why: str) -> None:
        """PX4 holds for a while before it acts; its default, Position mode, takes over at once."""
        self.texts.append(why)
        if action is DoubleMode.PILOT:
            self._enter(DoubleMode.PILOT)
            return
        if not self.knows_global:  # Hold needs one, and so does a return: it lands at once
            self._enter(DoubleMode.LAND)
            return
        self._enter(DoubleMode.HOLD)
        self._failsafe = (self._now_s + self.parameters["COM_FAIL_ACT_T"], action)

    def _act(self, mode: DoubleMode, why: str) -> None:
        self.texts.append(why)
        self._enter(mode)
