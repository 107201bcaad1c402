"""Whole missions in MuJoCo: rendered frames in, flown path out. `python -m bench.missions [--seeds N] [--first S]`."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import mean, median

from bench.sections import Section, Table, keep
from mintpilot.assembly.api import run_mission
from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import World, build_world
from mintpilot.cli.demos import demo_mission
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.events import Asked, Deliberated, Event, FrameSeen, Timed
from mintpilot.core.gap import Assumptions
from mintpilot.mission.rehearsal import begin

DEMOS = ("fire-warehouse", "medicine")


@dataclass(kw_only=True)
class Trial:
    """One mission."""

    demo: str
    seed: int
    possible: bool
    """Whether the planner that knows the truth can fly it."""
    outcome: str
    reason: str
    questions: int
    rms_m: float
    max_m: float
    flown_m: float
    flight_s: float
    deliberation_s: float
    """From the finished map to the question's words, the longest of the mission."""
    frame_s: float
    """Perception and mapping of one frame, median."""
    frames: int
    wall_s: float


class Stopwatch:
    """Listens to a mission."""

    def __init__(self) -> None:
        self.thinking: list[float] = []
        self.frame: list[float] = []
        self.frames = 0

    def __call__(self, event: Event) -> None:
        if isinstance(event, Deliberated):
            self.thinking.append(event.seconds)
        elif isinstance(event, Asked):
            self.thinking[-1] += event.wording_s
        elif isinstance(event, FrameSeen):
            self.frames += 1
            self.frame.append(0.0)
        elif isinstance(event, Timed) and event.stage in ("perception", "mapping") and self.frame:
            self.frame[-1] += event.seconds


def omniscient_can(world: World) -> bool:
    """Whether a planner that is told the truth finds a plan, on the map of a perfect survey."""
    thought_parts = deliberation_parts(world, Choices())
    try:
        thought = begin(thought_parts, world.map).deliberated()
    except InfeasibleError:
        return False
    truths = {gap.id: world.truth.value_of(gap) for gap in thought.findings.gaps}
    known = {gap: value for gap, value in truths.items() if value is not None}
    return thought.situation.space.optimistic(Assumptions.exactly(known)) is not None


def trial(demo: str, seed: int, vehicle: str) -> Trial:
    """Flies one mission and measures it."""
    file, watch = demo_mission(demo), Stopwatch()
    possible = omniscient_can(build_world(file, base=Path.cwd(), seed=seed))
    begun = time.perf_counter()
    record = run_mission(file, vehicle=vehicle, seed=seed, progress=watch)
    return Trial(
        demo=demo,
        seed=seed,
        possible=possible,
        outcome=record.outcome.value,
        reason=record.reason,
        questions=len(record.questions),
        rms_m=record.flight.rms_error_m or 0.0,
        max_m=record.flight.max_error_m or 0.0,
        flown_m=record.flight.flown_m or 0.0,
        flight_s=record.flight.seconds or 0.0,
        deliberation_s=max(watch.thinking, default=0.0),
        frame_s=median(watch.frame) if watch.frame else 0.0,
        frames=watch.frames,
        wall_s=time.perf_counter() - begun,
    )


def section(demo: str, trials: list[Trial], command: str) -> Section:
    """The table of docs/results.md."""
    failed = [t for t in trials if t.possible and t.outcome != "success"]
    notes = [f"{t.demo}, seed {t.seed}: {t.outcome} ({t.reason})" for t in failed]
    return Section(
        name=f"10-missions-{demo}",
        title=f"Whole missions: {demo}",
        command=command,
        how=(
            "Scripted operator with perfect answers, strategy `mint`, demo settings. *Possible*: a planner that is "
            "told the truth, on a perfect survey's map, finds a plan within endurance. *Thinking*: gaps, plans, tree, "
            "cut and words, from the finished map to the question, the longest of each mission. *Frame*: perception "
            "and mapping of one 320 x 240 picture."
        ),
        tables=[
            Table(
                caption="",
                header=(
                    "mission",
                    "n",
                    "possible",
                    "success where possible",
                    "questions, mean",
                    "tracking error RMS, worst",
                    "thinking, median / worst",
                    "frame, median",
                    "frames, mean",
                    "computing, median",
                ),
                rows=[list(_row(demo, trials))],
            )
        ],
        notes=notes,
    )


def _row(demo: str, trials: list[Trial]) -> Iterator[str]:
    possible = [t for t in trials if t.possible]
    success = sum(t.outcome == "success" for t in possible)
    flown = [t for t in trials if t.flown_m > 1]
    yield demo
    yield str(len(trials))
    yield str(len(possible))
    yield f"{success} of {len(possible)}"
    yield f"{mean(t.questions for t in trials):.2f}"
    yield f"{max((t.rms_m for t in flown), default=0):.3f} m"
    yield f"{median(t.deliberation_s for t in trials):.2f} / {max(t.deliberation_s for t in trials):.2f} s"
    yield f"{1000 * median(t.frame_s for t in trials):.0f} ms"
    yield f"{mean(t.frames for t in trials):.0f}"
    yield f"{median(t.wall_s for t in trials):.1f} s"


def _nowhere():
    from pathlib import Path

    return Path.cwd()


def main() -> None:
    """Runs the missions, prints each, and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--vehicle", default="mujoco")
    parser.add_argument("--demo", choices=DEMOS)
    parser.add_argument("--keep", action="store_true", help="write docs/results.md")
    args = parser.parse_args()
    for demo in DEMOS if args.demo is None else (args.demo,):
        trials = [_told(trial(demo, seed, args.vehicle)) for seed in range(args.first, args.first + args.seeds)]
        if args.keep:
            options = f"--demo {demo} --vehicle {args.vehicle} --seeds {args.seeds} --first {args.first} --keep"
            keep(section(demo, trials, f"python -m bench.missions {options}"))


def _told(one: Trial) -> Trial:
    print(
        f"{one.demo} {one.seed}: {one.outcome}{'' if one.possible else ' (not possible)'}, {one.questions} questions, "
        f"RMS {one.rms_m:.3f} m, thinking {one.deliberation_s:.2f} s, {one.frames} frames of "
        f"{1000 * one.frame_s:.0f} ms, {one.wall_s:.1f} s in all. {one.reason}",
        flush=True,
    )
    return one


if __name__ == "__main__":
    main()
