"""Flying a plan, leg by leg, each checked against the map right before it is flown."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.events import LegFlown, MapUpdated, Noticed, Timed
from mintpilot.core.geometry import Floats
from mintpilot.core.plan import Leg, Plan, VehicleLimits
from mintpilot.core.ports import Recorder, Vehicle, Watch
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.core.task import Action
from mintpilot.core.trajectory import FlightEnd, Trajectory, VehicleState
from mintpilot.mission.eyes import Eyes
from mintpilot.mission.lookout import Lookout
from mintpilot.mission.retreat import is_stranded, way_back
from mintpilot.planning.checks import check_path, check_trajectory
from mintpilot.planning.trajectory import plan_trajectory


class End(StrEnum):
    """How flying a plan ended."""

    DONE = "done"
    """Every stop was fulfilled."""
    NEWS = "news"
    """Something new was seen that bears on the way or opens a gap: think again from here."""
    REFUSED = "refused"
    """The way is not known to be passable, or no trajectory within the limits exists: nothing of it was flown."""
    FAILED = "failed"
    """The vehicle cannot go on."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Progress:
    """What came of flying."""

    end: End
    map: SemanticMap
    finished: frozenset[str]
    reason: str = ""


@dataclass(slots=True, kw_only=True)
class Pilot:
    """Flies plans with one vehicle. Holds no knowledge of its own besides the newest map."""

    vehicle: Vehicle
    eyes: Eyes
    recorder: Recorder
    limits: VehicleLimits
    map: SemanticMap
    watch_map: bool = True
    """False where the map is given and nothing can be seen."""
    _news: str = field(default="", init=False)
    _track: list[Floats] = field(default_factory=list, init=False)

    def get_out(self) -> None:
        """Goes back the way it came when something uncertain was found all around the drone."""
        state = self.vehicle.state()
        if not self._track or not is_stranded(self.map, self.limits, state):
            return
        trajectory = way_back(self.map, self.limits, state, np.vstack(self._track))
        if trajectory is not None:
            self.recorder.record(Noticed(kind="retreat", text="The drone went back the way it came."))
            log = self.vehicle.follow(trajectory)
            self.recorder.record(LegFlown(phase="retreat", stop_id="", trajectory=trajectory, log=log))

    def fly(self, plan: Plan, *, phase: str = "mission", pretend_passable: frozenset[str] = frozenset()) -> Progress:
        """Flies the legs of a plan in order.

        Args:
            plan: what to fly, from where the vehicle is.
            phase: name for the record.
            pretend_passable: ids of regions that a deliberately unsafe baseline flies through; empty for all others.

        Raises:
            DeviceError: the vehicle's link is gone.
        """
        finished: frozenset[str] = frozenset()
        for index, leg in enumerate(plan.legs):
            believed = _pretend(self.map, pretend_passable)
            begun = time.perf_counter()
            trajectory = self._prepare(leg, believed)
            self.recorder.record(Timed(stage="planning", seconds=time.perf_counter() - begun))
            if isinstance(trajectory, str):
                if index:  # the map has changed since the plan was made: what was seen on the way asks for a new one
                    self.recorder.record(Noticed(kind="news", text=trajectory))
                end = End.NEWS if index else End.REFUSED
                return Progress(end=end, map=self.map, finished=finished, reason=trajectory)
            rest = [x.path_m for x in plan.legs[index:]]
            watch = self._watch(rest, pretend_passable) if self.watch_map else None
            self._news = ""
            log = self.vehicle.follow(trajectory, watch)
            self.recorder.record(LegFlown(phase=phase, stop_id=leg.stop.id, trajectory=trajectory, log=log))
            self.eyes.flown(log.position_m, self.limits.radius_m)
            self._track.append(log.position_m[::10])
            if log.end is FlightEnd.FAILED:
                return Progress(end=End.FAILED, map=self.map, finished=finished, reason=log.reason)
            if log.end is FlightEnd.INTERRUPTED:
                return Progress(end=End.NEWS, map=self.map, finished=finished, reason=self._news)
            self._fulfil(leg)
            finished |= {leg.stop.id}
        return Progress(end=End.DONE, map=self.map, finished=finished)

    def _prepare(self, leg: Leg, believed: SemanticMap) -> Trajectory | str:
        """The checked trajectory of a leg, or why there is none."""
        here = self.vehicle.state()
        path = np.vstack([np.asarray(here.position_m, float), leg.path_m[1:]])
        try:
            refusal = check_path(path, believed, self.limits)
            if refusal:
                return refusal
            trajectory = plan_trajectory(
                path,
                map=believed,
                limits=self.limits,
                start_yaw_rad=here.yaw_rad,
                end_yaw_rad=_facing(leg, self.map, path[-1]),
            )
        except InfeasibleError as error:
            return str(error)
        return check_trajectory(trajectory, believed, self.limits) or trajectory

    def _fulfil(self, leg: Leg) -> None:
        self.vehicle.act(leg.stop, leg.stop.dwell_s)
        self.map = self.eyes.look(self.map)
        if leg.stop.action is Action.LOOK:
            self.map = self.map.with_room(_room_of(leg), searched=True)
            self.recorder.record(MapUpdated(map=self.map, why=f"looked into {_room_of(leg)}"))

    def _watch(self, rest: list[Floats], pretend_passable: frozenset[str]) -> Watch:
        """Looks at the world in flight; asks for a stop when the way ahead is lost or something new is uncertain."""
        known = frozenset(uncertain_things(self.map))
        lookout = Lookout(np.vstack(rest), self.limits)

        def watch(state: VehicleState) -> bool:
            self.map = self.eyes.look(self.map)
            new = [words for name, words in uncertain_things(self.map).items() if name not in known]
            trouble = lookout.trouble(state.position_m, _pretend(self.map, pretend_passable))
            if trouble:
                self._news = f"the way ahead is not known to be free any more: {trouble}"
            elif new:
                self._news = f"something new and uncertain: {new[0]}"
            else:
                return False
            self.recorder.record(Noticed(kind="news", text=self._news))
            return True

        return watch


def uncertain_things(believed: SemanticMap) -> dict[str, str]:
    """Regions and rooms of a map: id → what they are called."""
    regions = {region.id: region.description or region.id for region in believed.regions}
    return regions | {room.id: room.description or room.id for room in believed.rooms}


def _pretend(believed: SemanticMap, passable: frozenset[str]) -> SemanticMap:
    for region in passable:
        believed = believed.with_region(region, Knowledge.YES)
    return believed


def _room_of(leg: Leg) -> str:
    return leg.site.label


def _facing(leg: Leg, believed: SemanticMap, end_m: Floats) -> float | None:
    """Heading at the stop: towards the door or the thing it is about; None to keep the heading of the flight."""
    target = leg.site.position_m
    if leg.stop.action is Action.LOOK:
        doors = [room.door_m.centre_m for room in believed.rooms if room.id == _room_of(leg)]
        target = doors[0] if doors else target
    offset = np.asarray(target[:2]) - end_m[:2]
    return float(np.arctan2(offset[1], offset[0])) if float(np.linalg.norm(offset)) > 0.3 else None
