"""The two missions of the paper that ``mintpilot demo`` flies."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Literal, TypeAlias

from mintpilot.core.errors import UnknownNameError
from mintpilot.mission_file.reader import read_mission
from mintpilot.mission_file.schema import MissionFile

DemoName: TypeAlias = Literal["fire-warehouse", "medicine"]
DEMOS: tuple[DemoName, ...] = ("fire-warehouse", "medicine")


def demo_path(name: str) -> Path:
    """The mission file of that demonstration, as it lies in the package.

    Raises:
        UnknownNameError: there is none of that name.
    """
    if name not in DEMOS:
        raise UnknownNameError("demo", name, DEMOS)
    return Path(str(files("mintpilot.cli").joinpath("missions", f"{name}.yaml")))


def demo_mission(name: str) -> MissionFile:
    """That demonstration, read."""
    return read_mission(demo_path(name))
