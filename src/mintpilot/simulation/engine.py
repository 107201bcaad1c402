"""The way to MuJoCo: imported when a world is first built, never before, so that everything else works without it."""

from __future__ import annotations

import importlib
import os
from typing import Any

from mintpilot.core.errors import MissingPartError


def load_mujoco() -> Any:
    """The `mujoco` module. Chooses EGL for drawing when `MUJOCO_GL` is unset, which counts at its first import only.

    Raises:
        MissingPartError: MuJoCo is not installed.
    """
    os.environ.setdefault("MUJOCO_GL", "egl")
    try:
        return importlib.import_module("mujoco")
    except ImportError as error:
        raise MissingPartError(
            f"the physics simulator MuJoCo cannot be loaded ({error}): install it with pip install 'mintpilot[sim]', "
            "or fly the kinematic simulator"
        ) from error


def drawing_context(mujoco: Any, width: int, height: int) -> Any:
    """A current OpenGL context of the kind that `MUJOCO_GL` names, also when MuJoCo was imported before that was set.

    Raises:
        MissingPartError: the machine has no such library.
    """
    kind = os.environ.get("MUJOCO_GL", "egl").lower()
    try:
        offscreen = kind in ("egl", "osmesa")
        maker = importlib.import_module(f"mujoco.{kind}").GLContext if offscreen else mujoco.GLContext
        context = maker(width, height)
        context.make_current()
    except Exception as error:  # the libraries below raise whatever they like
        raise MissingPartError(
            f"no picture can be drawn with MUJOCO_GL={kind} ({error}): install libegl1 and libgl1-mesa-dri, or "
            "libosmesa6 and set MUJOCO_GL=osmesa, or fly the kinematic simulator"
        ) from error
    return context
