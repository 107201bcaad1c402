"""The campaign: many trials, each in a process of its own; records that are kept as they come, and gone on from."""

from __future__ import annotations

import os
import signal
import tempfile
import time
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from importlib.util import find_spec
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkProcess
from pathlib import Path
from shutil import rmtree
from typing import IO, Final, TypeAlias

from pydantic import ValidationError

from mintpilot.conformance.faults.browser import CHROMIUM
from mintpilot.conformance.faults.drawing import Draw, drawn
from mintpilot.conformance.faults.kinds import Adapter, FaultKind
from mintpilot.conformance.faults.ledger import Counter
from mintpilot.conformance.faults.monitors import Breach
from mintpilot.conformance.faults.records import FaultRecord
from mintpilot.conformance.faults.records_kept import kept
from mintpilot.conformance.faults.trial import Trial, record_of
from mintpilot.core.errors import RecordError

FULL: Final[Mapping[Adapter, int]] = {
    Adapter.KINEMATIC: 8500,
    Adapter.LINK: 1300,
    Adapter.MUJOCO: 120,
    Adapter.DOUBLES: 20,
    Adapter.CONSOLE: 40,
    Adapter.VOICE: 20,
}
"""Trials of a whole campaign."""
LONGEST_S: Final = {
    Adapter.KINEMATIC: 240.0,
    Adapter.LINK: 120.0,
    Adapter.MUJOCO: 1200.0,
    Adapter.DOUBLES: 900.0,
    Adapter.CONSOLE: 900.0,
    Adapter.VOICE: 1800.0,
}
"""A trial that is not over after this time hangs, seconds."""
RECORDS = "trials.ndjson"
PARTS: Final[Mapping[Adapter, tuple[tuple[str, str], ...]]] = {
    Adapter.MUJOCO: (("mujoco", "sim"),),
    Adapter.DOUBLES: (("mavsdk", "vehicle"), ("pymavlink", "vehicle")),
    Adapter.CONSOLE: (("fastapi", "console"), ("playwright", "dev")),
    Adapter.VOICE: (("moonshine_voice", "voice"), ("faster_whisper", "voice"), ("hibari", "voice")),
}
"""Modules that an adapter needs beside the base install, and the extras that bring them."""
_MAY_DIE = {FaultKind.KILLED, FaultKind.MEMORY_SHORT}

Key: TypeAlias = tuple[Adapter, int]


def counts(trials: int) -> dict[Adapter, int]:
    """How many trials of each adapter a campaign of that size has: in the shares of a whole one, at least one each."""
    whole = sum(FULL.values())
    return {adapter: max(1, round(n * trials / whole)) for adapter, n in FULL.items()}


def lacking(adapter: Adapter) -> str:
    """What this machine lacks for an adapter, and how to get it; empty: nothing."""
    for part, extra in PARTS.get(adapter, ()):
        if find_spec(part) is None:
            return f"{part} is not installed: pip install 'mintpilot[{extra}]'"
    if adapter is Adapter.CONSOLE and not CHROMIUM.exists():
        return f"{CHROMIUM} is not there: apt-get install chromium"
    return ""


def planned(wanted: Mapping[Adapter, int]) -> list[Key]:
    """The trials, mixed so that every part of a campaign has some of each adapter."""
    keys = [((number + 0.5) / n, adapter, number) for adapter, n in wanted.items() for number in range(n)]
    return [(adapter, number) for _, adapter, number in sorted(keys)]


class FaultStore:
    """The records of a campaign, one a line; a line that was cut off is dropped and flown again.

    Args:
        folder: made where it is not there.

    Raises:
        RecordError: it cannot be written or read.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / RECORDS
        self.records: dict[Key, FaultRecord] = {}
        try:
            folder.mkdir(parents=True, exist_ok=True)
            lines = self._path.read_bytes().split(b"\n") if self._path.exists() else []
            for line in lines:
                with suppress(ValidationError):
                    record = FaultRecord.model_validate_json(line)
                    kinds = tuple(fault.kind for fault in drawn(record.adapter, record.number).faults)
                    if record.faults == kinds:  # else other faults were drawn when it was flown
                        self.records[(record.adapter, record.number)] = record
            self._file: IO[str] | None = None
            self._torn = bool(lines and lines[-1])
        except OSError as error:
            raise RecordError(f"cannot keep records in {folder}: {error.strerror}; give another --out") from error

    def add(self, record: FaultRecord) -> None:
        """Keeps one."""
        self.records[(record.adapter, record.number)] = record
        if self._file is None:
            self._file = self._path.open("a", encoding="utf-8")
            self._file.write("\n" if self._torn else "")
        self._file.write(record.model_dump_json() + "\n")
        self._file.flush()

    def close(self) -> None:
        """Closes the file."""
        if self._file is not None:
            self._file.close()


@dataclass(slots=True)
class _Flying:
    """A trial in a process of its own."""

    key: Key
    draw: Draw
    process: ForkProcess
    pipe: Connection
    folder: Path
    written: Counter
    begun: float = field(default_factory=time.monotonic)


def run_campaign(store: FaultStore, keys: Iterable[Key], *, jobs: int, heard: Callable[[FaultRecord], object]) -> None:
    """Flies the trials that have no record yet.

    Args:
        store: keeps the records.
        keys: the trials.
        jobs: processes at once.
        heard: called with each record.
    """
    left = [key for key in keys if key not in store.records]
    if not left:
        return
    _warm(left)
    for record in _flown(iter(left), jobs):
        store.add(record)
        heard(record)


def _warm(left: list[Key]) -> None:
    """Whatever is compiled or loaded once is so before the first fork."""
    if any(adapter is not Adapter.LINK for adapter, _ in left):
        from mintpilot.planning.warm import warm_up

        warm_up()
    if any(adapter is Adapter.KINEMATIC for adapter, _ in left):
        for number in range(1, 6):
            _alone(drawn(Adapter.KINEMATIC, 1_000_000 + number), calm=True)


def _alone(draw: Draw, *, calm: bool = False) -> FaultRecord:
    """One trial in this process."""
    from dataclasses import replace

    with tempfile.TemporaryDirectory() as folder:
        return fly(replace(draw, faults=()) if calm else draw, Path(folder), Counter())


def fly(draw: Draw, folder: Path, written: Counter) -> FaultRecord:
    """One trial, here and now."""
    if draw.adapter is Adapter.LINK:
        from mintpilot.conformance.faults.link_trial import fly_link

        return fly_link(draw)
    return Trial(draw, folder, written).fly()


def _flown(keys: Iterator[Key], jobs: int) -> Iterator[FaultRecord]:
    flying: list[_Flying] = []
    try:
        while True:
            while len(flying) < jobs and (key := next(keys, None)) is not None:
                flying.append(_begun(key))
            if not flying:
                return
            ready = wait([one.pipe for one in flying], timeout=1.0)
            for one in tuple(flying):
                overdue = time.monotonic() - one.begun > LONGEST_S[one.key[0]]
                if one.pipe in ready or overdue:
                    flying.remove(one)
                    yield _ended(one, overdue=one.pipe not in ready)
    finally:
        for one in flying:
            one.process.kill()
            one.process.join()
            rmtree(one.folder, ignore_errors=True)


def _begun(key: Key) -> _Flying:
    context = get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    draw, written = drawn(*key), Counter()
    folder = Path(tempfile.mkdtemp(prefix="mintpilot-faults-"))
    process = context.Process(target=_serve, args=(draw, folder, written, theirs))
    process.start()
    theirs.close()
    return _Flying(key=key, draw=draw, process=process, pipe=ours, folder=folder, written=written)


def _serve(draw: Draw, folder: Path, written: Counter, pipe: Connection) -> None:
    """The life of a trial's process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    begun_s = time.process_time()
    try:
        record = fly(draw, folder, written)
        text = record.model_copy(update={"cpu_s": round(time.process_time() - begun_s, 3)}).model_dump_json()
    except BaseException:
        text = traceback.format_exc(limit=-8)
    pipe.send(text)
    pipe.close()
    os._exit(0)


def _ended(one: _Flying, *, overdue: bool) -> FaultRecord:
    wall_s = round(time.monotonic() - one.begun, 3)
    text = ""
    if not overdue:
        with suppress(EOFError, OSError):
            text = one.pipe.recv()
    one.process.kill()
    one.process.join()
    one.pipe.close()
    try:
        return FaultRecord.model_validate_json(text).model_copy(update={"wall_s": wall_s})
    except ValidationError:
        return _died(one, text, overdue=overdue, wall_s=wall_s)
    finally:
        rmtree(one.folder, ignore_errors=True)


def _died(one: _Flying, text: str, *, overdue: bool, wall_s: float) -> FaultRecord:
    """Of a process that did not come back: where it was killed as drawn, its record must be readable all the same."""
    breaches = list(kept(one.folder / "run", written=one.written.get(), refused=one.written.refused, verdict=None))
    if overdue:
        breaches.append(Breach(rule="hang", what=f"not over after {wall_s:.0f} s"))
    elif text and one.draw.first(FaultKind.MEMORY_SHORT) is None:
        breaches.append(Breach(rule="monitor", what=text[-600:]))
    elif not {fault.kind for fault in one.draw.faults} & _MAY_DIE:
        breaches.append(Breach(rule="died", what=f"its process ended with {one.process.exitcode}"))
    return record_of(
        one.draw, outcome="killed", breaches=breaches, events=one.written.get(), wall_s=wall_s,
    )  # fmt: skip
