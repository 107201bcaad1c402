"""Before take-off the battery is told with the way home, where the drone must return."""

from __future__ import annotations

import re
from pathlib import Path

import yaml

from mintpilot.assembly.briefing import briefing_of
from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.mission_file.reader import read_mission

EXAMPLE = Path("examples/my-building")


def needed_s(folder: Path, returns: str) -> float:
    text = yaml.safe_load((EXAMPLE / "mission.yaml").read_text(encoding="utf-8"))
    text["world"]["map"] = str((EXAMPLE / "building.yaml").resolve())
    text["vehicle"]["return"] = returns
    file = folder / f"{returns}.yaml"
    file.write_text(yaml.safe_dump(text), encoding="utf-8")
    world = build_world(read_mission(file), base=folder, seed=None)
    lines = briefing_of(deliberation_parts(world, Choices()), world.map).lines
    (needs,) = [m for line in lines if (m := re.search(r"needs (\d+) s", str(line)))]
    return float(needs[1])


def test_the_way_home_is_needed_too(tmp_path: Path) -> None:
    assert needed_s(tmp_path, "required") > needed_s(tmp_path, "none") + 5
