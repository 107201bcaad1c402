"""Every file in examples/ does what it says."""

import json
import re
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mintpilot.cli.main import main

EXAMPLES = Path(__file__).parents[2] / "examples"
BUILDING = EXAMPLES / "my-building" / "mission.yaml"
WITHOUT_SIMULATOR = "import sys; sys.modules['mujoco'] = None; from mintpilot.cli.main import main; sys.exit(main())"


@pytest.mark.long
def test_a_map_of_ones_own_is_planned_without_any_simulator():
    command = [sys.executable, "-c", WITHOUT_SIMULATOR, "plan", str(BUILDING), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["query"]


def test_flying_without_the_simulator_says_what_is_missing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert main(["run", str(EXAMPLES / "medicine.yaml"), "--operator", "scripted", "--vehicle", "mujoco"]) == 3
    said = capsys.readouterr().err
    assert "mintpilot[sim]" in said
    assert "Traceback" not in said


@pytest.mark.parametrize("name", ["fire-warehouse", "medicine"])
def test_the_missions_of_the_paper_can_be_planned(name, capsys):
    assert main(["plan", str(EXAMPLES / f"{name}.yaml"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["mission"] == name


def test_the_python_example_says_what_it_would_ask(capsys):
    runpy.run_path(str(EXAMPLES / "plan_own_map.py"), run_name="__main__")
    shown = capsys.readouterr().out
    assert "First question:" in shown
    assert "the grey smoke in the middle gate" in shown


def test_the_example_in_the_readme_runs_as_printed(capsys, monkeypatch):
    monkeypatch.chdir(EXAMPLES.parent)
    blocks = re.findall(r"```python\n(.*?)```", (EXAMPLES.parent / "README.md").read_text(), re.DOTALL)
    assert len(blocks) == 1
    exec(compile(blocks[0], "README.md", "exec"), {})
    shown = capsys.readouterr().out
    assert "the grey smoke in the middle gate: Matters" in shown
    assert "questions to be expected" in shown


def test_the_python_example_fits_on_a_screen():
    assert len((EXAMPLES / "plan_own_map.py").read_text().splitlines()) <= 40


def test_the_map_is_the_one_that_the_script_draws(tmp_path):
    script = (EXAMPLES / "my-building" / "make_map.py").read_text()
    (tmp_path / "make_map.py").write_text(script)
    subprocess.run([sys.executable, str(tmp_path / "make_map.py")], check=True, capture_output=True)
    for name in ("building.yaml", "building.pgm"):
        assert (tmp_path / name).read_bytes() == (EXAMPLES / "my-building" / name).read_bytes()
    shades = np.unique(np.asarray(Image.open(tmp_path / "building.pgm")))
    assert shades.tolist() == [0, 205, 254]


@pytest.mark.long
def test_the_map_of_ones_own_can_be_flown(tmp_path, capsys):
    out = str(tmp_path / "run")
    main(["run", str(BUILDING), "--operator", "scripted", "--vehicle", "kinematic", "--json", "--out", out])
    assert json.loads(capsys.readouterr().out)["outcome"] == "success"
