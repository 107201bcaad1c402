"""A real vehicle over MAVLink, behind the port `mintpilot.core.ports.Vehicle`."""

from __future__ import annotations

import multiprocessing
import time
from contextlib import suppress
from importlib.util import find_spec
from typing import cast

from mintpilot.core.errors import DeviceError, MissingPartError
from mintpilot.core.georeference import Georeference
from mintpilot.core.inputs import Link, LinkChanged, MotionEnded, VehicleInput
from mintpilot.core.motion import Motion
from mintpilot.core.ports import Vehicle
from mintpilot.core.trajectory import VehicleState
from mintpilot.vehicle.address import parse_address
from mintpilot.vehicle.checks import Check
from mintpilot.vehicle.control_state import AIRBORNE, Phase
from mintpilot.vehicle.envelope import SafetyEnvelope
from mintpilot.vehicle.link_process import LinkFailed, LinkSetup, Report, Snapshot, run_link
from mintpilot.vehicle.preparing import Prepared
from mintpilot.vehicle.signals import Brake, Changed, Ended, Settle, Start

PREPARE_S = 240.0
"""Longest preparation on the ground, seconds; every part of it has a shorter time-out of its own."""
FEED_S = 0.1
"""Between signs of life, seconds."""
DEAF_S = 1.5
"""A link process that says nothing for so long is gone, seconds: it speaks 20 times a second."""
LANDED_S = 150.0
"""Longest wait for the ground at the end, seconds."""


class MavlinkVehicle(Vehicle):
    """Flies through a process of its own, which holds the deadman: feed it by calling this.

    Args:
        address: ``mavlink://udpin:127.0.0.1:14540``.
        envelope: what the link must know to end a flight safely by itself.
        endurance_s: flight time of a full battery, seconds.
        georeference: where the map lies on the earth; None: the vehicle stands at the mission's start.
        accept_failsafes: fly although the autopilot's fail-safes are not as they should be; none is written.
        only_check: make all checks, and refuse nothing.

    Attributes:
        checks: what was looked at before the flight.

    Raises:
        InputError: the address is none.
        DeviceError: no port, no heartbeat, no position, or a check that does not pass; the message names it.
        MissingPartError: MAVSDK is not installed.
    """

    def __init__(
        self,
        address: str,
        envelope: SafetyEnvelope,
        *,
        endurance_s: float = float("inf"),
        georeference: Georeference | None = None,
        accept_failsafes: bool = False,
        only_check: bool = False,
    ) -> None:
        if find_spec("mavsdk") is None:
            raise MissingPartError("flying a real vehicle needs MAVSDK: pip install 'mintpilot[vehicle]'")
        setup = LinkSetup(
            address=parse_address(address),
            envelope=envelope,
            georeference=georeference,
            accept_failsafes=accept_failsafes,
        )
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=run_link, args=(theirs, setup), name="mintpilot-link")
        self._begun_s = time.monotonic()
        self._endurance_s = endurance_s
        self._snapshot: Snapshot | None = None
        self._events: list[VehicleInput] = []
        self._fed_s = self._heard_s = 0.0
        self._armed_s: float | None = None
        self._lost = ""
        self._process.start()
        theirs.close()
        try:
            self.checks = self._prepared(accept_failsafes, only_check)
        except BaseException:
            self.close()
            raise

    @property
    def pid(self) -> int | None:
        """Number of the link process."""
        return self._process.pid

    @property
    def airborne(self) -> bool:
        """Whether it flies, in our hands."""
        return self._snapshot is not None and self._snapshot.phase in AIRBORNE

    @property
    def battery(self) -> float | None:
        """Share of the battery that is left; None: not told."""
        return self._snapshot.seen.battery if self._snapshot is not None else None

    def tilt(self) -> tuple[float, float]:
        """Roll to the right and pitch nose up, as they were heard last, radians."""
        return self._snapshot.seen.tilt_rad if self._snapshot is not None else (0.0, 0.0)

    def readiness(self, longest_s: float = 30.0) -> tuple[Check, ...]:
        """Waits until the autopilot may be armed, and until its battery is told, at most so many seconds."""
        end_s = self._now() + longest_s
        while self._now() < end_s and (self._not_ready() or self.battery is None):
            self.advance(self._now() + 0.2)
        why = self._not_ready()
        how = "mend what the autopilot complains of; its ground station shows it in full"
        told = self._snapshot is not None and self._snapshot.seen.start is not Start.SET_POINTS
        value = why or ("yes" if told else "told only when its motors are to start: Hold needs a global position")
        return (Check(check="ready to arm", ok=not why, value=value, wanted="yes", how=how),)

    def _not_ready(self) -> str:
        if self._snapshot is None:
            return "nothing was heard of it"
        seen = self._snapshot.seen
        return f"{seen.not_ready} ({seen.status})" if seen.not_ready and seen.status else seen.not_ready

    def state(self) -> VehicleState:
        """Where it was heard to be last."""
        now = self._now()
        if self._snapshot is None:
            raise DeviceError("nothing was heard of the vehicle yet")
        seen = self._snapshot.seen
        if seen.battery is None:  # then its flight is timed
            left = self._endurance_s - (now - self._armed_s if self._armed_s is not None else 0.0)
        else:
            left = self._endurance_s * seen.battery
        return VehicleState(
            time_s=now,
            position_m=seen.position_m,
            velocity_mps=seen.velocity_mps,
            yaw_rad=seen.yaw_rad,
            endurance_left_s=left,
        )

    def command(self, motion: Motion) -> None:
        """See `Vehicle.command`. What cannot be begun ends as refused, with the reason."""
        self._say(motion)

    def brake(self) -> None:
        """See `Vehicle.brake`."""
        self._say(Brake())

    def hold(self) -> None:
        """Brakes and hovers; a pilot who has taken over is not disturbed."""
        with suppress(DeviceError):
            self._say(Brake())

    def advance(self, until_s: float) -> tuple[VehicleInput, ...]:
        """Waits in real time, and feeds the deadman meanwhile; see `Vehicle.advance`."""
        while True:
            self._hear()
            if self._events:
                events, self._events = tuple(self._events), []
                return events
            if self._lost:
                raise DeviceError(self._lost)
            self._feed()
            left_s = until_s - self._now()
            if left_s <= 0:
                return ()
            with suppress(OSError):
                self._pipe.poll(min(left_s, FEED_S))

    def close(self) -> None:
        """Ends on the ground where that is known free; else leaves it hovering, in the link process's care."""
        process = self._process
        if self.airborne and not self._lost:
            with suppress(DeviceError):
                self._say(Settle())
                end_s = self._now() + LANDED_S
                while self.airborne and not self._lost and self._now() < end_s:
                    self.advance(self._now() + 0.2)
        with suppress(OSError):
            self._pipe.close()
        if not self.airborne:
            process.join(5.0)
            if process.is_alive() and (self._snapshot is None or self._snapshot.phase is not Phase.RELEASED):
                process.kill()
                process.join()

    def _prepared(self, accept: bool, only_check: bool) -> tuple[Check, ...]:
        if not self._pipe.poll(PREPARE_S):
            raise DeviceError(f"the vehicle was not ready within {PREPARE_S:g} s; see mintpilot preflight")
        try:
            first = cast(Prepared | LinkFailed, self._pipe.recv())
        except (EOFError, OSError):
            raise DeviceError(f"the link process ended at once ({self._exit()})") from None
        if isinstance(first, LinkFailed):
            raise DeviceError(first.reason)
        bad = [check for check in first.checks if not check.ok and not (accept and check.failsafe)]
        if bad and not only_check:
            words = "; ".join(f"{c.check} is {c.value}, wanted {c.wanted}: {c.how}" for c in bad)
            raise DeviceError(f"not ready to fly: {words}")
        while self._snapshot is None and not self._lost:
            self._pipe.poll(DEAF_S)
            self._hear()
        return first.checks

    def _now(self) -> float:
        return time.monotonic() - self._begun_s

    def _say(self, command: Motion | Brake | Settle) -> None:
        if self._lost:
            raise DeviceError(self._lost)
        try:
            self._pipe.send(command)
        except OSError:
            self._lost = f"the link process is gone ({self._exit()}): the autopilot's fail-safe flies"
            raise DeviceError(self._lost) from None

    def _feed(self) -> None:
        now = self._now()
        if now - self._fed_s < FEED_S / 2:
            return
        self._fed_s = now
        with suppress(OSError):
            self._pipe.send(None)

    def _hear(self) -> None:
        """Takes in all that the link process has said."""
        try:
            while self._pipe.poll():
                self._take(cast(Report, self._pipe.recv()))
                self._heard_s = self._now()
        except (EOFError, OSError):
            self._lost = self._lost or f"the link process is gone ({self._exit()}): the autopilot's fail-safe flies"
            return
        silent_s = self._now() - self._heard_s
        if self._snapshot is not None and silent_s > DEAF_S:
            self._lost = self._lost or f"the link process has said nothing for {silent_s:.1f} s"

    def _take(self, report: Report) -> None:
        match report:
            case Snapshot():
                self._snapshot = report
                if report.seen.armed and self._armed_s is None:
                    self._armed_s = self._now()
            case Ended():
                self._events.append(self._motion_ended(report))
            case Changed(link=Link.TELEMETRY, up=False):
                self._lost = report.reason
            case Changed():
                now = self._now()
                self._events.append(LinkChanged(time_s=now, link=report.link, up=report.up, reason=report.reason))
            case _:
                pass

    def _motion_ended(self, report: Ended) -> MotionEnded:
        return MotionEnded(
            time_s=self._now(),
            motion=report.motion,
            end=report.end,
            vehicle=self.state(),
            log=report.log,
            reason=report.reason,
            by_hand=report.by_hand,
        )

    def _exit(self) -> str:
        self._process.join(0.2)
        return f"exit code {self._process.exitcode}"
