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
