"""Whether no record is lost that was written: the events, read line by line by this monitor and by the product."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from mintpilot.assembly.replaying import verify_run
from mintpilot.conformance.faults.monitors import Breach
from mintpilot.core.errors import MintPilotError
from mintpilot.core.events import MissionEnded
from mintpilot.core.mission import Verdict
from mintpilot.recording.event_log import EVENTS_FILE, read_event_log


def kept(folder: Path, *, written: int, refused: int, verdict: Verdict | None) -> Iterator[Breach]:
    """What is missing from the record, or wrong in it.

    Args:
        folder: of the run.
        written: number of events that the mission recorded.
        refused: writes that the disk refused.
        verdict: how the mission ended; None where the process died.
    """
    file = folder / EVENTS_FILE
    if not file.exists():
        if not refused and written:
            yield Breach(rule="record lost", what=f"no events of {written}")
        return
    numbers = [number for line in file.read_bytes().split(b"\n") if (number := _number(line)) is not None]
    if numbers != sorted(set(numbers)):
        yield Breach(rule="record lost", what="the numbers of the events do not ascend")
    lost = sorted(set(range(1, written + 1)) - set(numbers))
    if len(lost) > refused:
        yield Breach(rule="record lost", what=f"events {lost[:5]} of {written} are missing, {refused} were refused")
    try:
        log = read_event_log(folder)
        last = None
        count = 0
        for logged in log:
            last, count = logged.event, count + 1
    except MintPilotError as error:
        if not (refused and not numbers):
            yield Breach(rule="record unreadable", what=str(error))
        return
    if count < len(numbers):
        yield Breach(rule="record unreadable", what=f"{count} of {len(numbers)} events can be read")
    if verdict is not None and not refused:
        if not isinstance(last, MissionEnded):
            yield Breach(rule="record lost", what="the last event is not the end of the mission")
        elif last.verdict != verdict:
            yield Breach(rule="verdict", what="the record ends with another verdict")


def replays(folder: Path) -> Iterator[Breach]:
    """A whole record is thought through again bit for bit."""
    try:
        found = verify_run(folder)
    except MintPilotError as error:
        yield Breach(rule="not replayable", what=str(error))
        return
    if found.verification.difference is not None:
        yield Breach(rule="not replayable", what=found.verification.difference.what)


def _number(line: bytes) -> int | None:
    try:
        fields = json.loads(line)
    except ValueError:
        return None
    number = fields.get("number") if isinstance(fields, dict) else None
    return number if type(number) is int else None
