"""Contradictions between a mission and the pictures' map that it is flown on."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from mintpilot.core.errors import MintPilotError
from mintpilot.core.semantic_map import Cell
from mintpilot.mission_file.form_checks import nearest, show
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_world import SeenWorld
from mintpilot.mission_file.seen_map import load_map
from mintpilot.mission_file.yaml_places import Fault, Path_


def seen_faults(mission: MissionFile, world: SeenWorld, base: Path) -> Iterator[Fault]:
    """Every contradiction; loads the map."""
    try:
        map_, start = load_map(base / world.seen)
    except MintPilotError as error:
        yield _fault(("world", "seen"), str(error))
        return
    place = world.start_m or start
    cell = map_.frame.cells_of(place)
    key = "start_m" if world.start_m is not None else "seen"
    if not map_.frame.contains(cell)[0]:
        yield _fault(("world", key), f"start {show(list(place))} is outside of what was seen; give start_m")
    elif map_.cells[tuple(cell[0])] != Cell.FREE:
        yield _fault(("world", key), f"start {show(list(place))} is not in space that was seen free; give start_m")
    known = [o.id for o in map_.objects]
    for index, goal in enumerate(mission.goals or ()):
        if goal.room is not None:
            yield _fault(("goals", index, "room"), f"'{goal.room}': rooms that were seen are meant by a phrase")
        for name, value in (("object", goal.object), ("truth", goal.truth)):
            if value is not None and value not in known:
                yield _fault(("goals", index, name), f"nothing seen is called '{value}'; {nearest(value, known)}")


def _fault(path: Path_, message: str) -> Fault:
    return Fault(path=path, line=None, message=message)
