"""``mintpilot sim serve``."""

from __future__ import annotations

import sys
from typing import Annotated

from cyclopts import App, Parameter

from mintpilot.cli.bench_flags import Flag
from mintpilot.cli.exits import EPILOGUE, ExitCode, guarded
from mintpilot.core.errors import InputError

sim = App(
    name="sim",
    help="The simulator by itself.",
    help_epilogue=EPILOGUE,
    help_format="plaintext",
    result_action="return_value",
)


@sim.command
def serve(
    scene: str,
    /,
    *,
    ardupilot_json: Annotated[str, Parameter(name="--ardupilot-json")] = ":9002",
    camera: int | None = None,
    seed: int = 0,
    debug: Flag = False,
) -> ExitCode:
    """Be the physics of a real ArduCopter: it flies our world with our pictures, in lock-step over UDP.

    Start ArduPilot with: arducopter --model JSON:127.0.0.1. Its clock is the simulation's; Ctrl-C ends it.

    Args:
        scene: A scenario (fire-warehouse, medicine-boxes), or a mission file whose world is a scenario or a scene.
        ardupilot_json: HOST:PORT at which servo packets are awaited; without HOST this machine alone.
        camera: Port for pictures, read as the frame source sim://127.0.0.1:PORT. Default: none.
        seed: Of a scenario.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.assembly.simulating import world_of
        from mintpilot.simulation.ardupilot_json import ArdupilotServer

        host, port = address_of(ardupilot_json)
        server = ArdupilotServer(world_of(scene, seed), host=host, port=port, camera_port=camera)
        pictures = f"; pictures at sim://{host}:{server.camera_port}" if camera is not None else ""
        print(f"Waiting for ArduPilot at {host}:{server.port}{pictures}. Ctrl-C ends it.", file=sys.stderr, flush=True)
        try:
            server.serve(until=lambda: False)
        except KeyboardInterrupt:
            return ExitCode.SUCCESS
        finally:
            server.close()
        return ExitCode.SUCCESS

    return guarded(work, as_json=False, debug=debug)


def address_of(text: str) -> tuple[str, int]:
    """Host and port of ``HOST:PORT`` or ``:PORT``. Raises `InputError` where it is none."""
    host, colon, port = text.rpartition(":")
    if not colon or not port.isdigit() or not 0 <= int(port) <= 65535:
        raise InputError(f"--ardupilot-json {text}: write HOST:PORT or :PORT, e.g. :9002")
    return host or "127.0.0.1", int(port)
