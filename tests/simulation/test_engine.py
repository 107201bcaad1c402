"""A machine without MuJoCo, or without what it draws with, is told what to install."""

import os
import subprocess
import sys
from types import SimpleNamespace

import pytest

from mintpilot.core.errors import MissingPartError
from mintpilot.simulation.engine import drawing_context, drawing_resources, load_mujoco

# Off-screen drawing as it fails where the system library is absent: PyOpenGL finds no libEGL.
NO_EGL = """
import ctypes, sys
load = ctypes._dlopen
def refuse(name, *rest):
    if name and "EGL" in str(name):
        raise OSError(f"{name}: cannot open shared object file: No such file or directory")
    return load(name, *rest)
ctypes._dlopen = refuse
from mintpilot.cli.main import main
sys.exit(main(["demo", "medicine", "--headless", "--out", sys.argv[1]]))
"""


@pytest.mark.long
@pytest.mark.sim
def test_a_missing_egl_is_told_with_the_line_that_installs_it(tmp_path):
    pytest.importorskip("mujoco")
    done = subprocess.run(
        [sys.executable, "-c", NO_EGL, str(tmp_path / "run")],
        env={**os.environ, "MUJOCO_GL": "egl"},
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
    )
    assert done.returncode == 3, done.stderr
    assert "sudo apt-get install libegl1" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("error", [ImportError("no libEGL"), OSError("no libGL"), AttributeError("'NoneType'")])
def test_whatever_the_import_of_the_drawing_library_raises_is_a_missing_part(monkeypatch, error):
    def broken(name: str) -> object:
        raise error

    monkeypatch.setattr("mintpilot.simulation.engine.importlib.import_module", broken)
    with pytest.raises(MissingPartError, match="apt-get install libegl1"):
        load_mujoco()
    with pytest.raises(MissingPartError, match="--vehicle kinematic"):
        drawing_context(None, 8, 8)


def test_a_driver_that_offers_too_little_is_a_missing_part():
    def context(model: object, scale: object) -> object:
        raise RuntimeError("OpenGL ARB_framebuffer_object required")

    scale = SimpleNamespace(mjFONTSCALE_100=SimpleNamespace(value=100))
    with pytest.raises(MissingPartError, match="ARB_framebuffer_object"):
        drawing_resources(SimpleNamespace(MjrContext=context, mjtFontScale=scale), None)
