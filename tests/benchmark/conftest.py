from __future__ import annotations

import os
from pathlib import Path

import pytest
from tests.benchmark import plugins

ROOT = Path(__file__).parents[2]


@pytest.fixture
def bad_plugins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Strategies 'raising', 'hanging', 'dying' and 'missing' are installed, for worker processes too."""
    folder = tmp_path / "site"
    folder.mkdir()
    plugins.install(folder)
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.syspath_prepend(str(ROOT))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(folder), str(ROOT))))
