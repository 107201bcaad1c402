"""How long one deliberation takes with 12 stops and 8 gaps. `python -m bench.deliberation [--worlds 5] [--dry]`.

Seconds of the processor, not of the clock, so that other work on the machine does not count.
"""

from __future__ import annotations

import argparse
import time
from statistics import median

import numpy as np

from bench.sections import Section, Table, keep
from mintpilot.assembly.registry import load
from mintpilot.assembly.strategies import make_objective, make_strategy
from mintpilot.core.geometry import Box, GridFrame, Vec3
from mintpilot.core.mission import AskingSettings, Mission
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Region, Room, SemanticMap
from mintpilot.core.task import Action, Reference, SubGoal, Task
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.deliberation import DeliberationParts, deliberate
from mintpilot.planning.flyable import known_flyable
from mintpilot.reasoning.belief import prior_belief

ROOMS, CLOUDS, PLACES = 3, 5, 9
KINDS = (
    ("2D, 512 x 512 cells", GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.5, shape=(1, 512, 512)), 1.0),
    ("3D, 100 x 75 x 20 cells", GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.4, shape=(20, 75, 100)), 5.0),
)
"""Name, lattice, and the seconds within which a deliberation must be done."""


def world(frame: GridFrame, rng: np.random.Generator) -> tuple[SemanticMap, Task, Vec3]:
    """Blocks, clouds between them, and places to go to, drawn at random; all in one connected free space mostly."""
    _, ny, nx = frame.shape
    cells = np.full(frame.shape, Cell.FREE, np.uint8)
    for _ in range(int(0.12 * ny * nx / 60)):
        y, x = int(rng.integers(0, ny - 6)), int(rng.integers(0, nx - 10))
        cells[:, y : y + 6, x : x + 10] = Cell.OCCUPIED
    free = np.argwhere(known_flyable(SemanticMap(frame=frame, cells=cells), VehicleLimits()))
    picks = frame.centres_of(free[rng.choice(len(free), ROOMS + PLACES + 1, replace=False)])
    points: list[Vec3] = [(float(x), float(y), float(z)) for x, y, z in picks]
    regions = tuple(_cloud(frame, cells, rng, number) for number in range(1, CLOUDS + 1))
    rooms = tuple(
        Room(id=f"room-{i + 1}", door_m=Box(lo_m=(x, y, 0.0), hi_m=(x + 0.1, y + 1.0, 2.0)), viewpoint_m=(x, y, z))
        for i, (x, y, z) in enumerate(points[:ROOMS])
    )
    task = Task(
        instruction="visit all places and find everybody",
        subgoals=tuple(
            SubGoal(action=Action.GO, reference=Reference(phrase=f"place {i}", position_m=point))
            for i, point in enumerate(points[ROOMS:-1], start=1)
        ),
        seeks_people=True,
    )
    return SemanticMap(frame=frame, cells=cells, regions=regions, rooms=rooms), task, points[-1]


def _cloud(frame: GridFrame, cells: np.ndarray, rng: np.random.Generator, number: int) -> Region:
    _, ny, nx = frame.shape
    wide, deep = ny // 4, nx // 12
    y, x = int(rng.integers(0, ny - wide)), int(rng.integers(nx // 10, nx - deep))
    mask = np.zeros(frame.shape, bool)
    mask[:, y : y + wide, x : x + deep] = True
    inside = np.flatnonzero(mask & (cells == Cell.FREE)).astype(np.int64)
    return Region(id=f"smoke-{number}", kind=RegionKind.SMOKE, cells=inside)


def seconds(frame: GridFrame, seed: int, *, endurance_s: float) -> tuple[float, int, int]:
    """Processor time of one deliberation, how many stops and how many gaps it had."""
    map, task, start_m = world(frame, np.random.default_rng(seed))
    mission = Mission(
        name="bench",
        instruction=task.instruction,
        start_m=start_m,
        volume=frame.box,
        limits=VehicleLimits(endurance_s=endurance_s),
        asking=AskingSettings(),
        survey=None,
    )
    parts = DeliberationParts(
        mission=mission,
        task=task,
        planner=load("planner", "grid")(),
        strategy=make_strategy("mint", seed=seed),
        metric=load("metric", "frechet")(),
        objective=make_objective("information-gain", seed=seed),
    )
    begun = time.process_time()
    found = deliberate(BeliefState(map=map, belief=prior_belief(())), parts, start_m=start_m, endurance_s=endurance_s)
    spent = time.process_time() - begun
    return spent, len(found.situation.problem.stops), len(found.findings.gaps)


def main() -> None:
    """Measures, and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=5)
    parser.add_argument("--dry", action="store_true", help="print the section, keep nothing")
    args = parser.parse_args()
    rows = []
    for name, frame, most_s in KINDS:
        seconds(frame, 0, endurance_s=1e4)  # compiles
        size_m = max(frame.box.size_m)
        for kind, endurance_s in (("ample", 1e4), ("short", 1.5 * size_m / VehicleLimits().cruise_mps)):
            found = [seconds(frame, seed, endurance_s=endurance_s) for seed in range(1, args.worlds + 1)]
            spent = [one[0] for one in found]
            over = sum(s > most_s for s in spent)
            stops, gaps = sorted({one[1] for one in found}), sorted({one[2] for one in found})
            rows.append(
                (name, kind, str(len(found)), "/".join(map(str, stops)), "/".join(map(str, gaps)),
                 f"{median(spent):.2f} s", f"{max(spent):.2f} s", f"{most_s:g} s", str(over))
            )  # fmt: skip
    header = ("map", "battery", "worlds", "stops", "gaps", "median", "longest", "must", "above")
    made = Section(
        name="25-deliberation",
        title="One deliberation: 12 stops, 8 gaps",
        command=f"python -m bench.deliberation --worlds {args.worlds}",
        how="Blocks over 12 % of the ground, five clouds, three closed rooms and nine places to go to in order, "
        "drawn at random; the gaps, plans, tree and choice of the first deliberation, warm, in seconds of one core. "
        "*Short*: the battery lasts for one and a half times the map's length, so that stops are left.",
        tables=[Table(caption="", header=header, rows=rows)],
    )
    print(made.markdown()) if args.dry else keep(made)


if __name__ == "__main__":
    main()
