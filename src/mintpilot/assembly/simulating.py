"""From the name of a scenario, or a mission file, to the world that a real autopilot flies in."""

from __future__ import annotations

from pathlib import Path

from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import InputError
from mintpilot.mission_file.reader import read_mission
from mintpilot.simulation.ardupilot_json import ArdupilotWorld
from mintpilot.simulation.scenarios import make_scenario


def world_of(scene: str, seed: int) -> ArdupilotWorld:
    """The world.

    Args:
        scene: name of a scenario, or a mission file.
        seed: of a scenario.

    Raises:
        UnknownNameError: there is no such scenario.
        InputError: the mission's world is a map, which has no bodies to see.
        MissingPartError: MuJoCo is not installed.
    """
    if Path(scene).suffix not in (".yaml", ".yml"):
        made = make_scenario(scene, seed)
        return ArdupilotWorld(made.scene, made.rules)
    world = build_world(read_mission(scene), base=Path(scene).parent, seed=seed)
    if world.is_map:
        raise InputError(f"{scene}: its world is a map; give one with a scenario or a scene")
    return ArdupilotWorld(world.scene, world.rules)
