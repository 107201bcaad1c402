"""How many questions each way of asking needs: exact expectations over random worlds, and twenty questions.

python -m bench.questions              # everything, some minutes; writes the section of docs/results.md
python -m bench.questions --quick      # few worlds, few games; writes nothing
python -m bench.questions --json FILE  # the rows as JSON as well
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from bench.question_games import Expectation, expectation, first_situation, random_problem
from bench.sections import Section, Table, keep
from bench.twenty_questions import TwentyQuestions, people, twenty_questions
from mintpilot.assembly.registry import load
from mintpilot.core.errors import LimitError
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Strategy
from mintpilot.elicitation.objectives import Optimal
from mintpilot.strategies.exhaustive import ExhaustiveStrategy
from mintpilot.strategies.gap_by_gap import GapByGapStrategy
from mintpilot.strategies.mint import MintStrategy
from mintpilot.strategies.random_query import RandomQueryStrategy

# Fixed before the run.
REGIONS = (2, 4, 6, 8)
WORLDS = 50
SETTINGS = AskingSettings(delta_c_s=1.0, alpha=0.0, goal_entropy_bits=0.0)
GAMES = {"information-gain": 1000, "ec2": 200}
WRONG = 0.1

MAX_STATES = 100_000
"""Bound on the exact programme here; in a mission it is lower, since somebody waits."""

METHODS: dict[str, Callable[[], Strategy]] = {
    "optimal": partial(MintStrategy, Optimal(max_states=MAX_STATES)),
    "information-gain": partial(MintStrategy, load("objective", "information-gain")()),
    "ec2": partial(MintStrategy, load("objective", "ec2")()),
    "value-of-information": partial(MintStrategy, load("objective", "value-of-information")()),
    "random": RandomQueryStrategy,
    "gap-by-gap": GapByGapStrategy,
    "ask-all": ExhaustiveStrategy,
}


@dataclass(frozen=True, kw_only=True)
class Row:
    """One way of asking over all worlds with k regions (k = 0: over all worlds)."""

    method: str
    regions: int
    worlds: int
    questions: float
    """Mean over worlds of the expected number."""
    worse: float
    """Probability that the plan flown costs more than delta_c above the omniscient planner's."""
    to_optimal: float
    """Questions as a ratio to those of ``optimal`` on the same worlds."""


def measure(worlds: int) -> tuple[list[Row], int]:
    """All methods over all worlds; worlds that are too large for the exact optimum are counted and left out."""
    found: dict[tuple[str, int], list[Expectation]] = {}
    refused = 0
    for k in REGIONS:
        for seed in range(worlds):
            opening = first_situation(random_problem(np.random.default_rng([k, seed]), k), SETTINGS)
            try:
                results = {name: expectation(make(), opening) for name, make in METHODS.items()}
            except LimitError:
                refused += 1
                continue
            print(f"k = {k}: world {seed + 1} of {worlds}", file=sys.stderr, flush=True)
            for name, result in results.items():
                found.setdefault((name, k), []).append(result)
    rows = []
    for name in METHODS:
        for k in (*REGIONS, 0):
            mine = [e for n in REGIONS if k in (0, n) for e in found.get((name, n), [])]
            best = [e for n in REGIONS if k in (0, n) for e in found.get(("optimal", n), [])]
            questions, least = (float(np.mean([e.questions for e in es])) for es in (mine, best))
            rows.append(
                Row(
                    method=name,
                    regions=k,
                    worlds=len(mine),
                    questions=questions,
                    worse=float(np.mean([e.worse for e in mine])),
                    to_optimal=questions / least if least else 1.0,
                )
            )
    return rows, refused


def tables(rows: list[Row], games: list[TwentyQuestions]) -> list[Table]:
    """The rows as tables."""
    header = ["way of asking", *(f"k = {k}" for k in REGIONS), "all", "to optimal", "plan worse than delta_c"]
    body = []
    for name in METHODS:
        mine = {row.regions: row for row in rows if row.method == name}
        means = [f"{mine[k].questions:.3f}" for k in (*REGIONS, 0)]
        body.append([name, *means, f"{mine[0].to_optimal:.3f}", f"{mine[0].worse:.1%}"])
    twenty = [
        [g.objective, f"{g.wrong:.0%}", str(g.games), f"{g.questions:.3f}", str(g.most), f"{g.right:.1%}"]
        for g in games
    ]
    return [
        Table(caption="Expected questions", header=header, rows=body),
        Table(
            caption="Twenty questions: 24 people, one is meant (log2 24 = 4.585)",
            header=["objective", "wrong answers", "games", "mean questions", "most", "right person"],
            rows=twenty,
        ),
    ]


def main() -> None:
    """Measures, prints, and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few worlds, few games; writes nothing")
    parser.add_argument("--json", type=Path, help="write the rows there as JSON")
    options = parser.parse_args()
    begun = time.perf_counter()
    rows, refused = measure(4 if options.quick else WORLDS)
    games: list[TwentyQuestions] = []
    if people() is not None:
        for objective, count in GAMES.items():
            games.append(twenty_questions(objective, wrong=0.0))
            games.append(twenty_questions(objective, wrong=WRONG, games=50 if options.quick else count))
    notes = [f"{refused} worlds were too large for the exact optimum and are left out of all rows."] if refused else []
    if not games:
        notes.append("Twenty questions were not played: ../shared/data/twentyq/guess_who.json is not there.")
    section = Section(
        name="21-questions",
        title="Questions",
        command="python -m bench.questions",
        how=(
            f"Expectations are exact: every answer is followed, weighted by its probability. {WORLDS} worlds for each "
            "k: 24 x 40 cells of 1 m, 15 % obstacles, regions of 4 to 14 by 2 to 3 cells, each passable with "
            f"probability one half; 1 m/s, delta_c = {SETTINGS.delta_c_s:.0f} s, alpha = 0, rule regret. Twenty "
            "questions: single attributes, pairs of attributes and names; with wrong answers, asking stops at 98 %."
        ),
        tables=tables(rows, games),
        notes=notes,
    )
    print(section.markdown())
    print(f"\n{time.perf_counter() - begun:.0f} s")
    if options.json:
        data = {"questions": [asdict(r) for r in rows], "twenty_questions": [asdict(g) for g in games]}
        options.json.write_text(json.dumps(data, indent=2) + "\n")
    if not options.quick:
        keep(section)


if __name__ == "__main__":
    main()
