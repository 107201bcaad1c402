"""The documents: built pages load nothing from elsewhere, one version, every room has a reference page."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest
import yaml

import mintpilot

ROOT = Path(__file__).parents[2]


def script(name: str) -> ModuleType:
    spec = spec_from_file_location(name, ROOT / "scripts" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("page", "suffix", "count"),
    [
        ('<script src="https://cdn.example/a.js"></script>', ".html", 1),
        ('<script src="//cdn.example/a.js"></script>', ".html", 1),
        ('<link rel="stylesheet" href="https://fonts.example/css">', ".html", 1),
        ('<link rel="preconnect" href="https://fonts.example">', ".html", 1),
        ('<img srcset="a.png 1x, https://b.example/b.png 2x">', ".html", 1),
        ('<p style="background: url(http://c.example/c.png)">', ".html", 1),
        ("<style>@import 'https://d.example/d.css';</style>", ".html", 1),
        ("src: url( 'https://e.example/e.woff2')", ".css", 1),
        ('<a href="https://f.example">read on</a>', ".html", 0),
        ('<link rel="canonical" href="https://g.example/">', ".html", 0),
        ('<script src="assets/a.js"></script><img src="b.png">', ".html", 0),
        ("src: url(../fonts/e.woff2)", ".css", 0),
    ],
)
def test_what_a_browser_would_load_from_elsewhere_is_found(page: str, suffix: str, count: int) -> None:
    assert len(script("check_site").outside_requests(page, suffix=suffix)) == count


def test_a_folder_without_a_site_is_no_success(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "scripts/check_site.py", str(tmp_path)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "run make docs" in done.stderr


def test_the_version_stands_in_one_place() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert "version" not in project["project"]
    assert project["project"]["dynamic"] == ["version"]
    assert project["tool"]["hatch"]["version"]["path"] == "src/mintpilot/__init__.py"
    assert "version" not in yaml.safe_load((ROOT / "CITATION.cff").read_text())
    said = subprocess.run(
        [sys.executable, "-c", "from mintpilot.cli.main import main; main(['--version'])"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout.strip() == mintpilot.__version__


def test_the_citation_names_the_paper() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["type"] == "software"
    (paper,) = citation["references"]
    assert paper["identifiers"][0]["value"] == "arXiv:2603.07824"


@pytest.mark.slow
def test_the_site_is_built_strictly_and_loads_nothing_from_elsewhere(tmp_path: Path) -> None:
    pytest.importorskip("mkdocs")
    subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(tmp_path)],
        cwd=ROOT,
        capture_output=True,
        check=True,
    )
    assert list(script("check_site").scan(tmp_path)) == []
    rooms = {path.parent.name for path in (ROOT / "src" / "mintpilot").glob("*/__init__.py")}
    assert {path.stem for path in (tmp_path / "reference").glob("*.html")} == {*rooms, "mintpilot"}
