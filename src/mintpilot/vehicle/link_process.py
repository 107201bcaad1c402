"""The process that alone owns the MAVLink connection. It flies on, and ends the flight, whatever the loop does."""

from __future__ import annotations

import gc
import os
import queue
import signal
import threading
import time
import traceback
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import TypeAlias

from mintpilot.core.errors import MintPilotError
from mintpilot.core.georeference import Georeference
from mintpilot.core.inputs import Link
from mintpilot.vehicle.address import Address
from mintpilot.vehicle.channel import Channel, End
from mintpilot.vehicle.control import link_step
from mintpilot.vehicle.control_state import AIRBORNE, ControlState, Phase
from mintpilot.vehicle.course import SetPoint
from mintpilot.vehicle.envelope import SafetyEnvelope
from mintpilot.vehicle.local_frame import LocalFrame
from mintpilot.vehicle.mavsdk_link import MavsdkLink
from mintpilot.vehicle.preparing import Prepared, frame_of, prepare
from mintpilot.vehicle.signals import Act, Action, Changed, Command, Ended, Fed, LinkEvent, Seen, Tick, Told

TICK_S = 0.05
"""Between set-points, seconds: 20 a second."""
MOST_SAID = 100
"""So much of the loop is taken in between two ticks."""
CLOSING_S = 2.0
"""Longest wait for the library at the end, seconds."""
LOST_S = 2.0
"""An autopilot of which nothing was heard for so long is not waited for, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinkSetup:
    """What the process is started with."""

    address: Address
    envelope: SafetyEnvelope
    georeference: Georeference | None = None
    accept_failsafes: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkFailed:
    """The process cannot fly: it has ended."""

    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Snapshot:
    """How it is, sent with every tick."""

    time_s: float
    seen: Seen
    phase: Phase


Feed: TypeAlias = Command | None
"""What the loop sends: a command, or None for a sign of life."""
Report: TypeAlias = Prepared | LinkFailed | Snapshot | Ended | Changed
"""What the process sends."""


def run_link(pipe: Connection, setup: LinkSetup) -> None:
    """The process. It ends when its pipe is closed and the vehicle is on the ground, or lost."""
    _stand_alone()
    try:
        link = MavsdkLink(setup.address)
    except MintPilotError as error:
        pipe.send(LinkFailed(reason=str(error)))
        return
    try:
        prepared = prepare(
            link,
            setup.envelope,
            heading_rad=setup.address.heading_rad,
            georeference=setup.georeference,
            accept=setup.accept_failsafes,
        )
        _LinkLoop(pipe, link, setup, prepared).run()
    except Exception:
        traceback.print_exc()
    _close(link).join(CLOSING_S)
    os._exit(0)  # a command that waits for an autopilot that is gone must not keep the process


def _close(link: MavsdkLink) -> threading.Thread:
    """Ends the connection beside the loop: the library may wait for commands that are under way."""
    closing = threading.Thread(target=link.close, daemon=True)
    closing.start()
    return closing


def _stand_alone() -> None:
    """Ctrl-C and a closed terminal are for the loop to hear; this process must outlive it."""
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_IGN)
    with suppress(OSError):
        os.setsid()
    with suppress(OSError):
        os.nice(-10)
    with suppress(OSError, AttributeError):  # where that is allowed: whenever it wants a core, it gets one
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))


class _LinkLoop:
    def __init__(self, pipe: Connection, link: MavsdkLink, setup: LinkSetup, prepared: Prepared) -> None:
        self._channel: Channel[Feed, Report] = Channel(pipe)
        self._link, self._setup = link, setup
        now = time.monotonic()
        self._state = ControlState(
            envelope=setup.envelope, return_clear=prepared.return_clear, now_s=now, ticked_s=now, fed_s=now, since_s=now
        )
        self._frame = LocalFrame()
        self._channel.tell(prepared)

    def run(self) -> None:
        """Ticks at a fixed rate; what the loop says is taken in between."""
        gc.collect()
        gc.freeze()
        due = time.monotonic()
        while not self._channel.gone or self._has_work():
            due = max(due + TICK_S, time.monotonic() - TICK_S)
            self._listen(due)
            for answer in self._link.answers():
                self._step(answer)
            self._step(Tick(time_s=time.monotonic(), seen=self._seen()))
            self._link.keep_rates()
            self._link.keep_beating()
            snapshot = Snapshot(time_s=time.monotonic(), seen=self._state.seen, phase=self._state.phase)
            self._channel.show(snapshot)

    def _has_work(self) -> bool:
        """Whether heartbeats must go on after the loop has gone.

        While a pilot flies they must: their end would be a fail-safe of its own. Where nothing is heard of the
        autopilot they must not: their end is what its fail-safe waits for.
        """
        state = self._state
        lost = Link.TELEMETRY in state.down or state.now_s - state.seen.message_s > LOST_S
        return state.phase in AIRBORNE or (state.phase is Phase.RELEASED and state.seen.armed and not lost)

    def _listen(self, until_s: float) -> None:
        """Takes in what the loop says, until that moment; what is there already also where the moment is past."""
        for _ in range(MOST_SAID):
            try:
                said = self._channel.get(max(until_s - time.monotonic(), 0.0))
            except queue.Empty:
                return
            now = time.monotonic()
            if said is None:
                self._step(Fed(time_s=now))
            elif not isinstance(said, End):
                self._step(Told(time_s=now, command=said))

    def _seen(self) -> Seen:
        heard, setup = self._link.telemetry, self._setup
        state = self._state
        if state.phase is Phase.GROUND or (state.phase is Phase.ARMING and state.asked is not Action.TAKE_OFF):
            # It stands where it stands; its estimate wanders, and ArduPilot sets its height anew when it is armed.
            self._frame = frame_of(heard, setup.envelope, setup.address.heading_rad, setup.georeference)
        return heard.seen(self._frame, georeferenced=setup.georeference is not None)

    def _step(self, event: LinkEvent) -> None:
        self._state, orders = link_step(self._state, event)
        for order in orders:
            match order:
                case SetPoint():
                    self._send(order)
                case Act():
                    self._link.act(order)
                case Changed(link=Link.TELEMETRY, up=False):
                    self._channel.tell(order)
                    _close(self._link)  # no heartbeats any more: the autopilot's fail-safe waits for that
                case Ended() | Changed():
                    self._channel.tell(order)

    def _send(self, point: SetPoint) -> None:
        frame = self._frame
        ned, velocity = frame.to_ned(point.position_m), frame.velocity_to_ned(point.velocity_mps)
        self._link.set_point(ned, velocity, frame.yaw_to_ned(point.yaw_rad))
