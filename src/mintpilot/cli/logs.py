"""``mintpilot log`` and ``mintpilot runs``."""

from __future__ import annotations

import json as json_module
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import App, Parameter

from mintpilot.cli.bench_flags import Flag, Json
from mintpilot.cli.exits import EPILOGUE, ExitCode, guarded
from mintpilot.cli.output import put
from mintpilot.core.errors import InputError

log = App(
    name="log",
    help="Look into recorded flights, mend them, hand them on.",
    help_epilogue=EPILOGUE,
    help_format="plaintext",
    result_action="return_value",
)


@log.command
def info(file: Path, /, *, json: Json = False, debug: Flag = False) -> ExitCode:
    """What a log holds: entries, topics, and whether it is whole.

    Args:
        file: A run folder, its flight.mcap or its events.ndjson.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.recording.flight_logs import log_info

        found = log_info(file)
        if json:
            print(json_module.dumps({"schema_version": 1, **asdict(found)}, ensure_ascii=False))
            return ExitCode.SUCCESS
        state = "whole" if found.whole else "breaks off: 'mintpilot log recover' mends it"
        print(f"{found.file}: {found.entries} entries over {found.seconds:.1f} s, {state}")
        for topic, count in found.topics.items():
            print(f"  {count:6}  {topic}")
        return ExitCode.SUCCESS

    return guarded(work, as_json=json, debug=debug)


@log.command
def recover(file: Path, /, *, out: Path | None = None, debug: Flag = False) -> ExitCode:
    """Mend a flight.mcap that breaks off, so that every viewer reads it.

    Args:
        file: The file, or its run folder. It is left as it is.
        out: The whole file. Default: the name with "-recovered".
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.recording.flight_logs import recover
        from mintpilot.recording.mcap_log import MCAP_FILE

        source = file / MCAP_FILE if file.is_dir() else file
        target = out or source.with_name(f"{source.stem}-recovered{source.suffix}")
        count = recover(source, target)
        print(f"{target}: {count} messages")
        return ExitCode.SUCCESS

    return guarded(work, as_json=False, debug=debug)


@log.command
def export(
    run: Path,
    /,
    *,
    to: Annotated[Literal["csv", "geojson"], Parameter(name="--to")] = "csv",
    out: Path | None = None,
    debug: Flag = False,
) -> ExitCode:
    """Where the drone was, as CSV in metres, or as GeoJSON where the map has a georeference.

    Args:
        run: A run folder, its events.ndjson or its flight.mcap. A .mcap alone holds no battery and no georeference.
        to: The form.
        out: The file. Default: standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.recording.flight_logs import track_csv, track_geojson

        text = track_csv(run) if to == "csv" else track_geojson(run)
        put(text, out)
        return ExitCode.SUCCESS

    return guarded(work, as_json=False, debug=debug)


def runs(
    folder: Path = Path("runs"),
    /,
    *,
    prune: Flag = False,
    older_than: float | None = None,
    keep: int | None = None,
    yes: Flag = False,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """List recorded missions, newest first; with --prune remove some.

    Args:
        folder: Where they are.
        prune: Remove those that --older-than or --keep names. Nothing is removed without --yes.
        older_than: Days.
        keep: Keep the newest so many.
        yes: Really remove.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.recording.run_list import listed, remove, to_remove

        found = listed(folder)
        now_s = datetime.now(UTC).timestamp()
        if not prune and (older_than is not None or keep is not None or yes):
            raise InputError("--older-than, --keep and --yes go with --prune")
        gone = to_remove(found, now_s, older_than_days=older_than, keep=keep) if prune else ()
        if prune and yes:
            for one in gone:
                remove(one)
        if json:
            told = [{**asdict(one), "path": str(one.path), "prune": one in gone} for one in found]
            print(json_module.dumps({"schema_version": 1, "runs": told, "removed": bool(gone) and yes}))
            return ExitCode.SUCCESS
        for one in found:
            when = datetime.fromtimestamp(one.begun_s, UTC).strftime("%Y-%m-%d %H:%M")
            mark = "" if one not in gone else "  removed" if yes else "  would be removed: add --yes"
            print(f"{when}  {one.outcome:14} {one.size_bytes / 1e6:8.1f} MB  {one.name}  {one.path}{mark}")
        if not found:
            print(f"No runs in {folder}.")
        return ExitCode.SUCCESS

    return guarded(work, as_json=json, debug=debug)
