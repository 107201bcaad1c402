"""What is compiled and kept must not outlive what it was compiled from."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

KERNEL = """
from mintpilot.core.compiled import compiled
from helper import STEP, twice

@compiled()
def stepped(x: int) -> int:
    return twice(x) + STEP

if __name__ == "__main__":
    print(stepped(5))
    print(sum(stepped.dispatcher.stats.cache_hits.values()))
"""
HELPER = """
from mintpilot.core.compiled import compiled

STEP = {step}

@compiled()
def twice(x: int) -> int:
    return {factor} * x
"""


def run(folder: Path) -> list[str]:
    done = subprocess.run([sys.executable, "kernel.py"], cwd=folder, capture_output=True, text=True, check=True)
    return done.stdout.split()


@pytest.mark.long
def test_a_changed_helper_is_not_served_from_the_cache(tmp_path: Path) -> None:
    (tmp_path / "kernel.py").write_text(KERNEL)
    (tmp_path / "helper.py").write_text(HELPER.format(step=1, factor=2))
    assert run(tmp_path) == ["11", "0"]
    assert run(tmp_path) == ["11", "1"]
    (tmp_path / "helper.py").write_text(HELPER.format(step=3, factor=4))
    assert run(tmp_path) == ["23", "0"]
