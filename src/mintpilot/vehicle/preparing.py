"""What is done on the ground once an autopilot is heard: position, fail-safes, fence; each is a check."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from mintpilot.core.geometry import Vec3
from mintpilot.core.georeference import GeodeticPoint, Georeference
from mintpilot.vehicle import failsafes
from mintpilot.vehicle.checks import Check
from mintpilot.vehicle.envelope import SafetyEnvelope
from mintpilot.vehicle.local_frame import LocalFrame, frame_at
from mintpilot.vehicle.mavsdk_link import MavsdkLink
from mintpilot.vehicle.modes import Autopilot
from mintpilot.vehicle.signals import Start
from mintpilot.vehicle.telemetry import Telemetry

POSITION_S = 90.0
"""Longest wait for the position, seconds: ArduPilot takes half a minute from its start."""
ORIGIN_TRIES = 4
"""So often the place of the local origin on the earth is asked for, and waited for 1 s each."""
PAD_M = 1.0
"""So far from the mission's start the vehicle may stand by its own global position, metres."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Prepared:
    """How the vehicle was found, and left."""

    autopilot: Autopilot
    checks: tuple[Check, ...]
    return_clear: bool
    """Whether the autopilot's own return clears everything mapped."""


def prepare(
    link: MavsdkLink,
    envelope: SafetyEnvelope,
    *,
    heading_rad: float,
    georeference: Georeference | None,
    accept: bool,
    sleep: Callable[[float], None] = time.sleep,
) -> Prepared:
    """Waits for the vehicle to know where it is, sets fail-safes and fence, and reads them back.

    Args:
        link: the autopilot.
        envelope: what is known of the place.
        heading_rad: compass direction of the map's y axis where there is no georeference.
        georeference: where the map lies on the earth; None: not known.
        accept: the fail-safes are accepted as they are: none is written.
        sleep: waits that many seconds.
    """
    heard = link.telemetry
    _wait_for_position(link, georeference, sleep)
    autopilot = heard.autopilot or Autopilot.PX4
    checks = [_link(autopilot), _sensors(heard), _position(heard)]
    frame = frame_of(heard, envelope, heading_rad, georeference)
    if georeference is not None:
        checks += [_global_position(heard), _pad(heard, frame, envelope)]
    fence = _fence(link, frame, envelope, accept=accept)  # ArduPilot is not armed with a fence that it has not got
    checks.append(fence)
    returns = _set_up_return(link, autopilot, envelope, checks, accept=accept)
    wanted = failsafes.settings_for(autopilot, envelope, returns=returns, polygon=fence.ok and heard.origin is not None)
    checks += failsafes.apply(wanted, link.get_parameter, link.set_parameter, only_read=accept)
    if autopilot is Autopilot.ARDUPILOT:
        checks.append(failsafes.battery_threshold(link.get_parameter))
    if heard.start is not Start.SET_POINTS:
        checks.append(_mode(link.stand_by()))
    return Prepared(autopilot=autopilot, checks=tuple(checks), return_clear=returns)


def _wait_for_position(link: MavsdkLink, georeference: Georeference | None, sleep: Callable[[float], None]) -> None:
    """All that is waited for has one time-out together; the place of the origin, a short one of its own."""
    heard, placed = link.telemetry, georeference is not None
    _wait(
        lambda: heard.health.sensors and heard.knows_position and (not placed or heard.knows_global), POSITION_S, sleep
    )
    for _ in range(ORIGIN_TRIES):
        if heard.origin is not None:
            return
        link.request_origin()
        _wait(lambda: heard.origin is not None, 1.0, sleep)


def _set_up_return(
    link: MavsdkLink, autopilot: Autopilot, envelope: SafetyEnvelope, checks: list[Check], *, accept: bool
) -> bool:
    """Whether the autopilot's own return clears everything mapped; else its fail-safes land."""
    height_m = failsafes.return_height_m(autopilot, link.get_parameter)
    returns = failsafes.may_return(envelope, height_m) and link.telemetry.health.global_position
    if returns and height_m is not None:
        wanted = failsafes.return_settings(autopilot, envelope, height_m)
        found = failsafes.apply(wanted, link.get_parameter, link.set_parameter, only_read=accept)
        returns = all(check.ok for check in found)
        checks += found if returns else ()
    checks.append(_return(envelope, height_m, returns))
    return returns


def frame_of(
    heard: Telemetry, envelope: SafetyEnvelope, heading_rad: float, georeference: Georeference | None
) -> LocalFrame:
    """The frame of a vehicle that stands on the ground.

    Without a georeference it stands at the mission's start; with one, the autopilot's origin lies where the map says,
    and only the height is that of the ground.
    """
    ned = heard.ned_m or (0.0, 0.0, 0.0)
    x, y, _ = envelope.hover_m
    standing = frame_at((x, y, envelope.ground_m), ned, heading_rad)
    if georeference is None or heard.origin is None:
        return standing
    latitude, longitude, altitude = heard.origin
    place = georeference.local(GeodeticPoint(latitude_deg=latitude, longitude_deg=longitude, altitude_m=altitude))
    return LocalFrame(
        origin_m=(place[0], place[1], standing.origin_m[2]),
        heading_rad=georeference.heading_rad,
    )


def fence_corners(
    frame: LocalFrame, envelope: SafetyEnvelope, origin: tuple[float, float, float]
) -> list[tuple[float, float]]:
    """Latitude and longitude of the fence's corners: the volume's outline, `FENCE_MARGIN_M` further out."""
    from pymap3d import ned2geodetic

    (x0, y0, _), (x1, y1, _), margin = envelope.volume.lo_m, envelope.volume.hi_m, failsafes.FENCE_MARGIN_M
    outline: list[Vec3] = [
        (x0 - margin, y0 - margin, 0.0),
        (x1 + margin, y0 - margin, 0.0),
        (x1 + margin, y1 + margin, 0.0),
        (x0 - margin, y1 + margin, 0.0),
    ]
    corners = []
    for place in outline:
        north, east, _ = frame.to_ned(place)
        latitude, longitude, _ = ned2geodetic(north, east, 0.0, *origin)
        corners.append((float(latitude), float(longitude)))
    return corners


def _wait(until: Callable[[], bool], longest_s: float, sleep: Callable[[float], None]) -> None:
    for _ in range(math.ceil(longest_s / 0.1)):
        if until():
            return
        sleep(0.1)


def _link(autopilot: Autopilot) -> Check:
    return Check(check="link", ok=True, value=f"{autopilot.value} is heard", wanted="an autopilot is heard")


def _sensors(heard: Telemetry) -> Check:
    ok = heard.health.sensors
    value = "well" if ok else "not told to be well"
    how = "calibrate them; the ground station shows which one is not"
    return Check(check="sensors", ok=ok, value=value, wanted="gyroscope and accelerometer are well", how=how)


def _mode(refusal: str) -> Check:
    how = "switch it to Hold (PX4) or GUIDED (ArduPilot), and see what it complains of"
    return Check(
        check="mode in which it is armed", ok=not refusal, value=refusal or "Hold or GUIDED", wanted="taken", how=how
    )


def _position(heard: Telemetry) -> Check:
    ok = heard.knows_position
    value = "known" if ok else f"none within {POSITION_S:g} s"
    how = "wait for GPS or start the position source (VIO, motion capture, optical flow); see the ground station"
    return Check(check="local position", ok=ok, value=value, wanted="known", how=how)


def _global_position(heard: Telemetry) -> Check:
    ok = heard.knows_global and heard.origin is not None
    how = "wait for GPS and for the home position: the mission has a georeference"
    return Check(check="global position and home", ok=ok, value="known" if ok else "not known", wanted="known", how=how)


def _pad(heard: Telemetry, frame: LocalFrame, envelope: SafetyEnvelope) -> Check:
    x, y, _ = frame.from_ned(heard.ned_m or (0.0, 0.0, 0.0))
    off_m = math.hypot(x - envelope.hover_m[0], y - envelope.hover_m[1])
    how = "carry it to the mission's start, or correct the start or the georeference in the mission file"
    return Check(
        check="place of take-off", ok=off_m <= PAD_M, value=f"{off_m:.1f} m from the mission's start",
        wanted=f"at most {PAD_M:g} m", how=how,
    )  # fmt: skip


def _return(envelope: SafetyEnvelope, height_m: float | None, returns: bool) -> Check:
    value = "not told" if height_m is None else f"{height_m:g} m above home"
    tallest = envelope.tallest_m
    if returns:
        wanted = "above everything mapped: fail-safes return"
    elif not envelope.outdoors:
        wanted = "of no use without a georeference: fail-safes hold, then land"
    elif tallest is None:
        wanted = "the map does not say how high things are: fail-safes hold, then land"
    else:
        least = tallest - envelope.ground_m + failsafes.RETURN_MARGIN_M
        wanted = f"above {least:.1f} m for a return: fail-safes hold, then land"
    return Check(check="return altitude", ok=True, value=value, wanted=wanted)


def _fence(link: MavsdkLink, frame: LocalFrame, envelope: SafetyEnvelope, *, accept: bool) -> Check:
    origin = link.telemetry.origin
    wanted = f"the mission's volume and {failsafes.FENCE_MARGIN_M:g} m"
    if origin is None:
        value = "none: no global position; the mission's own planner keeps inside the volume"
        return Check(check="geofence", ok=not envelope.outdoors, value=value, wanted=wanted, failsafe=True)
    if accept:
        return Check(check="geofence", ok=False, value="as it is", wanted=wanted, failsafe=True)
    refusal = link.upload_fence(fence_corners(frame, envelope, origin))
    return Check(
        check="geofence", ok=not refusal, value=refusal or "uploaded", wanted=wanted, failsafe=True,
        how="make room for a fence on the autopilot, or accept it with --accept-failsafes",
    )  # fmt: skip
