"""``mintpilot replay``."""

from __future__ import annotations

import json
import threading
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from mintpilot.cli.exits import ExitCode

if TYPE_CHECKING:
    from collections.abc import Callable

    from mintpilot.core.events import FrameSeen


def replay_run(run: Path, *, verify: bool, page: bool | None, port: int, as_json: bool) -> ExitCode:
    """Thinks a recorded mission through again, or prints its report and shows it on the page."""
    if not verify:
        from mintpilot.cli.web_page import browser_can_open

        opens = not as_json and page is not False and browser_can_open()
        code = _report(run, as_json=as_json)
        if page or opens:
            serve_run(run, port=port, opens=opens)
        return code
    from mintpilot.assembly.replaying import verify_run

    done = verify_run(run)
    difference = done.verification.difference
    if as_json:
        print(
            json.dumps(
                {
                    "schema_version": 1,
                    "equal": difference is None,
                    "steps": done.verification.steps,
                    "deliberations": done.verification.deliberations,
                    "difference": None if difference is None else asdict(difference),
                    "cut": done.cut,
                },
                ensure_ascii=False,
            )
        )
    else:
        steps, thought = done.verification.steps, done.verification.deliberations
        if difference is None:
            print(f"Equal: {steps} steps bit for bit, {thought} deliberations within 1e-9.")
        else:
            print(f"Different at event {difference.number} ({difference.event}), after {steps - 1} equal steps:")
            print(f"  {difference.what}")
            print(f"  before it: {difference.before}")
        if done.cut:
            print(f"The record breaks off: {done.cut}")
    return ExitCode.SUCCESS if difference is None else ExitCode.NOT_A_SUCCESS


def serve_run(run: Path, *, port: int, opens: bool) -> None:
    """Serves the page on a recorded mission until Ctrl-C.

    Raises:
        RecordError: the record cannot be read.
        DeviceError: nothing can be served at that port.
        MissingPartError: the web server is not installed.
    """
    from mintpilot.assembly.retelling import retell
    from mintpilot.console import Address, ReplayConsole

    with ReplayConsole(jpeg_of=kept_pictures(run), address=Address(port=port)) as console:
        cut = retell(run, console)
        console.serve()
        if cut:
            print(f"The record breaks off: {cut}")
        print(f"To look at any moment of it, open {console.url}\nCtrl-C ends.", flush=True)
        if opens:
            import webbrowser

            webbrowser.open(console.url)
        with suppress(KeyboardInterrupt):
            threading.Event().wait()


def kept_pictures(run: Path) -> Callable[[FrameSeen], bytes | None]:
    """Gives those pictures of a run that were kept, as JPEG."""
    from mintpilot.recording.frames import FrameStore

    pictures = FrameStore(run / "frames")

    def kept(event: FrameSeen) -> bytes | None:
        file = pictures.file(event.index)
        return file.read_bytes() if file.is_file() else None

    return kept


def _report(run: Path, *, as_json: bool) -> ExitCode:
    from mintpilot.cli.progress import LenientConsole
    from mintpilot.recording.record import read_record
    from mintpilot.recording.run_summary import summary
    from mintpilot.recording.terminal_report import print_report

    record = read_record(run)
    if as_json:
        print(summary(record).model_dump_json())
    else:
        print_report(record, LenientConsole())
    return ExitCode.SUCCESS
