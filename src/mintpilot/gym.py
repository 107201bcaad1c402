"""Enters the Gymnasium environment: ``import mintpilot.gym``, then ``gymnasium.make("mintpilot/Elicitation-v0")``.

Gymnasium from 1.4 on loads no entry points of packages; ``gymnasium.make("mintpilot.gym:mintpilot/Elicitation-v0")``
imports this module by itself. The environment is `mintpilot.benchmark.gym_env.ElicitationEnv`.
"""

from __future__ import annotations

import gymnasium

__all__ = ["ENV_ID"]

ENV_ID = "mintpilot/Elicitation-v0"

if ENV_ID not in gymnasium.registry:
    gymnasium.register(id=ENV_ID, entry_point="mintpilot.benchmark.gym_env:ElicitationEnv")
