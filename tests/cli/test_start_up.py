"""What short commands may not load: a name here costs every call a tenth of a second or more."""

from __future__ import annotations

import subprocess
import sys

import pytest

MISSION = "examples/my-building/mission.yaml"
NEVER = {
    "duckdb",
    "matplotlib",
    "mujoco",
    "rich.console",
    "scipy.interpolate",
    "scipy.optimize",
    "scipy.signal",
    "scipy.stats",
    "mintpilot.assembly.real_vehicle",
    "mintpilot.benchmark",
    "mintpilot.conformance",
    "mintpilot.mapping.builder",
    "mintpilot.mission.loop",
    "mintpilot.mission.process_worker",
    "mintpilot.perception",
    "mintpilot.recording.report",
    "mintpilot.recording.run_folder",
    "mintpilot.simulation.kinematic",
    "mintpilot.simulation.map_scene",
    "mintpilot.simulation.mujoco_vehicle",
    "mintpilot.simulation.scenarios",
    "mintpilot.vehicle.mavlink_vehicle",
}
NOT_TO_CHECK = {
    "numba",
    "scipy",
    "mintpilot.assembly.components",
    "mintpilot.core.events",
    "mintpilot.language",
    "mintpilot.mission",
    "mintpilot.reasoning",
    "mintpilot.recording",
    "mintpilot.strategies",
}
PROGRAM = """
import sys
from mintpilot.cli.main import main
code = main(sys.argv[1:])
print(code, *sys.modules)
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("command", "forbidden"),
    [
        (["check", MISSION], NEVER | NOT_TO_CHECK),
        (["plan", MISSION], NEVER),
    ],
    ids=["check", "plan"],
)
def test_a_short_command_loads_no_more_than_it_needs(command: list[str], forbidden: set[str]) -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM, *command], capture_output=True, text=True, check=True)
    code, *loaded = done.stdout.splitlines()[-1].split()
    assert code == "0"
    assert "mintpilot.assembly.worlds" in loaded
    assert forbidden.intersection(loaded) == set()
