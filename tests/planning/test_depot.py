"""A depot that others mapped, with its keep-out mask as regions of unknown passability; and the bound on memory."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.planning.flyable import flyable_cells, region_reach
from mintpilot.planning.joint_search import JointSearch

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "occupancy"
LIMITS = VehicleLimits(radius_m=0.2, margin_m=0.05)


@pytest.mark.skipif(not DATA.is_dir(), reason="the depot's map is not beside the project (../shared/data)")
def test_keep_out_areas_of_a_real_map() -> None:
    grey = np.array(Image.open(DATA / "depot.pgm"))[::-1]
    keep_out = np.array(Image.open(DATA / "depot_keepout.pgm"))[::-1] == 0
    cells = np.select([grey > 250, grey < 100], [int(Cell.FREE), int(Cell.OCCUPIED)], int(Cell.UNKNOWN))[None]
    parts, count = ndimage.label(keep_out & (grey > 250), np.ones((3, 3)))
    patches = [np.flatnonzero(parts == i + 1).astype(np.int64) for i in range(count)]
    regions = tuple(
        Region(id=f"keep-out-{i}", kind=RegionKind.AREA, cells=p) for i, p in enumerate(patches) if p.size >= 60
    )
    assert len(regions) >= 5
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.05, shape=(1, *grey.shape))
    world = SemanticMap(frame=frame, cells=cells.astype(np.uint8), regions=regions)
    search = JointSearch(flyable_cells(world, LIMITS), [region_reach(world, r, LIMITS) for r in regions])
    rng = np.random.default_rng(0)
    inside = np.argwhere(flyable_cells(world, LIMITS))
    shorter = 0
    for _ in range(5):
        start, goal = inside[rng.integers(len(inside), size=2)]
        found = search.between(start, goal)
        assert found.complete
        costs = set()
        for blocked in range(1 << len(regions)):
            way, alone = found.best(blocked), search.under(start, goal, blocked)
            assert (way is None) == (alone is None)
            if way is not None and alone is not None:
                assert way.cost == pytest.approx(alone[0], abs=1e-9)
                costs.add(round(way.cost, 6))
        shorter += len(costs) > 1
    assert shorter


BIG = """
import numpy as np
from mintpilot.planning.joint_search import JointSearch
free = np.ones((64, 256, 256), bool)
for x in range(15, 240, 16):
    free[:50, 10:120, x:x + 3] = free[:50, 130:245, x:x + 3] = False
regions, rng = [], np.random.default_rng(0)
for _ in range(10):
    y, x = rng.integers(5, 230, 2)
    box = np.zeros(free.shape, bool)
    box[:60, y:y + 20, x:x + 20] = True
    regions.append(np.flatnonzero(box).astype(np.int64))
found = JointSearch(free, regions).between((7, 7, 7), (7, 245, 250))
assert found.complete and found.paths
print(int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0]) / 1024)
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="peak memory is read from /proc")
def test_four_million_cells_and_ten_regions_fit_into_a_gibibyte() -> None:
    done = subprocess.run([sys.executable, "-c", BIG], capture_output=True, text=True, check=True)

    assert float(done.stdout) < 1024
