"""The grid of a mission, and a policy learned on it."""

from __future__ import annotations

from pathlib import Path

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.mission.rehearsal import begin
from mintpilot.mission_file.reader import read_mission
from mintpilot.policies.grid import PolicyGrid, grid_of


def mission_grid(mission: str | Path, *, seed: int | None = None) -> PolicyGrid:
    """The grid that a mission is planned on before take-off: what a policy for it must be learned on.

    Args:
        mission: a mission file's path.
        seed: overrides the seed in the file.

    Raises:
        MissionError: the file has mistakes.
        InfeasibleError: nothing can be flown, whatever the answers are.
        InputError: the mission has more regions than a policy can be learned for.
    """
    path = Path(mission)
    world = build_world(read_mission(path), base=path.parent, seed=seed)
    return grid_of(begin(deliberation_parts(world, Choices()), world.map).deliberated().situation.problem)
