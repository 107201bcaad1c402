"""MintPilot: a drone that asks instead of guessing.

    import mintpilot

    report = mintpilot.plan_mission("mission.yaml")                          # think, without flying
    record = mintpilot.run_mission("mission.yaml", vehicle="kinematic")      # fly it in a simulator

The names below are loaded when they are first used; nouns and ports live in `mintpilot.core`.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_PLACES = {
    "DeliberationReport": "mintpilot.assembly.deliberation_report",
    "MissionFile": "mintpilot.mission_file.schema",
    "MissionRecord": "mintpilot.recording.record",
    "check_mission": "mintpilot.assembly.validation",
    "plan_mission": "mintpilot.assembly.api",
    "read_mission": "mintpilot.mission_file.reader",
    "read_record": "mintpilot.recording.record",
    "run_mission": "mintpilot.assembly.api",
}

__all__ = [
    "DeliberationReport",
    "MissionFile",
    "MissionRecord",
    "check_mission",
    "plan_mission",
    "read_mission",
    "read_record",
    "run_mission",
]


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module 'mintpilot' has no attribute '{name}'; it offers {', '.join(__all__)}")
    return getattr(import_module(_PLACES[name]), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
