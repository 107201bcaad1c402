"""What a reader passes on a frame's way to a flight: `python -m bench.trace [--mission FILE] [--keep]`.

Flies one kinematic mission and notes every line of MintPilot that runs from the first observation to the last motion.
"""

from __future__ import annotations

import argparse
import sys
import threading
from collections import defaultdict
from pathlib import Path
from types import FrameType
from typing import Any

import mintpilot
from bench.sections import Section, Table, keep
from mintpilot.assembly.components import Choices, VehicleChoice, components_for, scripted_operator
from mintpilot.assembly.worlds import build_world
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.reader import read_mission
from mintpilot.recording.recorders import MemoryRecorder

PACKAGE = Path(mintpilot.__file__).parent
MISSION = Path("examples/my-building/mission.yaml")


class LineTrace:
    """Collects the lines of the package that run while it is active."""

    def __init__(self) -> None:
        self.lines: dict[str, set[int]] = defaultdict(set)
        self._root = str(PACKAGE)

    def __enter__(self) -> LineTrace:
        threading.settrace(self._enter)
        sys.settrace(self._enter)
        return self

    def __exit__(self, *_: object) -> None:
        sys.settrace(None)
        threading.settrace(None)  # type: ignore[arg-type]

    def _enter(self, frame: FrameType, _event: str, _argument: Any) -> Any:
        return self._line if frame.f_code.co_filename.startswith(self._root) else None

    def _line(self, frame: FrameType, event: str, _argument: Any) -> Any:
        if event == "line":
            self.lines[frame.f_code.co_filename].add(frame.f_lineno)
        return self._line


def trace(mission: Path) -> dict[str, tuple[int, int]]:
    """File, relative to the package → (lines that ran, lines that it has)."""
    file = read_mission(mission)
    world = build_world(file, base=mission.parent, seed=0)
    people, choices = (scripted_operator(world, file.operator),), Choices(vehicle=VehicleChoice.KINEMATIC)
    with components_for(world, choices, operators=people, recorder=MemoryRecorder()) as components:
        fly_mission(components)  # once beforehand: compiling and importing are no part of the way
    with components_for(world, choices, operators=people, recorder=MemoryRecorder()) as components, LineTrace() as seen:
        fly_mission(components)
    return {
        str(Path(name).relative_to(PACKAGE)): (len(lines), len(Path(name).read_text(encoding="utf-8").splitlines()))
        for name, lines in sorted(seen.lines.items())
    }


def rooms(passed: dict[str, tuple[int, int]]) -> list[tuple[str, int, int, int]]:
    """(room, files, lines that ran, lines of those files), most lines first."""
    found: dict[str, list[tuple[int, int]]] = defaultdict(list)
    for name, counts in passed.items():
        found[name.partition("/")[0]].append(counts)
    return sorted(
        ((room, len(c), sum(ran for ran, _ in c), sum(whole for _, whole in c)) for room, c in found.items()),
        key=lambda row: -row[2],
    )


def section(passed: dict[str, tuple[int, int]], mission: Path) -> Section:
    """The part of docs/results.md."""
    rows = [[room, *map(str, counts)] for room, *counts in rooms(passed)]
    total = [str(len(passed)), *(str(sum(counts[i] for counts in passed.values())) for i in (0, 1))]
    return Section(
        name="70-trace",
        title="A frame's way to a flight",
        command=f"python -m bench.trace --mission {mission} --keep",
        how="One kinematic mission, every line of the package noted that runs from `fly_mission` to its verdict; "
        "compiled kernels count as the lines that call them. The goal is 12 files and 1,800 lines.",
        tables=[
            Table(
                caption="",
                header=("room", "files", "lines that ran", "lines of those files"),
                rows=[*rows, ["**all**", *total]],
            )
        ],
    )


def main() -> None:
    """Prints files and lines."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mission", type=Path, default=MISSION)
    parser.add_argument("--keep", action="store_true", help="write docs/results.md")
    args = parser.parse_args()
    passed = trace(args.mission)
    for name, (ran, whole) in passed.items():
        print(f"{ran:5} of {whole:4}  {name}")
    print(
        f"{len(passed)} files, {sum(r for r, _ in passed.values())} lines ran of {sum(w for _, w in passed.values())}"
    )
    if args.keep:
        keep(section(passed, args.mission))


if __name__ == "__main__":
    main()
