"""Installs the misbehaving strategies as plug-ins would be: by an entry point, for child processes too."""

from __future__ import annotations

from pathlib import Path

ENTRY_POINTS = """[mintpilot.strategy]
raising = tests.benchmark.small:Raising
hanging = tests.benchmark.small:Hanging
stubborn = tests.benchmark.small:Stubborn
dying = tests.benchmark.small:Dying
missing = tests.benchmark.small:Nowhere
[mintpilot.language]
babbling = tests.benchmark.small:Babbling
"""


def install(folder: Path) -> None:
    info = folder / "bad_plugins-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: bad-plugins\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
