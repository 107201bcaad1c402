"""Least clearance of whole missions on random maps: `python -m bench.clearance [--maps 1000] [--seed 0]`.

Each map has cells of another size, from 0.02 to 2 m. Missions are planned, flown by the kinematic simulator, and
measured by a checker of its own (`tests/oracles/clearance.py`): dense samples of what was flown, exact distances to all
cells that are not known free.
"""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from PIL import Image
from tests.oracles.clearance import densely, distances

from mintpilot.assembly.api import run_mission
from mintpilot.benchmark.intervals import wilson
from mintpilot.core.errors import MissionError
from mintpilot.core.events import Event, LegFlown
from mintpilot.core.query import Reply

FREE, UNKNOWN, OCCUPIED = 254, 205, 0
MOST_M = 0.02
"""Clearances beyond the radius by more than this are not told apart, metres."""
SPACING_M = 0.005
"""Samples of what was flown are at most so far apart, metres."""
ROUNDING_M = 1e-6


@dataclass(frozen=True, kw_only=True)
class Flown:
    """One mission on one map."""

    seed: int
    cell_m: float
    outcome: str
    spare_m: float
    """Least distance to anything not known free, less the radius, metres; infinite where nothing was flown."""


@dataclass(frozen=True, kw_only=True)
class World:
    """A random map and what is declared on it."""

    cell_m: float
    barred: np.ndarray
    """Cells (nz, ny, nx) that are not known free."""
    cloud: np.ndarray
    """Cells of the region."""
    passable: bool
    """The truth about the region."""
    origin_m: tuple[float, ...]
    radius_m: float
    mission: dict[str, object]


def drawn(seed: int, folder: Path) -> World:
    """A world of that seed; writes its map into the folder."""
    rng = np.random.default_rng(seed)
    cell = float(np.exp(rng.uniform(np.log(0.02), np.log(2.0))))
    tall = cell >= 0.15 and rng.random() < 0.3
    edge = int(np.clip(12.0 / cell, 6, 120 if not tall else 24))
    shape = (max(3, min(edge, int(4.0 / cell))) if tall else 1, edge, edge)
    states = np.full(shape, FREE, np.uint8)
    for _ in range(rng.integers(2, 12)):
        low = [int(rng.integers(0, n)) for n in shape]
        high = [a + 1 + int(rng.integers(0, max(2, n // 4))) for a, n in zip(low, shape, strict=True)]
        window = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
        states[window] = OCCUPIED if tall or rng.random() < 0.7 else UNKNOWN
    scattered = rng.random(shape) < rng.choice([0.0, 0.02, 0.1])
    states[scattered] = OCCUPIED
    free = np.argwhere(states == FREE)
    margin, radius = float(rng.choice([0.0, 0.1, 0.3])), float(rng.choice([0.1, 0.3, 0.5]))
    tries, goal = free[rng.integers(len(free), size=40)], free[int(rng.integers(len(free)))]
    within = tries[:, ::-1] + rng.uniform(0.1, 0.9, (len(tries), 3))
    fits = distances(within * cell, states != FREE, (0.0, 0.0, 0.0), cell, radius) >= radius
    start, at = tries[int(np.argmax(fits))], within[int(np.argmax(fits))]
    cloud = np.zeros(shape, bool)
    if rng.random() < 0.5:
        low = [int(rng.integers(0, n)) for n in shape]
        cloud[tuple(slice(a, a + 1 + max(1, n // 5)) for a, n in zip(low, shape, strict=True))] = True
        near = (np.abs(np.argwhere(cloud) - start) <= 1 + 0.9 / cell).all(axis=1)
        cloud &= not near.any()  # the drone does not start in it
    origin = np.zeros(3) if tall else np.array([*rng.uniform(-50, 50, 2), 0.0])
    name = _written(states, cell, origin, folder)
    at = at * cell + origin
    to = (goal[::-1] + rng.uniform(0.1, 0.9, 3)) * cell + origin
    axes = 3 if tall else 2
    world: dict[str, object] = {"map": name, "start_m": at[:axes].tolist()}
    if tall:
        world["resolution_m"] = cell
    passable = bool(rng.random() < 0.5)
    if cloud.any():
        inside = np.argwhere(cloud)[:, ::-1]
        spare = 1e-6 * cell
        low_m, high_m = inside.min(axis=0) * cell + origin + spare, (inside.max(axis=0) + 1) * cell + origin - spare
        world["regions"] = [
            {
                "id": "cloud",
                "description": "the cloud",
                "kind": "smoke",
                "box": {"lo_m": low_m.tolist(), "hi_m": high_m.tolist()},
                "truth": "passable" if passable else "blocked",
            }
        ]
    mission: dict[str, object] = {
        "mintpilot": 1,
        "name": "clearance",
        "instruction": "Go there.",
        "world": world,
        "goals": [{"action": "go", "position_m": to[:axes].tolist()}],
        "vehicle": {"radius_m": radius, "margin_m": margin},
    }
    return World(
        cell_m=cell,
        barred=states != FREE,
        cloud=cloud,
        passable=passable,
        origin_m=tuple(origin.tolist()),
        radius_m=radius,
        mission=mission,
    )


def _written(states: np.ndarray, cell: float, origin: np.ndarray, folder: Path) -> str:
    if len(states) > 1:
        nz, ny, nx = states.shape
        lines = [f"voxel {nx} {ny} {nz}", *(f"{x} {y} {z}" for z, y, x in np.argwhere(states == OCCUPIED))]
        (folder / "map.3dmap").write_text("\n".join(lines) + "\n")
        return "map.3dmap"
    Image.fromarray(states[0, ::-1]).save(folder / "map.png")
    (folder / "map.yaml").write_text(
        f"image: map.png\nresolution: {cell!r}\norigin: [{float(origin[0])!r}, {float(origin[1])!r}, 0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    return "map.yaml"


def fly(seed: int) -> Flown:
    """Flies the mission of that seed and measures it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        world = drawn(seed, folder)
        path = folder / "mission.yaml"
        path.write_text(yaml.safe_dump(world.mission))
        legs: list[np.ndarray] = []

        def told(event: Event) -> None:
            if isinstance(event, LegFlown):
                legs.append(np.asarray(event.log.position_m))

        try:
            record = run_mission(path, vehicle="kinematic", progress=told)
        except MissionError:  # the body does not fit where it is to start
            return Flown(seed=seed, cell_m=world.cell_m, outcome="refused", spare_m=np.inf)
    yes = any(question.reply is Reply.YES for question in record.questions)
    barred = world.barred if world.passable and yes else world.barred | world.cloud
    spare = min((_least(leg, barred, world) for leg in legs if len(leg)), default=np.inf) - world.radius_m
    return Flown(seed=seed, cell_m=world.cell_m, outcome=record.outcome, spare_m=spare)


def _least(leg_m: np.ndarray, barred: np.ndarray, world: World) -> float:
    points = densely(leg_m, SPACING_M)
    return float(distances(points, barred, world.origin_m, world.cell_m, world.radius_m + MOST_M).min())


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--maps", type=int, default=1000, help="number of maps")
    parser.add_argument("--seed", type=int, default=0, help="of the first map; the others follow")
    options = parser.parse_args(arguments)
    found = [fly(seed) for seed in range(options.seed, options.seed + options.maps)]
    flown = [one for one in found if np.isfinite(one.spare_m)]
    touching = [one for one in flown if one.spare_m < -ROUNDING_M]
    worst = min(flown, key=lambda one: one.spare_m)
    low, high = wilson(len(touching), len(flown))
    print(f"maps {len(found)}, flown {len(flown)}, outcomes {dict(Counter(str(one.outcome) for one in found))}")
    print(f"least clearance beyond the radius {worst.spare_m:.7f} m (seed {worst.seed}, cells of {worst.cell_m:.3f} m)")
    print(f"nearer than the radius: {len(touching)} of {len(flown)}, 95 % interval {low:.2%} to {high:.2%}")
    for one in touching:
        print(f"  seed {one.seed}, cells of {one.cell_m:.3f} m, {one.outcome}: {one.spare_m:.4f} m")
    return 1 if touching else 0


if __name__ == "__main__":
    raise SystemExit(main())
