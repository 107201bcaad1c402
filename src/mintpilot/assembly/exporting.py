"""From a mission file or a recorded run to a flight plan for ground stations."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mintpilot.assembly.components import Choices, VehicleChoice, deliberation_parts
from mintpilot.assembly.talk import talk_for
from mintpilot.assembly.worlds import build_world
from mintpilot.core.decisions import FlyPlan
from mintpilot.core.errors import InfeasibleError, InputError, RecordError
from mintpilot.core.events import MissionStarted, Stepped
from mintpilot.core.inputs import DeliberationEnded
from mintpilot.core.mission import Mission
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Fly
from mintpilot.ground_station.flight_plan import FlightPlan, flight_plan_of
from mintpilot.mission.rehearsal import begin
from mintpilot.mission_file.reader import read_mission
from mintpilot.recording.event_log import read_event_log

AT_START_M = 0.5
"""A plan that begins this near the place of take-off begins there, metres."""


def flight_plan_from(source: Path) -> FlightPlan:
    """The flight plan of a mission file, or of a run folder.

    Of a mission file: the plan that may be flown as it is. Of a run: the last plan that was decided on.

    Raises:
        InputError: a question must be answered first, or what would be flown is not known to be safe.
        InfeasibleError: nothing can be flown.
        MapError: the map has no georeference.
        RecordError: the run cannot be read, decided on no plan, or the plan begins in flight.
    """
    mission, plan = _of_run(source) if source.is_dir() else _of_mission(source)
    return flight_plan_of(plan, mission)


def _of_mission(path: Path) -> tuple[Mission, Plan]:
    file = read_mission(path)
    with talk_for(file.language, llm="template") as talk:
        world = build_world(file, base=path.parent, seed=None, parse=talk.parse)
        parts = deliberation_parts(world, Choices(vehicle=VehicleChoice.MAVLINK), talk)
        found = begin(parts, world.map).deliberated()
        if not isinstance(found.decision, Fly):
            gaps = tuple(g for g in found.findings.gaps if g.id in found.decision.scored.query.gap_ids)
            asked = talk.word(found.decision.scored.query, gaps, found.decision.mint).text
            raise InputError(f"a question is open ({asked}): fly the mission, then export its run folder")
    if found.decision.plan is None:
        raise InfeasibleError(f"nothing can be flown: {found.decision.certificate.reason.value}")
    if found.decision.unsafe:
        raise InputError("this strategy flies through what is not known to be passable; such a plan is not exported")
    return world.mission, found.decision.plan


def _of_run(run: Path) -> tuple[Mission, Plan]:
    mission: Mission | None = None
    decided: FlyPlan | None = None
    for logged in read_event_log(run):
        event = logged.event
        if isinstance(event, MissionStarted):
            mission = event.mission
        elif isinstance(event, Stepped) and isinstance(event.input, DeliberationEnded):
            decision = event.input.decision
            decided = decision if isinstance(decision, FlyPlan) and decision.plan is not None else decided
    if mission is None or decided is None or decided.plan is None:
        raise RecordError(f"{run}: no plan was decided on in this run; there is nothing to export")
    if decided.unsafe:
        raise InputError("this run flew through what was not known to be passable; such a plan is not exported")
    first = decided.plan.legs[0].path_m[0] if decided.plan.legs else np.asarray(mission.start_m)
    if np.linalg.norm(first - np.asarray(mission.start_m)) > AT_START_M:
        place = ", ".join(f"{value:.1f}" for value in first)
        raise RecordError(f"{run}: its last plan begins in flight, at ({place}), not where the mission takes off")
    return mission, decided.plan
