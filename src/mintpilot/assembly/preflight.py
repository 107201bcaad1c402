"""``mintpilot preflight``: everything that is looked at before a real vehicle flies a mission."""

from __future__ import annotations

import math
from pathlib import Path

from mintpilot.assembly.components import Choices, VehicleChoice, deliberation_parts
from mintpilot.assembly.real_vehicle import checked_vehicle
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World, build_world
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import Assumptions
from mintpilot.core.ports import Fly
from mintpilot.mission.preview import preview
from mintpilot.mission_file.reader import read_mission
from mintpilot.vehicle.checks import Check

LEAST_BATTERY = 0.3
"""A battery below this share is not flown with where the mission says nothing of its flight time."""


def preflight(mission: str | Path, vehicle: str, *, accept_failsafes: bool = False) -> tuple[Check, ...]:
    """Connects to a vehicle on the ground, sets its fail-safes and fence, reads them back, and compares its battery.

    Args:
        mission: a mission file.
        vehicle: ``mavlink://udpin:127.0.0.1:14540``.
        accept_failsafes: leave the fail-safes as they are.

    Raises:
        InputError: the mission, or the address, is wrong.
        DeviceError: the vehicle cannot be reached.
        MissingPartError: MAVSDK is not installed.
    """
    path = Path(mission)
    world = build_world(read_mission(path), base=path.parent, seed=None)
    link = checked_vehicle(world, vehicle, accept_failsafes=accept_failsafes)
    try:
        return (*link.checks, *link.readiness(), _battery(world, link.battery))
    finally:
        link.close()


def _battery(world: World, left: float | None) -> Check:
    """Whether the battery is enough for the plan that is best whatever the answers are."""
    needed_s = _needed_s(world)
    full_s = world.rules.endurance_s
    how = "charge or change the battery; vehicle.endurance_s in the mission file says how long a full one flies"
    if left is None:
        return Check(check="battery", ok=False, value="not told", wanted="known", how=how)
    if not math.isfinite(full_s):
        wanted = f"at least {LEAST_BATTERY:.0%}: the mission does not say how long a full one flies"
        return Check(check="battery", ok=left >= LEAST_BATTERY, value=f"{left:.0%}", wanted=wanted, how=how)
    value = f"{left:.0%}, {left * full_s:.0f} s of flight"
    return Check(check="battery", ok=left * full_s >= needed_s, value=value, wanted=f"{needed_s:.0f} s", how=how)


def _needed_s(world: World) -> float:
    """Seconds that the cautious plan takes; without one, those of the best plan there is."""
    parts = deliberation_parts(world, Choices(vehicle=VehicleChoice.MAVLINK), Talk())
    try:
        first = preview(world.map, parts, max_deliberations=1).first
    except InfeasibleError:
        return math.inf
    cautious = first.situation.space.cautious(Assumptions())
    if cautious is not None:
        return cautious.cost_s
    decision = first.decision
    return decision.plan.cost_s if isinstance(decision, Fly) and decision.plan is not None else 0.0
