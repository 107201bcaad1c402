"""Both vehicle doubles over MAVLink and UDP, in real time: the link, the packets, the autopilot, the pilot."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Final

from mintpilot.assembly.components import Choices, VehicleChoice
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World
from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.faulty_source import FaultySource
from mintpilot.conformance.faults.faulty_vehicle import FaultyVehicle
from mintpilot.conformance.faults.kinds import Fault, FaultKind
from mintpilot.conformance.faults.ledger import Ledger
from mintpilot.conformance.faults.stage import Stage, people
from mintpilot.conformance.vehicle_double.faults import Fault as DoubleFault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.serving import DoubleSetup, DoubleState, VehicleDouble, free_port
from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Vec3
from mintpilot.core.inputs import Link, LinkChanged, VehicleInput
from mintpilot.core.motion import Motion
from mintpilot.core.ports import Vehicle
from mintpilot.core.trajectory import VehicleState
from mintpilot.mission.components import MissionComponents
from mintpilot.simulation.reference import LANDED_M

LOOK_S: Final = 0.05
"""The double is looked at this often, seconds."""
DOWN_S: Final = 60.0
"""After a mission the double is on the ground, or in other hands, within this time, seconds."""
STILL_MPS: Final = 0.2
_SWITCHED: Final[dict[FaultKind, tuple[DoubleFault, ...]]] = {
    FaultKind.LINK_LOST: (DoubleFault.SILENCE, DoubleFault.HEARTBEAT),
    FaultKind.PILOT: (DoubleFault.PILOT,),
    FaultKind.POSITION_LOST: (DoubleFault.POSITION_LOST,),
    FaultKind.POSE_JUMPS: (DoubleFault.POSITION_JUMP,),
    FaultKind.LATE: (DoubleFault.DELAY,),
    FaultKind.DOUBLED: (DoubleFault.DUPLICATE,),
    FaultKind.REORDERED: (DoubleFault.REORDER,),
    FaultKind.CORRUPT: (DoubleFault.CORRUPT,),
    FaultKind.BATTERY: (DoubleFault.BATTERY,),
    FaultKind.REFUSALS: (DoubleFault.REFUSE_ARM, DoubleFault.NO_GRIPPER, DoubleFault.SLOW_STREAMS),
}
"""What the double does for each kind; the fault's size chooses. They last to the end."""
_TOLD: Final = {
    Link.TELEMETRY: FaultKind.LINK_LOST,
    Link.CONTROL: FaultKind.PILOT,
    Link.POSITION: FaultKind.POSITION_LOST,
}


@contextmanager
def on_doubles(draw: Draw, world: World, ledger: Ledger, talk: Talk) -> Iterator[Stage]:  # noqa: ARG001
    """A double of either autopilot, in turn, in a process of its own; the link that flies it is the real one."""
    flavours = list(Flavour)
    setup = DoubleSetup(
        flavour=flavours[draw.number % len(flavours)],
        port=free_port(),
        scene=world.scene,
        rules=world.rules,
        seed=draw.number,
    )
    ours = replace(draw, faults=tuple(fault for fault in draw.faults if fault.kind not in _SWITCHED))
    ledger.simulated, ledger.on_the_wall = False, True
    with VehicleDouble(setup) as double:
        watched = Watched(double, world, draw, ledger)

        def beset(made: MissionComponents) -> MissionComponents:
            flown = FaultyVehicle(Told(made.vehicle, watched, ledger), ours, ledger, truth=watched.position_m)
            return replace(made, vehicle=flown, map_source=FaultySource(made.map_source, ours, ledger))

        yield Stage(
            choices=Choices(vehicle=VehicleChoice.MAVLINK, address=f"mavlink://udpin:127.0.0.1:{setup.port}"),
            operators=people(ours, world, ledger),
            beset=beset,
        )
        watched.follow_down()


class Watched:
    """The double, looked at from outside; switches its faults on when they are due.

    Args:
        double: the double.
        world: what it flies in.
        draw: which faults come.
        ledger: is told how it ends.
    """

    def __init__(self, double: VehicleDouble, world: World, draw: Draw, ledger: Ledger) -> None:
        self._double, self._ledger = double, ledger
        x, y, _ = world.scene.start_m
        self._pad: Vec3 = (x, y, world.scene.volume.lo_m[2])
        self._left = [fault for fault in draw.faults if fault.kind in _SWITCHED]
        self._following: threading.Thread | None = None

    def position_m(self) -> Vec3:
        """Where it truly is."""
        n, e, d = self._double.state().ned_m
        return (self._pad[0] + e, self._pad[1] + n, self._pad[2] + max(-d, LANDED_M))

    def switch(self, now_s: float) -> None:
        """Faults that are due begin."""
        for fault in [fault for fault in self._left if fault.at_s <= now_s]:
            self._left.remove(fault)
            self._double.switch_on(_of_double(fault))

    def mission_over(self) -> None:
        """From now on it is followed in a thread: the mission no longer asks where it is."""
        if self._following is None:
            self._following = threading.Thread(target=self._follow, name="mintpilot faults double", daemon=True)
            self._following.start()

    def follow_down(self) -> None:
        """Waits until it is on the ground, or in hands that are not ours."""
        self.mission_over()
        assert self._following is not None
        self._following.join()
        self._ledger.crashed = self._double.state().verdict

    def _follow(self) -> None:
        begun_s, mission_s = time.monotonic(), self._ledger.now_s
        while (waited_s := time.monotonic() - begun_s) < DOWN_S:
            state = self._double.state()
            self._ledger.trace.append((mission_s + waited_s, *self.position_m()))
            if _is_left_safe(state):
                return
            time.sleep(LOOK_S)
        self._ledger.left_flying = f"after {DOWN_S:g} s: mode {state.mode}, velocity {state.velocity}"


class Told(Vehicle):
    """The link's vehicle; what it tells of lost links is kept.

    Args:
        inner: the link.
        watched: the double at its other end.
        ledger: is told of it.
    """

    def __init__(self, inner: Vehicle, watched: Watched, ledger: Ledger) -> None:
        self._inner, self._watched, self._ledger = inner, watched, ledger

    def state(self) -> VehicleState:
        """See `Vehicle.state`."""
        return self._inner.state()

    def command(self, motion: Motion) -> None:
        """See `Vehicle.command`."""
        self._inner.command(motion)

    def brake(self) -> None:
        """See `Vehicle.brake`."""
        self._inner.brake()

    def hold(self) -> None:
        """See `Vehicle.hold`."""
        self._watched.mission_over()
        self._inner.hold()

    def advance(self, until_s: float) -> tuple[VehicleInput, ...]:
        """See `Vehicle.advance`."""
        self._watched.switch(self._ledger.now_s)
        try:
            events = self._inner.advance(until_s)
        except DeviceError as error:
            self._tell(Link.TELEMETRY, str(error))
            raise
        for event in events:
            if isinstance(event, LinkChanged) and not event.up and event.link in _TOLD:
                self._tell(event.link, event.reason)
        return events

    def _tell(self, link: Link, reason: str) -> None:
        self._ledger.tell(_TOLD[link], reason)
        self._ledger.beyond_s = min(self._ledger.beyond_s, self._ledger.now_s)  # others fly it from now on


def _of_double(fault: Fault) -> DoubleFault:
    choices = _SWITCHED[fault.kind]
    return choices[min(int(fault.size * len(choices)), len(choices) - 1)]


def _is_left_safe(state: DoubleState) -> bool:
    """On the ground, in a pilot's hands, or hovering in a mode of its autopilot's own."""
    if not state.airborne or state.mode == "pilot":
        return True
    return state.mode in ("hold", "loiter") and math.hypot(*state.velocity) < STILL_MPS
