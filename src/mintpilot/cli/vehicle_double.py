"""``mintpilot vehicle-double``."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from mintpilot.cli.exits import ExitCode
from mintpilot.core.errors import InputError

if TYPE_CHECKING:
    from mintpilot.conformance.vehicle_double.serving import DoubleSetup


def serve_double(
    flavour: str, port: int, faults: Sequence[str], mission: Path | None, seed: int | None, camera: int | None
) -> ExitCode:
    """Runs a double until Ctrl-C."""
    from mintpilot.conformance.vehicle_double.serving import DoubleLoop

    if camera is not None and mission is None:
        raise InputError(f"--camera {camera}: pictures need a world; name one with --mission")
    setup = replace(_setup(flavour, port, faults, mission, seed), camera_port=camera)
    loop = DoubleLoop(setup)
    pictures = f", pictures at sim://127.0.0.1:{loop.camera_port}" if loop.camera_port is not None else ""
    print(f"A {flavour} vehicle double sends to 127.0.0.1:{port}{pictures}; Ctrl-C ends it.", file=sys.stderr)
    mode = ""
    try:
        while True:
            loop.turn()
            a = loop.autopilot
            now = f"{a.mode.value}, {'armed' if a.armed else 'disarmed'}"
            if now != mode:
                print(now, flush=True)
                mode = now
    except KeyboardInterrupt:
        return ExitCode.SUCCESS
    finally:
        loop.close()


def _setup(flavour: str, port: int, faults: Sequence[str], mission: Path | None, seed: int | None) -> DoubleSetup:
    from mintpilot.assembly.worlds import build_world
    from mintpilot.conformance.vehicle_double.faults import parse_fault
    from mintpilot.conformance.vehicle_double.parameters import Flavour
    from mintpilot.conformance.vehicle_double.serving import DoubleSetup
    from mintpilot.mission_file.reader import read_mission

    scene = rules = None
    if mission is not None:
        world = build_world(read_mission(mission), base=mission.parent, seed=seed)
        scene, rules = world.scene, world.rules
    timed = tuple(parse_fault(text) for text in faults)
    return DoubleSetup(flavour=Flavour(flavour), port=port, faults=timed, scene=scene, rules=rules, seed=seed or 0)
