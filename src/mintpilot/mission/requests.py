"""What the mission wants worked out: requests for slow, pure work, and the one function that does it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mintpilot.core.decisions import Decision, FlyTrajectory, NoPlan
from mintpilot.core.geometry import Bools, Floats, Vec3
from mintpilot.core.message import verbatim
from mintpilot.core.plan import Leg
from mintpilot.core.trajectory import VehicleState
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.deliberation import DeliberationParts, mission_decision
from mintpilot.mission.navigation import explore, leg_trajectory, way_home, way_to_land
from mintpilot.mission.rule_progress import ruling
from mintpilot.mission.way_back import is_stranded, way_back
from mintpilot.planning.meanwhile import Wait, meanwhile


class Purpose(StrEnum):
    """What is to be worked out."""

    MISSION = "mission"
    """Ask what, or fly what (method, sections 2 to 5)."""
    LEG = "leg"
    """A checked trajectory for the next leg of the plan."""
    SURVEY = "survey"
    """Where to look around from next."""
    RETURN = "return"
    """The way to the start."""
    MEANWHILE = "meanwhile"
    """What to do while a question is open (method, section 10)."""
    LAND = "land"
    """The way to the nearest place to land at."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SurveyProgress:
    """How far the survey is."""

    begun_s: float
    seen_from_m: tuple[Vec3, ...] = ()
    """Places that were looked around from, and those that cannot be reached, metres."""
    inspected: Bools | None = None
    """Flags (nz, ny, nx) of surface cells that were looked at from near; None: none yet."""
    homeward: bool = False
    hops: int = 0
    """Flights towards the start so far."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Request:
    """One piece of work, with all that it may look at: equal requests give equal decisions."""

    id: int
    purpose: Purpose
    state: BeliefState
    vehicle: VehicleState
    endurance_s: float
    """Flight time that a plan may use, seconds."""
    track_m: Floats
    """Where the vehicle has been (n, 3), oldest first, metres."""
    explained: frozenset[str] = frozenset()
    """Gaps that were explained before."""
    leg: Leg | None = None
    assume_passable: frozenset[str] = frozenset()
    """Regions that a deliberately unsafe baseline flies through; empty for all others."""
    survey: SurveyProgress | None = None
    wait: Wait | None = None
    """The open question."""


def decide(parts: DeliberationParts, request: Request) -> Decision:
    """Works a request out. Bounded by counts, never by time.

    Raises:
        MintPilotError: it cannot be worked out; the mission then goes on without.
    """
    map, limits, vehicle = request.state.map, parts.mission.limits, request.vehicle
    if request.purpose is Purpose.LEG and request.leg is not None:
        rules = ruling(parts.task, request.state.progress, map)
        return leg_trajectory(request.leg, map, limits, vehicle, request.assume_passable, rules)
    if request.purpose is Purpose.MEANWHILE and request.wait is not None:
        return meanwhile(request.wait, map, limits, vehicle)
    if request.purpose is Purpose.SURVEY and request.survey is not None:
        progress, settings = request.survey, parts.mission.survey
        return explore(
            map,
            parts.mission,
            vehicle,
            request.track_m,
            seen_from_m=progress.seen_from_m,
            inspected=np.zeros(map.frame.shape, bool) if progress.inspected is None else progress.inspected,
            speed_mps=limits.cruise_mps if settings is None else settings.speed_mps,
            spacing_m=None if settings is None or progress.homeward else settings.spacing_m,
        )
    if len(request.track_m) and is_stranded(map, limits, vehicle):
        out = way_back(map, limits, vehicle, request.track_m)
        if out is not None:
            return FlyTrajectory(trajectory=out, retreat=True)
    if request.purpose is Purpose.RETURN:
        rules = ruling(parts.task, request.state.progress, map)
        return way_home(map, limits, vehicle, parts.mission.start_m, request.track_m, rules)
    if request.purpose is Purpose.LAND:
        return way_to_land(map, limits, vehicle)
    if request.purpose is Purpose.MISSION:
        return mission_decision(
            request.state,
            parts,
            start_m=vehicle.position_m,
            endurance_s=request.endurance_s,
            explained=request.explained,
        )
    return NoPlan(reason=verbatim(f"a request for '{request.purpose}' without what it is about"))
