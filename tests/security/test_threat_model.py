"""Every line of the threat model names a test that is there."""

from __future__ import annotations

import re
from pathlib import Path

LINES = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", Path("SECURITY.md").read_text(encoding="utf-8"))


def test_each_line_is_held_by_a_test_that_exists() -> None:
    assert len(LINES) >= 20
    for file, name in LINES:
        assert f"def {name}(" in Path(file).read_text(encoding="utf-8"), f"{file}::{name}"
