"""``kill -9`` at random moments: what of a run is there afterwards.

    python -m bench.kills [KILLS]

A process records a real mission's events into a run folder and notes, in shared memory, after which event it stands.
It is killed at a moment drawn evenly over the time that the whole takes. The folder is then read: a run counts as
recovered where both logs hold everything up to the noted event, event by event, and the mended MCAP file is read by the
independent reader.
"""

from __future__ import annotations

import mmap
import os
import random
import signal
import struct
import sys
import tempfile
import time
from pathlib import Path

from mcap.reader import make_reader

from bench.sections import Section, Table, keep
from mintpilot import run_mission
from mintpilot.benchmark.intervals import wilson
from mintpilot.core.events import Event
from mintpilot.recording.event_log import EVENTS_FILE, read_event_log
from mintpilot.recording.flight_logs import recover
from mintpilot.recording.mcap_log import MCAP_FILE
from mintpilot.recording.run_folder import RunFolder

MISSION = Path(__file__).parents[1] / "examples" / "my-building" / "mission.yaml"
KILLS, SEED = 200, 20261128
_COUNT = struct.Struct("<q")


def sizes(folder: Path) -> tuple[int, int]:
    """Bytes of the two logs."""
    return (folder / EVENTS_FILE).stat().st_size, (folder / MCAP_FILE).stat().st_size


def write(folder: Path, events: list[Event], note: mmap.mmap) -> None:
    """Records all events; ``note`` holds how many are."""
    keeper = RunFolder(folder, clock=lambda: 0.0)
    for count, event in enumerate(events, 1):
        keeper.record(event)
        _COUNT.pack_into(note, 0, count)
    os._exit(0)


def recovered(folder: Path, whole: Path, least: tuple[int, int], mended: Path) -> str:
    """What is missing of a killed run; empty: nothing."""
    if not (folder / MCAP_FILE).exists():
        return "" if least == (0, 0) else "no files"
    for name, size in zip((EVENTS_FILE, MCAP_FILE), least, strict=True):
        kept = (folder / name).read_bytes()
        if len(kept) < size or kept != (whole / name).read_bytes()[: len(kept)]:
            return f"{name}: {len(kept)} bytes, {size} were written"
    cut, wanted = mended.with_suffix(".cut.mcap"), mended.with_suffix(".wanted.mcap")
    cut.write_bytes((whole / MCAP_FILE).read_bytes()[: least[1]])
    at_least = recover(cut, wanted) if least[1] else 0
    if least[1] and recover(folder / MCAP_FILE, mended) < at_least:
        return "messages were lost in mending"
    if least[1]:
        with mended.open("rb") as stream:
            if len(list(make_reader(stream).iter_messages())) < at_least:
                return "the independent reader reads less"
    if least[0]:
        log = read_event_log(folder)
        numbers = [logged.number for logged in log]
        if numbers != list(range(1, len(numbers) + 1)) or log.lost:
            return "events are missing"
    return ""


def main(kills: int) -> None:
    events: list[Event] = []
    run_mission(MISSION, vehicle="kinematic", progress=events.append)
    rng, lost, moments = random.Random(SEED), [], []
    note = mmap.mmap(-1, _COUNT.size)
    with tempfile.TemporaryDirectory() as made:
        base = Path(made)
        reached, begun = [(0, 0)], time.perf_counter()
        keeper = RunFolder(base / "whole", clock=lambda: 0.0)
        for event in events:
            keeper.record(event)
            reached.append(sizes(base / "whole"))
        takes_s = time.perf_counter() - begun
        for n in range(kills):
            _COUNT.pack_into(note, 0, 0)
            folder = base / f"run-{n}"
            process = os.fork()
            if process == 0:
                write(folder, events, note)
            time.sleep(rng.uniform(0.0, takes_s))
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
            (count,) = _COUNT.unpack_from(note)
            moments.append(count)
            missing = recovered(folder, base / "whole", reached[count], base / f"mended-{n}.mcap")
            if missing:
                lost.append(f"run {n}, after event {count}: {missing}")
    early, good = sum(count < len(events) for count in moments), kills - len(lost)
    low, high = wilson(good, kills)
    row = (f"{kills}", f"{early}", f"{good}", f"{100 * low:.1f} to {100 * high:.1f} %")
    print(*row, *lost, sep="\n")
    keep(
        Section(
            name="58-kills",
            title="Flight recorder: kill -9",
            command="python -m bench.kills",
            how=f"A process records the {len(events)} events of examples/my-building into a run folder, as fast as it "
            f"can ({takes_s:.1f} s), and is killed at a moment drawn evenly over that time (seed {SEED}). Recovered: "
            "both logs are a prefix of what an undisturbed run writes, hold every event that was noted as recorded, "
            "and the mended MCAP file is read by the independent reader.",
            tables=[
                Table(caption="", header=("kills", "before the last event", "recovered", "interval"), rows=[row]),
            ],
            notes=lost,
        )
    )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else KILLS)
