"""Memory that one joint search takes, in a process of its own.

python -m bench.search_memory FILE  # what `peak_mib` runs
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from bench.search_worlds import adversarial_regions, far_pairs, warehouse_3d
from mintpilot.planning.joint_search import JointSearch


def peak_mib(k: int) -> float:
    """Peak memory of a fresh process, all libraries included, that plans once on 256 x 256 x 64 cells, MiB."""
    world = warehouse_3d(256, 256, 64, (6, 8, 20))
    ends = far_pairs(world, 1)[0]
    regions = adversarial_regions(world, ends, k, k)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "world.npz"
        sizes = [len(r) for r in regions]
        np.savez(file, free=world.free, ends=np.array(ends), cells=np.concatenate(regions), sizes=np.array(sizes))
        command = [sys.executable, "-m", "bench.search_memory", str(file)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    return float(done.stdout)


def print_peak(file: Path) -> None:
    """Plans in the world of a file, and prints this process's peak."""
    data = np.load(file)
    regions = np.split(data["cells"], np.cumsum(data["sizes"])[:-1])
    found = JointSearch(data["free"], regions).between(*data["ends"])
    if not found.complete:
        raise AssertionError("the search did not finish")
    # Not getrusage: its peak is handed down from the parent process.
    status = Path("/proc/self/status").read_text()
    print(int(status.split("VmHWM:")[1].split()[0]) / 1024)


if __name__ == "__main__":
    print_peak(Path(sys.argv[1]))
