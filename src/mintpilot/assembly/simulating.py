"""From the name of a scenario, or a mission file, to its world for others: a real autopilot, or Isaac Sim."""

from __future__ import annotations

from pathlib import Path

from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import InputError
from mintpilot.mission_file.reader import read_mission
from mintpilot.simulation.ardupilot_json import ArdupilotWorld
from mintpilot.simulation.openusd import write_usd
from mintpilot.simulation.scenarios import make_scenario
from mintpilot.simulation.scene import FlightRules, Scene

USD_SUFFIXES = (".usda", ".usdc", ".usd")


def world_of(scene: str, seed: int) -> ArdupilotWorld:
    """The world that a real autopilot flies in; see `_scene_of` for what may go wrong.

    Raises:
        MissingPartError: MuJoCo is not installed.
    """
    return ArdupilotWorld(*_scene_of(scene, seed))


def write_usd_of(scene: str, seed: int, path: Path) -> None:
    """Writes the world as OpenUSD; see `_scene_of` for what may go wrong.

    Raises:
        InputError: the file's name does not end in .usda, .usdc or .usd.
        MissingPartError: OpenUSD or MuJoCo is not installed.
        RecordError: the file cannot be written.
    """
    if path.suffix not in USD_SUFFIXES:
        raise InputError(f"--out {path}: OpenUSD files end in {', '.join(USD_SUFFIXES)}")
    found, rules = _scene_of(scene, seed)
    write_usd(found, path, rules=rules)


def _scene_of(scene: str, seed: int) -> tuple[Scene, FlightRules]:
    """The scene and its rules.

    Args:
        scene: name of a scenario, or a mission file.
        seed: of a scenario.

    Raises:
        UnknownNameError: there is no such scenario.
        InputError: the mission's world is a map, which has no bodies to see.
    """
    if Path(scene).suffix not in (".yaml", ".yml"):
        made = make_scenario(scene, seed)
        return made.scene, made.rules
    world = build_world(read_mission(scene), base=Path(scene).parent, seed=seed)
    if world.is_map:
        raise InputError(f"{scene}: its world is a map; give one with a scenario or a scene")
    return world.scene, world.rules
