"""Makes the pictures of the README from one mission: `python scripts/make_pictures.py [SEED]`. Needs MuJoCo."""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from PIL import Image

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.worlds import build_world
from mintpilot.cli.demos import demo_mission, demo_path
from mintpilot.simulation.mujoco_vehicle import MujocoSimulator

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"


def views(seed: int) -> None:
    """The warehouse as it looks before the flight: from a corner, and from behind the drone."""
    world = build_world(demo_mission("fire-warehouse"), base=Path.cwd(), seed=seed)
    with MujocoSimulator(world.scene, world.rules, seed=seed) as simulator:
        corner = Image.fromarray(simulator.picture("overview", 960, 540))
        behind = Image.fromarray(simulator.picture("chase", 960, 540))
    both = Image.new("RGB", (1920, 540))
    both.paste(corner, (0, 0))
    both.paste(behind, (960, 0))
    both.resize((1280, 360)).save(PICTURES / "warehouse.jpg", quality=85)


def mission(seed: int) -> None:
    """The tree and the flown way of the same mission."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        record = run_mission(demo_path("fire-warehouse"), seed=seed, out=out)
        print(f"seed {seed}: {record.outcome}, {len(record.questions)} questions")
        shutil.copy(out / "tree.svg", PICTURES / "tree.svg")
        picture = Image.open(out / "topdown.png").convert("RGB")
        picture.thumbnail((1000, 1000))
        picture.save(PICTURES / "flown.png", optimize=True)


if __name__ == "__main__":
    PICTURES.mkdir(parents=True, exist_ok=True)
    chosen = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    views(chosen)
    mission(chosen)
