"""Long, many, and at once: does anything grow, does anything come late? `python -m bench.load [--dry]`.

An eight-hour mission in simulation: events, memory and files by the hour. A thousand missions in one process: memory.
Ten missions at once, each with an attended operator, so that mission time passes as on the wall: how late what is due
comes.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import resource
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np

from bench.sections import Section, Table, keep
from mintpilot import run_mission
from mintpilot.core.events import Event, Stepped
from mintpilot.core.inputs import Answered, OperatorInput, QuestionShown
from mintpilot.core.ports import Operator
from mintpilot.core.query import Question, answer_for
from mintpilot.mission_file.schema import MissionFile

LONG_M, WIDE_M = 100.0, 8.0
SLOW_MPS = 0.1
STOPS_AN_HOUR = 4
ANSWERS_S = 2.0
"""Each person at once answers so long after a question was shown."""
WARM = 20
"""So many missions come before the first measurement of memory: caches are filled by then."""
HEARD_S = 0.5
"""Whoever says something is heard within this time, or it is late."""


def patrol(hours: int) -> MissionFile:
    """To and fro between the ends of a hall, slowly."""
    there, back = [LONG_M - 5.0, WIDE_M / 2, 1.2], [5.0, WIDE_M / 2, 1.2]
    goals = [{"action": "go", "position_m": back if i % 2 else there} for i in range(hours * STOPS_AN_HOUR)]
    return MissionFile.model_validate(
        {
            "mintpilot": 1,
            "name": "patrol",
            "instruction": "Fly to and fro.",
            "world": {
                "scene": {
                    "volume": {"lo_m": [0.0, 0.0, 0.0], "hi_m": [LONG_M, WIDE_M, 3.0]},
                    "start_m": back,
                }
            },
            "goals": goals,
            "vehicle": {"cruise_mps": SLOW_MPS, "endurance_s": 2 * 3600.0 * hours},
        }
    )


def hall() -> MissionFile:
    """A cloud in a gap, a way round, and a person behind: one question."""
    box = lambda lo, hi: {"lo_m": lo, "hi_m": hi}  # noqa: E731
    wall = lambda name, lo, hi: {"id": name, "kind": "wall", "extent_m": box([6.0, lo, 0.0], [6.2, hi, 3.0])}  # noqa: E731
    return MissionFile.model_validate(
        {
            "mintpilot": 1,
            "name": "hall",
            "instruction": "Go to the injured person.",
            "world": {
                "scene": {
                    "volume": box([0.0, 0.0, 0.0], [12.0, 8.0, 3.0]),
                    "start_m": [1.5, 2.0, 1.2],
                    "solids": [wall("across", 0.0, 1.0), wall("across-2", 3.0, 6.4)],
                    "smokes": [
                        {"id": "cloud", "extent_m": box([5.2, 0.2, 0.0], [7.0, 3.6, 3.0]), "toxic": False},
                    ],
                    "persons": [{"id": "hurt", "position_m": [10.5, 2.0, 0.0]}],
                }
            },
            "asking": {"delta_c_s": 0.5},
        }
    )


def memory_mb() -> float:
    """Resident memory of this process, MB."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize() / 1e6


def eight_hours(hours: int) -> list[tuple[str, ...]]:
    """One row for each hour flown: events in it, memory, bytes written in it."""
    rows: list[tuple[str, ...]] = []
    seen = {"events": 0, "bytes": 0, "hour": 0}
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "run"

        def hear(event: Event) -> None:
            seen["events"] += 1
            if not isinstance(event, Stepped) or event.input.time_s < 3600 * (seen["hour"] + 1):
                return
            written = sum(file.stat().st_size for file in run.rglob("*") if file.is_file())
            rows.append(
                (
                    str(seen["hour"] + 1),
                    str(seen["events"]),
                    f"{memory_mb():.0f}",
                    f"{(written - seen['bytes']) / 1e6:.2f}",
                )
            )
            seen.update(events=0, bytes=written, hour=seen["hour"] + 1)

        record = run_mission(patrol(hours), vehicle="kinematic", out=run, progress=hear)
    assert record.outcome.value == "success", record.reason
    return rows


def many(count: int) -> tuple[float, float, float]:
    """(MB after the warm-up, MB at the end, slope in kB a mission by least squares)."""
    file = hall()
    at: list[float] = []
    for number in range(WARM + count):
        run_mission(file, vehicle="kinematic", seed=number)
        if number >= WARM:
            at.append(memory_mb())
    slope = float(np.polyfit(np.arange(len(at)), at, 1)[0]) if len(at) > 1 else 0.0
    return at[0], at[-1], 1e3 * slope


class Attended(Operator):
    """Knows the truth and is there: mission time passes as on the wall. Notes when what came."""

    attended = True
    hears_once = False

    def __init__(self) -> None:
        self._open: list[tuple[float, Question]] = []
        self.gaps_s: list[float] = []
        self._looked: float | None = None

    def show(self, question: Question, patience_s: float) -> None:
        """Is answered a little later."""
        del patience_s
        self._open.append((time.monotonic(), question))

    def withdraw(self, question: str, why: str) -> None:
        """Answers no more."""
        del why
        self._open = [one for one in self._open if one[1].id != question]

    def tell(self, text: str) -> None:
        """Listens."""

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """Is asked whether there is something to say: that is when it could be heard."""
        now = time.monotonic()
        if self._looked is not None:
            self.gaps_s.append(now - self._looked)
        self._looked = now
        due = [q for at, q in self._open if now - at >= ANSWERS_S]
        self._open = [one for one in self._open if one[1] not in due]
        return tuple(
            event
            for q in due
            for event in (
                QuestionShown(time_s=time_s, question=q.id),
                Answered(time_s=time_s, question=q.id, answer=answer_for(q.query, 0), operator="attended"),
            )
        )


def one_of_many(number: int, barrier: object, told: object) -> None:
    """One process of those at once."""
    person = Attended()
    run_mission(hall(), vehicle="kinematic", seed=number)  # warm
    barrier.wait()
    record = run_mission(hall(), vehicle="kinematic", operator=person, seed=number)
    told.put((record.outcome.value, len(record.questions), person.gaps_s))


def at_once(count: int) -> tuple[list[str], int, list[float]]:
    """(endings, questions, seconds between looks at whether the person has said something)."""
    context = multiprocessing.get_context("spawn")
    barrier, told = context.Barrier(count), context.Queue()
    made = [context.Process(target=one_of_many, args=(i, barrier, told)) for i in range(count)]
    for process in made:
        process.start()
    found = [told.get(timeout=900) for _ in made]
    for process in made:
        process.join()
    return [f[0] for f in found], sum(f[1] for f in found), [gap for f in found for gap in f[2]]


def main() -> None:
    """Measures, and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=int, default=8)
    parser.add_argument("--missions", type=int, default=1000)
    parser.add_argument("--at-once", type=int, default=10)
    parser.add_argument("--dry", action="store_true", help="print the section, keep nothing")
    args = parser.parse_args()
    hours = eight_hours(args.hours)
    first, last, slope = many(args.missions)
    endings, questions, gaps = at_once(args.at_once)
    loads = os.getloadavg()[0]
    late = sum(s > HEARD_S for s in gaps)
    made = Section(
        name="57-load",
        title="Load: long, many, at once",
        command=f"python -m bench.load --hours {args.hours} --missions {args.missions} --at-once {args.at_once}",
        how="Kinematic simulator. *Long*: one mission with a run folder, to and fro in a hall. *Many*: missions with "
        f"one question each in one process, without a run folder; memory from mission {WARM} on. *At once*: so many "
        f"processes, each with an attended operator who answers after {ANSWERS_S:g} s, so that mission time passes as "
        f"on the wall; what is said is heard at the next look, and late where that comes more than {HEARD_S:g} s after "
        "the one before.",
        tables=[
            Table(caption="Long", header=("hour", "events", "memory, MB", "written, MB"), rows=hours),
            Table(
                caption="Many",
                header=("missions", "MB at first", "MB at the end", "growth, kB a mission"),
                rows=[(str(args.missions), f"{first:.0f}", f"{last:.0f}", f"{slope:.1f}")],
            ),
            Table(
                caption="At once",
                header=("missions", "endings", "questions", "between looks, median", "largest", "late"),
                rows=[
                    (
                        str(args.at_once),
                        ", ".join(f"{name} {endings.count(name)}" for name in sorted(set(endings))),
                        str(questions),
                        f"{1e3 * median(gaps):.0f} ms",
                        f"{1e3 * max(gaps):.0f} ms",
                        f"{late} of {len(gaps)}",
                    )
                ],
            ),
        ],
        notes=[f"Load of the machine at the end: {loads:.1f} on {os.cpu_count()} cores."],
    )
    print(made.markdown()) if args.dry else keep(made)


if __name__ == "__main__":
    main()
