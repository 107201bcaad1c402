"""``mintpilot export``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from mintpilot.cli.bench_flags import Flag
from mintpilot.cli.exits import ExitCode, guarded
from mintpilot.cli.output import put


def export(
    source: Path,
    /,
    *,
    to: Annotated[Literal["plan", "wpl", "geojson", "usd"], Parameter(name="--to")] = "plan",
    firmware: Literal["px4", "ardupilot"] = "px4",
    seed: int = 0,
    out: Path | None = None,
    debug: Flag = False,
) -> ExitCode:
    """Write the flight plan of a mission or a recorded run for a ground station, or a world for Isaac Sim.

    The mission's map needs a georeference. A plan that rests on a question is exported from the run that answered it.
    Autopilots cut corners: keep the acceptance radius small, and check the way on the ground station's map.

    Args:
        source: A mission file, or the folder of a run. For usd: a scenario (fire-warehouse, medicine-boxes), or
            a mission file whose world is a scenario or a scene.
        to: A .plan of QGroundControl, a way-point list (QGC WPL 110), GeoJSON, or the world as OpenUSD.
        firmware: For which autopilot a .plan is written.
        seed: Of a scenario, for usd.
        out: The file. Default: standard output; for usd the source's name with .usda (.usdc: binary).
        debug: Show the traceback of an error.
    """

    def world() -> ExitCode:
        from mintpilot.assembly.simulating import write_usd_of

        path = out or Path(f"{source.stem}.usda")
        write_usd_of(str(source), seed, path)
        print(path)
        return ExitCode.SUCCESS

    def work() -> ExitCode:
        from mintpilot.assembly.exporting import flight_plan_from
        from mintpilot.ground_station.geojson import geojson_text
        from mintpilot.ground_station.qgroundcontrol import plan_text
        from mintpilot.ground_station.waypoints import waypoints_text

        plan = flight_plan_from(source)
        match to:
            case "plan":
                text = plan_text(plan, firmware)
            case "wpl":
                text = waypoints_text(plan)
            case _:
                text = geojson_text(plan)
        put(text, out)
        return ExitCode.SUCCESS

    return guarded(world if to == "usd" else work, as_json=False, debug=debug)
