"""What the autopilot must do by itself when nobody is heard any more: parameters, set and read back.

A fail-safe does not fly through buildings. A straight-line return is set only outdoors and where its altitude was read
back above every mapped obstacle; everywhere else the vehicle holds, then lands.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from mintpilot.vehicle.checks import Check
from mintpilot.vehicle.envelope import SafetyEnvelope
from mintpilot.vehicle.modes import Autopilot

FENCE_MARGIN_M = 2.0
"""The fence lies so far outside the volume in which plans are made, metres: plans never meet it."""
RETURN_MARGIN_M = 2.0
"""A return must clear the highest mapped obstacle by this, metres."""
OUR_SYSTEM_ID = 245
"""Our own MAVLink system id. ArduPilot acts on the loss of one ground station only: this one."""

Get = Callable[[str], float | None]
"""Reads a parameter; None: the autopilot has none of that name."""
Set = Callable[[str, float, bool], str]
"""Writes a parameter (name, value, whether it is a whole number); the reason why not, or nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """One parameter that must have a value."""

    names: tuple[str, ...]
    """As firmware versions call it; the first that exists counts."""
    value: float
    why: str
    """What it does, for messages."""
    whole: bool = True
    also: tuple[float, ...] = ()
    """Other values that are as safe: they are left as they are."""
    optional: bool = False
    """Whether firmware without this parameter does not do the thing at all."""


def return_height_m(autopilot: Autopilot, get: Get) -> float | None:
    """The altitude of the autopilot's own return, metres above home, as it was read back; None: not known."""
    names = {Autopilot.PX4: (("RTL_RETURN_ALT", 1.0),), Autopilot.ARDUPILOT: (("RTL_ALT_M", 1.0), ("RTL_ALT", 0.01))}
    for name, unit_m in names[autopilot]:
        value = get(name)
        if value is not None:
            return value * unit_m
    return None


def may_return(envelope: SafetyEnvelope, height_m: float | None) -> bool:
    """Whether the autopilot's straight return clears everything mapped."""
    return height_m is not None and envelope.clears_everything(envelope.ground_m + height_m - RETURN_MARGIN_M)


def return_settings(autopilot: Autopilot, envelope: SafetyEnvelope, height_m: float) -> tuple[Setting, ...]:
    """What makes a return keep the altitude that was read back, from the first metre to home.

    Both autopilots return lower the nearer home is (a cone above it), and ArduPilot stays below its fence.
    """
    top_m = max(_top_m(envelope), math.ceil(height_m + RETURN_MARGIN_M + FENCE_MARGIN_M))
    if autopilot is Autopilot.PX4:
        return (
            Setting(names=("RTL_CONE_ANG",), value=0, why="a return is as high near home"),
            Setting(names=("RTL_TYPE",), value=0, why="a return is straight"),
            Setting(names=("GF_MAX_VER_DIST",), value=top_m, whole=False, why="height of the fence"),
        )
    return (
        Setting(names=("RTL_CONE_SLOPE",), value=0, whole=False, why="a return is as high near home"),
        Setting(names=("FENCE_ALT_MAX",), value=top_m, whole=False, why="height of the fence"),
    )


def settings_for(
    autopilot: Autopilot, envelope: SafetyEnvelope, *, returns: bool, polygon: bool = True
) -> tuple[Setting, ...]:
    """The parameters that a flight needs; with ``returns`` a loss is answered by a return, else by a landing.

    Args:
        autopilot: the firmware.
        envelope: what is known of the place.
        returns: whether its return clears everything mapped.
        polygon: whether a fence was uploaded; ArduPilot is not armed with the type of fence that it has not got.
    """
    settings = _px4(returns) if autopilot is Autopilot.PX4 else _ardupilot(returns, polygon)
    if returns:
        return settings
    height = "GF_MAX_VER_DIST" if autopilot is Autopilot.PX4 else "FENCE_ALT_MAX"
    return (*settings, Setting(names=(height,), value=_top_m(envelope), whole=False, why="height of the fence"))


def _px4(returns: bool) -> tuple[Setting, ...]:
    settings = (
        Setting(names=("COM_OF_LOSS_T",), value=1.0, whole=False, why="set-points count as lost after 1 s"),
        Setting(names=("COM_OBL_RC_ACT",), value=3 if returns else 4, why="loss of set-points"),
        Setting(names=("COM_FAIL_ACT_T",), value=5.0, whole=False, why="it holds for 5 s first"),
        Setting(names=("NAV_DLL_ACT",), value=2 if returns else 3, why="loss of the data link"),
        Setting(names=("COM_LOW_BAT_ACT",), value=3 if returns else 2, why="low battery"),
        Setting(names=("GF_ACTION",), value=2, why="leaving the fence: it holds"),
    )
    if returns:
        return settings
    return (
        *settings,
        Setting(names=("NAV_RCL_ACT",), value=3, also=(0, 1), why="loss of the remote control"),
        Setting(
            names=("COM_FLTT_LOW_ACT",), value=1, also=(0,), optional=True, why="little flight time left: it warns"
        ),
    )


def _ardupilot(returns: bool, polygon: bool) -> tuple[Setting, ...]:
    settings = (
        Setting(names=("MAV_GCS_SYSID", "SYSID_MYGCS"), value=OUR_SYSTEM_ID, why="whose heartbeats count"),
        Setting(names=("FS_GCS_ENABLE",), value=1 if returns else 5, why="loss of our heartbeats"),
        Setting(names=("FS_GCS_TIMEOUT",), value=5.0, whole=False, why="after 5 s of holding"),
        Setting(names=("GUID_TIMEOUT",), value=1.0, whole=False, why="velocities expire after 1 s"),
        Setting(names=("BATT_FS_LOW_ACT",), value=2 if returns else 1, why="low battery"),
        Setting(names=("BATT_FS_CRT_ACT",), value=1, why="critical battery"),
        Setting(names=("FS_EKF_ACTION",), value=1, also=(3,), why="loss of the position: it lands"),
        Setting(names=("FENCE_ACTION",), value=4, why="leaving the fence: it brakes, or lands"),
        Setting(names=("FENCE_TYPE",), value=5 if polygon else 1, why=f"height{' and polygon' if polygon else ''}"),
        Setting(names=("FENCE_ENABLE",), value=1, why="the fence counts"),
    )
    if returns:
        return settings
    return (
        *settings,
        Setting(names=("FS_THR_ENABLE",), value=3, also=(0,), why="loss of the remote control"),
        Setting(names=("FS_DR_ENABLE",), value=1, also=(0,), optional=True, why="dead reckoning: it lands"),
    )


def _top_m(envelope: SafetyEnvelope) -> float:
    """Height of the fence above the place of take-off, metres."""
    return float(round(envelope.volume.hi_m[2] - envelope.ground_m + FENCE_MARGIN_M))


def apply(settings: tuple[Setting, ...], get: Get, put: Set, *, only_read: bool) -> tuple[Check, ...]:
    """Writes what differs, reads everything back, and says how it is.

    Args:
        settings: what is wanted.
        get: reads a parameter.
        put: writes one.
        only_read: the fail-safes were accepted as they are: nothing is written.
    """
    return tuple(_applied(setting, get, put, only_read) for setting in settings)


def battery_threshold(get: Get) -> Check:
    """Whether ArduPilot's battery fail-safe has something to act on; which, depends on the battery."""
    volts, used = get("BATT_LOW_VOLT") or 0.0, get("BATT_LOW_MAH") or 0.0
    return Check(
        check="BATT_LOW_VOLT, BATT_LOW_MAH (when the battery is low)", ok=volts > 0 or used > 0, failsafe=True,
        value=f"{volts:g} V, {used:g} mAh", wanted="one of them above 0",
        how="set one of them for your battery, or accept it: --accept-failsafes",
    )  # fmt: skip


def _applied(setting: Setting, get: Get, put: Set, only_read: bool) -> Check:
    name, value = next(((n, v) for n in setting.names if (v := get(n)) is not None), (setting.names[0], None))
    good = (setting.value, *setting.also)
    refusal = ""
    if value is not None and not _among(value, good) and not only_read:
        refusal = put(name, setting.value, setting.whole)
        value = get(name)
    return Check(
        check=f"{name} ({setting.why})",
        ok=setting.optional if value is None else _among(value, good),
        value="the autopilot has no such parameter" if value is None else f"{value:g}",
        wanted=" or ".join(f"{v:g}" for v in good),
        how=f"set {name} to {setting.value:g}{f' ({refusal})' if refusal else ''}, or accept it: --accept-failsafes",
        failsafe=True,
    )


def _among(value: float, good: tuple[float, ...]) -> bool:
    return any(abs(value - one) <= 1e-4 * max(1.0, abs(one)) for one in good)
