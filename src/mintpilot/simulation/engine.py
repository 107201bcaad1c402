"""The way to MuJoCo: imported when a world is first built, never before, so that everything else works without it."""

from __future__ import annotations

import importlib
import os
from typing import Any

from mintpilot.core.errors import MissingPartError

GL_PACKAGES = "libegl1 libegl-mesa0 libgl1-mesa-dri"
"""Debian's packages for drawing in software without a screen."""


def load_mujoco() -> Any:
    """The `mujoco` module. Chooses EGL for drawing when `MUJOCO_GL` is unset, which counts at its first import only.

    Raises:
        MissingPartError: MuJoCo is not installed, or the library that it draws with is not.
    """
    os.environ.setdefault("MUJOCO_GL", "egl")
    try:
        return importlib.import_module("mujoco")
    except ModuleNotFoundError as error:
        raise MissingPartError(
            f"the physics simulator MuJoCo cannot be loaded ({error}): install it with pip install 'mintpilot[sim]', "
            "or fly the kinematic simulator"
        ) from error
    except (ImportError, OSError, AttributeError, RuntimeError) as error:  # a missing libEGL shows itself in many ways
        raise _no_drawing(error) from error


def drawing_context(mujoco: Any, width: int, height: int) -> Any:
    """A current OpenGL context of the kind that `MUJOCO_GL` names, also when MuJoCo was imported before that was set.

    Raises:
        MissingPartError: the machine has no such library.
    """
    kind = _drawing_kind()
    try:
        offscreen = kind in ("egl", "osmesa")
        maker = importlib.import_module(f"mujoco.{kind}").GLContext if offscreen else mujoco.GLContext
        context = maker(width, height)
        context.make_current()
    except Exception as error:  # the libraries below raise whatever they like
        raise _no_drawing(error) from error
    return context


def drawing_resources(mujoco: Any, model: Any) -> Any:
    """MuJoCo's own textures and buffers for a model (``MjrContext``), in the current OpenGL context.

    Raises:
        MissingPartError: the driver offers too little.
    """
    try:
        return mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
    except Exception as error:  # MuJoCo's FatalError is no subclass of anything useful
        raise _no_drawing(error) from error


def _drawing_kind() -> str:
    return os.environ.get("MUJOCO_GL", "egl").lower()


def _no_drawing(error: Exception) -> MissingPartError:
    return MissingPartError(
        f"no picture can be drawn with MUJOCO_GL={_drawing_kind()} ({type(error).__name__}: {error}): install it with "
        f"sudo apt-get install {GL_PACKAGES} (or libosmesa6, and set MUJOCO_GL=osmesa), or fly with "
        "--vehicle kinematic; mintpilot doctor says more"
    )
