"""Enters the environment in gymnasium's registry. Light: gymnasium calls it whenever it is imported."""

from __future__ import annotations

import gymnasium

ENV_ID = "mintpilot/Elicitation-v0"


def register() -> None:
    """Registers `ENV_ID`, once. The environment itself is imported when it is made."""
    if ENV_ID not in gymnasium.registry:
        gymnasium.register(id=ENV_ID, entry_point="mintpilot.benchmark.gym_env:ElicitationEnv")
