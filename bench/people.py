"""People reached in MuJoCo, of those whom a planner that is told the truth reaches. `python -m bench.people RECORDS`.

Records are made, and gone on with where interrupted, by
`mintpilot bench table1 --vehicle mujoco --only mint --think 0 --trials N --seed S --out RECORDS`; S is a seed that
nobody has looked at. With `--pictures DIR` each miss is flown again into a run folder, with its map and pictures.
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import replace
from pathlib import Path

from bench.sections import Section, Table, keep
from mintpilot.assembly.api import run_mission
from mintpilot.benchmark.intervals import clopper_pearson_upper, wilson
from mintpilot.benchmark.records import TrialRecord, WorldRecord
from mintpilot.benchmark.store import read_config, read_records
from mintpilot.core.mission import Outcome
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_world import ScenarioWorld
from mintpilot.simulation.scenarios import make_scenario

METHOD = "mint"
NAME = "fire-warehouse"
WANTED = "98 % of them, and no collision"
BROKEN = ("raised", "timed-out", "crashed")


def misses(pairs: list[tuple[TrialRecord, WorldRecord]]) -> list[tuple[TrialRecord, WorldRecord]]:
    """Missions in which fewer people were reached than can be."""
    return [(t, w) for t, w in pairs if t.people_found < (w.people_reachable or 0)]


def section(folder: Path) -> tuple[Section, list[int]]:
    """The section of docs/results.md, and the seeds of the misses."""
    config = read_config(folder)
    trials, worlds = read_records(folder)
    known = {w.seed: w for w in worlds if w.people_reachable is not None}
    pairs = [(t, known[t.seed]) for t in trials if t.method == METHOD and t.seed in known]
    lost = misses(pairs)
    reached = sum(min(t.people_found, w.people_reachable or 0) for t, w in pairs)
    able, there = sum(w.people_reachable or 0 for _, w in pairs), sum(t.people_there for t, _ in pairs)
    low, high = wilson(reached, able)
    crashes = sum(t.outcome == Outcome.COLLISION.value for t, _ in pairs)
    ends = Counter(t.outcome for t, _ in pairs)
    row = (
        str(len(pairs)),
        f"{reached} of {able} = {100 * reached / max(1, able):.1f} % [{100 * low:.1f}, {100 * high:.1f}]",
        str(there),
        f"{crashes} (at most {100 * clopper_pearson_upper(crashes, len(pairs)):.1f} %)",
        ", ".join(f"{name} {count}" for name, count in sorted(ends.items())),
        f"{sum(t.questions for t, _ in pairs) / max(1, len(pairs)):.2f}",
    )
    notes = [f"Wanted: {WANTED}, over 200 worlds; {len(pairs)} is what there was time for." if len(pairs) < 200 else ""]
    notes += [
        f"Miss, world {t.seed}: {t.people_found} of {w.people_reachable} reached, {t.outcome} ({t.reason})"
        for t, w in lost
    ]
    broke = sum(t.outcome in BROKEN for t, _ in pairs)
    notes += [f"{broke} missions broke down or computed too long; they count as misses."] if broke else []
    header = (
        "worlds", "people reached of reachable", "people there", "collisions, 95 % bound", "endings", "questions, mean",
    )  # fmt: skip
    made = Section(
        name="31-people-mujoco",
        title="People reached in MuJoCo",
        command=f"mintpilot bench table1 --vehicle mujoco --only {METHOD} --think 0 --trials {len(pairs)} "
        f"--seed {config.seed} --out RECORDS; python -m bench.people RECORDS",
        how="Table 1's worlds with pictures, perception, survey and physics; right answers at once. *Reachable*: "
        "the people whom a planner that is told the truth reaches, on the map of a perfect survey. Nobody looked at "
        "these worlds before.",
        tables=[Table(caption="", header=header, rows=[row])],
        notes=[note for note in notes if note],
    )
    return made, [t.seed for t, _ in lost]


def fly_again(seed: int, folder: Path) -> None:
    """Flies one world again and keeps map, pictures and report in a run folder of its own."""
    world = ScenarioWorld.model_validate({"scenario": NAME})
    words = make_scenario(NAME, 0).mission.instruction
    file = MissionFile(mintpilot=1, name=f"world-{seed}", instruction=words, world=world)
    run_mission(file, vehicle="mujoco", seed=seed, think=0.0, out=folder / str(seed))


def main() -> None:
    """Writes the section, and flies the misses again where pictures are wanted."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("records", type=Path)
    arguments.add_argument("--pictures", type=Path, default=None)
    arguments.add_argument("--note", action="append", default=[], help="a sentence to be kept with the figures")
    given = arguments.parse_args()
    made, seeds = section(given.records)
    keep(replace(made, notes=[*made.notes, *given.note]))
    for seed in seeds if given.pictures is not None else ():
        fly_again(seed, given.pictures)


if __name__ == "__main__":
    main()
