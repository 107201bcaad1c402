"""From the parts of a mission file to core's nouns."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import CorrelationGroup, obstacle_id
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.mission import (
    AskingSettings,
    CriticalityRule,
    Mission,
    QueryKinds,
    ReturnRule,
    SurveySettings,
    WhileWaiting,
)
from mintpilot.core.plan import Look, VehicleLimits
from mintpilot.core.task import Action, Reference, SubGoal, Task
from mintpilot.mission_file.geodetic_places import georeference_of
from mintpilot.mission_file.schema import GoalSpec, MissionFile
from mintpilot.mission_file.schema_base import attributes_of, in_english, place_of
from mintpilot.mission_file.schema_world import MapWorld

PRICED_FLIGHTS = 10
"""Where nothing else is said a failed mission counts for no less than so many flights across the map."""


def mission_of(file: MissionFile, *, start_m: Vec3, volume: Box) -> Mission:
    """The mission, free of file formats. Start and volume are the world's."""
    survey = file.survey.model_dump() if file.survey else {}
    resolution = {"resolution_m": survey.pop("resolution_m")} if survey else {}
    limits = limits_of(file)
    least_s = 2 * max(start_m[2] - volume.lo_m[2], 0.0) / limits.cruise_mps + limits.reserve_s
    if limits.endurance_s <= least_s:
        raise MissionError(
            f"vehicle endurance_s = {limits.endurance_s:g}: take-off, landing and the reserve alone need {least_s:.1f} "
            "s; give a larger battery, or a smaller reserve_s"
        )
    return Mission(
        name=file.name,
        instruction=file.instruction,
        start_m=start_m,
        volume=volume,
        limits=limits,
        asking=_priced(file, volume, limits),
        survey=None if isinstance(file.world, MapWorld) else SurveySettings(**survey),
        prior_passable=file.priors.passable,
        prior_occupied=file.priors.occupied,
        looks=tuple(
            Look(
                gap=obstacle_id(look.at),
                viewpoint_m=place_of(look.viewpoint_m, start_m[2]),
                dwell_s=look.dwell_s,
                sees=look.sees,
            )
            for look in file.looks
        ),
        people_price_s=file.people_price_s,
        returns=ReturnRule(file.vehicle.returns),
        georeference=None if file.world.georeference is None else georeference_of(file.world.georeference),
        **resolution,
    )


def limits_of(file: MissionFile) -> VehicleLimits:
    """What the vehicle can do."""
    values = file.vehicle.model_dump(exclude={"returns"})
    endurance = values.pop("endurance_s")
    return VehicleLimits(**values, endurance_s=math.inf if endurance is None else endurance)


def asking_of(file: MissionFile) -> AskingSettings:
    """Thresholds and bounds."""
    values = file.asking.model_dump(exclude={"strategy_arguments"})
    kinds: dict[str, Any] = {"rule": CriticalityRule, "while_waiting": WhileWaiting, "kinds": QueryKinds}
    return AskingSettings(**{name: kinds[name](value) if name in kinds else value for name, value in values.items()})


def _priced(file: MissionFile, volume: Box, limits: VehicleLimits) -> AskingSettings:
    """What failing counts for is never less than flying: nothing that was asked for is left for being far away."""
    asking = asking_of(file)
    if "failure_price_s" in file.asking.model_fields_set:
        return asking
    across_s = math.hypot(*volume.size_m) / limits.cruise_mps
    return replace(asking, failure_price_s=max(asking.failure_price_s, PRICED_FLIGHTS * across_s))


def correlations_of(file: MissionFile) -> tuple[CorrelationGroup, ...]:
    """The groups of gaps whose priors do not multiply."""
    return tuple(
        CorrelationGroup(gaps=tuple(group.gaps), joint=tuple((tuple(c.values), c.probability) for c in group.joint))
        for group in file.correlations
    )


def task_of(file: MissionFile, *, layer_m: float = 0.0) -> Task | None:
    """The goals as a task; None when the file gives none and they are to be taken from the instruction.

    Args:
        file: the mission file, already checked.
        layer_m: height of places given as [x, y], metres.
    """
    if file.goals is None:
        return None
    rooms = {room.id: room for room in file.world.rooms} if isinstance(file.world, MapWorld) else {}
    viewpoints = {name: place_of(room.viewpoint_m, layer_m) for name, room in rooms.items()}
    words = {name: in_english(room.description) for name, room in rooms.items()}
    return Task(
        instruction=file.instruction,
        subgoals=tuple(
            SubGoal(
                action=Action(goal.action),
                reference=_reference(goal, viewpoints, words, layer_m),
                dwell_s=goal.dwell_s,
                price_s=goal.price_s,
                id=goal.id or "",
            )
            for goal in file.goals
        ),
        seeks_people=bool(file.seeks_people),
    )


def truths_of(file: MissionFile) -> dict[str, str]:
    """What a scripted operator knows: subject of a gap (id of a region or room, or a phrase) to its true value.

    A region from a mask of several areas (``NAME-1``, ``NAME-2`` …) is not listed part by part: look up ``NAME`` too.
    """
    truths = dict(file.truth)
    if isinstance(file.world, MapWorld):
        truths |= {region.id: region.truth for region in file.world.regions if region.truth is not None}
        truths |= {room.id: room.truth for room in file.world.rooms if room.truth is not None}
    truths |= {goal.phrase: goal.truth for goal in file.goals or () if goal.phrase and goal.truth}
    return truths


def _reference(goal: GoalSpec, viewpoints: Mapping[str, Vec3], words: Mapping[str, str], layer_m: float) -> Reference:
    if goal.room is not None:
        return Reference(phrase=words[goal.room], position_m=viewpoints[goal.room])
    if goal.position_m is not None:
        x, y, z = place_of(goal.position_m, layer_m)
        return Reference(phrase=f"the place at ({x:g}, {y:g})", position_m=(x, y, z))
    if goal.object is not None:
        return Reference(phrase=goal.object, object_id=goal.object)
    return Reference(
        phrase=goal.phrase or "",
        label=goal.label or "",
        attributes=attributes_of(goal.attributes),
        every=Action(goal.action) is Action.COUNT,
    )
