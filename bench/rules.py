"""Random sets of rules, flown and judged; plan costs against a search of their own (method, section 14).

python -m bench.rules RECORDS --flights 1000   # goes on where it was interrupted; writes the section of docs/results.md
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import yaml

from bench.rule_worlds import PATTERNS, SETS, plan_case, world_file, write_map
from bench.sections import Section, Table, keep
from mintpilot.assembly.components import Choices, OperatorSpec, components_for, scripted_operator
from mintpilot.assembly.rule_judge import RuleJudge
from mintpilot.assembly.worlds import build_world
from mintpilot.benchmark.intervals import clopper_pearson_upper
from mintpilot.core.errors import InputError, MissionError
from mintpilot.core.events import Event
from mintpilot.core.gap import Assumptions
from mintpilot.core.mission import Outcome
from mintpilot.core.ports import Recorder
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.reader import read_mission
from mintpilot.planning.task_planner import GridPlanner

GIVEN = (Outcome.SUCCESS, Outcome.PARTIAL, Outcome.RULE_BROKEN)
"""Ends of missions that did something, or were said to."""


@dataclass(frozen=True, kw_only=True)
class Flight:
    """One mission that was flown."""

    n: int
    kind: str
    """``pattern`` or ``random``, and ``2D`` or ``3D``."""
    rules: tuple[str, ...]
    outcome: str
    broken: tuple[str, ...]
    """Rules that the flight broke, whatever it came to."""
    judged: bool
    """Whether the product judged it by its rules: it did something, and nothing else failed it."""
    done: int
    questions: int
    cpu_s: float


class Quiet(Recorder):
    """Counts questions."""

    def __init__(self) -> None:
        self.questions = 0

    def record(self, event: Event) -> None:
        self.questions += type(event).__name__ == "Asked"


def fly(n: int, folder: Path) -> Flight:
    """Mission n: rule set n of `SETS`, on a world of its own."""
    begun = time.process_time()
    rules, kind = SETS[n % len(SETS)], "pattern" if n % len(SETS) < PATTERNS else "random"
    deep = n % 5 == 4
    path = folder / "mission.yaml"
    for draw in range(1000):
        rng = np.random.default_rng([17, n, draw])
        file = world_file(rng, rules, deep=deep)
        write_map(rng, folder, file, deep=deep)
        path.write_text(yaml.safe_dump(file, sort_keys=False))
        try:
            world = build_world(read_mission(path), base=folder, seed=n)
            break
        except (InputError, MissionError):  # a start or a place in a block: another world
            continue
    heard = Quiet()
    operator = scripted_operator(world, OperatorSpec())
    with components_for(world, Choices(vehicle="kinematic"), operators=(operator,), recorder=heard) as made:
        verdict = fly_mission(made)
        judge = made.judge
        assert isinstance(judge, RuleJudge)
        flown = verdict.outcome in GIVEN
        broken = tuple(judge.broken()) if flown or verdict.achieved else ()
    return Flight(
        n=n,
        kind=f"{kind}, {'3D' if deep else '2D'}",
        rules=tuple(json.dumps(rule) if isinstance(rule, dict) else rule for rule in rules),
        outcome=str(verdict.outcome),
        broken=broken,
        judged=flown,
        done=len(verdict.achieved),
        questions=heard.questions,
        cpu_s=round(time.process_time() - begun, 3),
    )


def flights(records: Path, count: int) -> list[Flight]:
    """All flights up to that number, those flown before read from the file."""
    file = records / "flights.ndjson"
    known = {one["n"]: one for one in map(json.loads, file.read_text().splitlines())} if file.exists() else {}
    with tempfile.TemporaryDirectory() as folder, file.open("a") as out:
        for n in range(count):
            if n not in known:
                known[n] = asdict(fly(n, Path(folder)))
                out.write(json.dumps(known[n]) + "\n")
                out.flush()
    return [Flight(**(known[n] | {"rules": tuple(known[n]["rules"]), "broken": tuple(known[n]["broken"])}))
            for n in range(count)]  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Cost:
    """One plan beside the search of its own."""

    n: int
    equal: bool
    planned: float | None
    least: float | None


def costs(records: Path, count: int) -> list[Cost]:
    """So many plans compared, those of before read from the file."""
    file = records / "costs.ndjson"
    known = {one["n"]: one for one in map(json.loads, file.read_text().splitlines())} if file.exists() else {}
    with file.open("a") as out:
        for n in range(count):
            if n not in known:
                case = plan_case(n)
                plan = GridPlanner().open(case.problem).cautious(Assumptions())
                least = case.least()
                planned = None if plan is None else plan.cost_s + sum(one.stop.price_s for one in plan.leaves_undone)
                equal = planned == least if None in (planned, least) else abs(planned - least) < 1e-6
                known[n] = asdict(Cost(n=n, equal=equal, planned=planned, least=least))
                out.write(json.dumps(known[n]) + "\n")
                out.flush()
    return [Cost(**known[n]) for n in range(count)]


def rows(found: list[Flight]) -> Iterator[tuple[str, ...]]:
    for kind in sorted({one.kind for one in found}):
        some = [one for one in found if one.kind == kind]
        judged = [one for one in some if one.judged]
        broken = [one for one in judged if one.broken]
        ends = Counter(one.outcome for one in some)
        yield (
            kind,
            str(len(some)),
            str(len({one.rules for one in some})),
            str(len(judged)),
            f"{len(broken)}",
            f"{100 * clopper_pearson_upper(len(broken), len(judged)):.2f} %" if judged else "",
            ", ".join(f"{name} {count}" for name, count in ends.most_common()),
            f"{sum(one.questions for one in some) / len(some):.2f}",
            f"{np.median([one.cpu_s for one in some]):.2f}",
        )


def main() -> None:
    """Flies, compares, writes the section."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("records", type=Path)
    arguments.add_argument("--flights", type=int, default=1000)
    arguments.add_argument("--costs", type=int, default=200)
    given = arguments.parse_args()
    given.records.mkdir(parents=True, exist_ok=True)
    compared = costs(given.records, given.costs)
    found = flights(given.records, given.flights)
    unequal = [one.n for one in compared if not one.equal]
    stray = [one for one in found if not one.judged and one.broken]
    notes = [
        f"Plan costs, what is left undone counted, equal those of the other search in {len(compared) - len(unequal)} "
        f"of {len(compared)} cases ({sum(one.least is not None for one in compared)} of them with a plan)"
        + (f"; not in {unequal}." if unequal else "."),
        f"{len(stray)} missions gave up after they had done something and had a rule open or broken when they came "
        "home: fail-safes go before rules.",
    ]
    notes += [f"Broken: mission {one.n}, {'; '.join(one.broken)}." for one in found if one.judged and one.broken][:10]
    keep(
        Section(
            name="45-rules",
            title="Rules in time",
            command=f"python -m bench.rules RECORDS --flights {given.flights} --costs {given.costs}",
            how=f"{PATTERNS} sets, one for each pattern, and {len(SETS) - PATTERNS} random sets of one to five rules "
            "(patterns and LTLf) over regions, smoke, things, a room and places to go to. Each mission has a map of "
            "its own: 24 x 16 cells of 0.5 m, every fifth 20 x 14 x 6, with blocks, three declared areas that overlap "
            "or not, a cloud that is safe or not, a barrel, a closed room, three places. Half of them must return. "
            "Kinematic flight, right answers. *Judged*: it did something, so that its rules count; the judge shares "
            "no code with planning. *At most*: exact one-sided 95 %. Worlds are drawn by number, before any was "
            "flown; sets of rules that the mission file refuses (they contradict each other or say nothing) are drawn "
            "again. The other search of plan costs is plain Dijkstra over cells, stops done and formulas that are "
            "rewritten moment by moment; stops may be left undone at their price.",
            tables=[
                Table(
                    caption="",
                    header=("rules", "missions", "sets", "judged", "broke a rule", "at most", "ends", "questions, mean",
                            "CPU s, median"),
                    rows=list(rows(found)),
                )
            ],
            notes=notes,
        )
    )  # fmt: skip


if __name__ == "__main__":
    main()
