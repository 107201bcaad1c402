"""Which stage an adapter is tried on; what only one of them needs is imported with it."""

from __future__ import annotations

from mintpilot.conformance.faults.kinds import Adapter
from mintpilot.conformance.faults.stage import Open, on_kinematics


def stage_for(adapter: Adapter) -> Open:
    """Sets the stage of that adapter.

    Raises:
        MissingPartError: something that it needs is not installed.
    """
    match adapter:
        case Adapter.MUJOCO:
            from mintpilot.conformance.faults.physics import on_physics

            return on_physics
        case Adapter.DOUBLES:
            from mintpilot.conformance.faults.doubles import on_doubles

            return on_doubles
        case Adapter.CONSOLE:
            from mintpilot.conformance.faults.browser import on_console

            return on_console
        case Adapter.VOICE:
            from mintpilot.conformance.faults.sound import on_voice

            return on_voice
        case _:
            return on_kinematics
