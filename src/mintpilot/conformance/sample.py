"""The small mission that plug-ins are tried on, and the way in which a check fails."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

from mintpilot.assembly.worlds import World, build_world
from mintpilot.core.errors import ConformanceError
from mintpilot.core.plan import PlanningProblem
from mintpilot.mission_file.schema import MissionFile
from mintpilot.uncertainty.findings import find_gaps, frame_problem


def require(holds: bool, part: object, rule: str) -> None:
    """Nothing, where the rule holds.

    Args:
        holds: whether it does.
        part: the plug-in that was tried.
        rule: what was asked, what came back and what should have, in one sentence.

    Raises:
        ConformanceError: it does not.
    """
    if not holds:
        raise ConformanceError(f"{type(part).__name__}: {rule}")


@cache
def sample_world() -> World:
    """A hall with all three kinds of gaps: smoke in the straight way, two boxes that may be meant, a closed room.

    The wall across the hall has a gate full of smoke and, farther off, an open one. The room lies beside the way.
    """
    return build_world(MissionFile.model_validate(_MISSION), base=Path(), seed=0)


@cache
def sample_problem() -> PlanningProblem:
    """The planning problem of the sample world before any answer."""
    world = sample_world()
    start_m = world.mission.start_m
    findings = find_gaps(world.map, world.task, start_m=start_m)
    limits = replace(world.mission.limits, endurance_s=120.0)
    return frame_problem(world.map, world.task, findings, start_m=start_m, limits=limits)


def _box(lo: list[float], hi: list[float]) -> dict[str, list[float]]:
    return {"lo_m": lo, "hi_m": hi}


_MISSION = {
    "mintpilot": 1,
    "name": "conformance",
    "instruction": "Pick up the box and bring it to the injured person, and check whether anyone else is hurt.",
    "world": {
        "scene": {
            "volume": _box([0.0, 0.0, 0.0], [12.0, 8.0, 3.0]),
            "start_m": [1.5, 2.0, 1.2],
            "solids": [
                {"id": "wall-1", "kind": "wall", "extent_m": _box([6.0, 0.0, 0.0], [6.2, 1.0, 3.0])},
                {"id": "wall-2", "kind": "wall", "extent_m": _box([6.0, 3.0, 0.0], [6.2, 6.4, 3.0])},
                {"id": "red", "kind": "box", "colour": "red", "extent_m": _box([3.0, 5.0, 0.0], [3.4, 5.4, 0.4])},
                {"id": "blue", "kind": "box", "colour": "blue", "extent_m": _box([10.6, 3.6, 0.0], [11.0, 4.0, 0.4])},
            ],
            "smokes": [{"id": "cloud", "extent_m": _box([5.2, 0.4, 0.0], [7.0, 3.6, 3.0]), "toxic": False}],
            "rooms": [
                {
                    "id": "room",
                    "extent_m": _box([8.4, 6.2, 0.0], [10.8, 8.0, 2.4]),
                    "door_m": _box([9.2, 6.2, 0.0], [10.0, 6.32, 2.0]),
                    "viewpoint_m": [9.6, 5.0, 1.2],
                }
            ],
            "persons": [{"id": "hurt", "position_m": [10.5, 1.5, 0.0]}],
            "goal_objects": ["red"],
        }
    },
    "asking": {"delta_c_s": 0.5},
    "survey": {"resolution_m": 0.25},
}
