"""The commands that the README gives a newcomer: what they would run, without running it."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TARGETS = ["demo", "test", "setup", "fix", "check", "bench", "table", "docs", "results", "ci", "clean"]
pytestmark = pytest.mark.skipif(not shutil.which("make"), reason="make is not installed")


def make(*words: str) -> str:
    done = subprocess.run(["make", *words], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout


def test_make_alone_lists_every_target():
    listed = make()
    assert all(f"make {target} " in listed for target in TARGETS)


@pytest.mark.parametrize(
    ("words", "runs"),
    [
        (("demo",), "mintpilot demo fire-warehouse"),
        (("demo", "MISSION=medicine", "ARGS=--headless"), "mintpilot demo medicine --headless"),
        (("test",), "-m pytest"),
        (("check",), "lint-imports"),
        (("fix",), "ruff format"),
        (("docs",), "make_docs.py"),
        (("ci",), ".ci/run"),
    ],
)
def test_what_each_target_runs(words, runs):
    assert runs in make("--dry-run", *words)


def test_flying_needs_fewer_packages_than_developing():
    assert "setup.sh run" in make("--dry-run", "demo")
    assert "setup.sh dev" in make("--dry-run", "test")


@pytest.mark.parametrize("script", ["scripts/setup.sh", ".ci/run"])
def test_scripts_are_sound_and_executable(script):
    assert os.access(ROOT / script, os.X_OK)
    subprocess.run(["bash", "-n", str(ROOT / script)], check=True)


def test_the_ci_runs_what_the_readme_says():
    text = (ROOT / ".ci" / "run").read_text()
    assert "make test" in text
    assert "make check" in text


def without_tools(tmp_path: Path, *tools: str) -> dict[str, str]:
    """An environment of a plain user in which only these tools, and the shell's own, are found."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for tool in ("bash", "env", "dirname", *tools):
        (folder / tool).symlink_to(shutil.which(tool))
    (folder / "id").write_text("#!/bin/bash\necho 1000\n")
    (folder / "id").chmod(0o755)
    return {"PATH": str(folder), "HOME": str(tmp_path)}


def test_without_python_the_command_for_the_administrator_is_said(tmp_path):
    (tmp_path / "scripts").mkdir()
    script = tmp_path / "scripts" / "setup.sh"
    shutil.copy(ROOT / "scripts" / "setup.sh", script)
    done = subprocess.run([str(script), "run"], env=without_tools(tmp_path), capture_output=True, text=True)
    assert done.returncode == 3
    assert "sudo apt-get install -y python3 python3-venv" in done.stderr
    assert len(done.stderr.splitlines()) == 1
