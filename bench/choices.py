"""What choices of up to four options save: the operator's expected seconds, exactly, over random worlds (section 13).

python -m bench.choices              # 200 worlds, some minutes; writes the section of docs/results.md
python -m bench.choices --quick      # few worlds; writes nothing
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from bench.question_games import expectation, first_situation, random_problem
from bench.sections import Section, Table, keep
from mintpilot.assembly.registry import load
from mintpilot.core.errors import LimitError
from mintpilot.core.mission import AskingSettings, QueryKinds
from mintpilot.core.plan import PlanningProblem
from mintpilot.core.ports import QueryObjective
from mintpilot.elicitation.objectives import Optimal
from mintpilot.strategies.mint import MintStrategy

# Fixed before the run.
WORLDS = 50
SHAPES = ((2, 3), (3, 4), (1, 6), (4, 1))
"""(regions, boxes of which one is meant) of each kind of world."""
SETTINGS = AskingSettings(delta_c_s=1.0, alpha=0.0, goal_entropy_bits=0.0)
OBJECTIVES = ("information-gain", "ec2", "value-of-information")
MAX_STATES = 100_000


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One way of asking in one world."""

    objective: str
    kinds: QueryKinds
    shape: tuple[int, int]
    seed: int
    seconds: float
    """Expected seconds of the operator."""
    questions: float
    worse: float
    """Probability that the plan flown costs more than delta_c above the omniscient planner's."""


def measure(worlds: int) -> tuple[list[Trial], int]:
    """All ways of asking over all worlds; worlds that are too large for the exact optimum are counted and left out."""
    found: list[Trial] = []
    refused = 0
    for shape in SHAPES:
        for seed in range(worlds):
            regions, boxes = shape
            problem = random_problem(np.random.default_rng([13, *shape, seed]), regions, boxes=boxes)
            ways: list[tuple[str, QueryObjective]] = [("optimal", Optimal(max_states=MAX_STATES))]
            ways += [(name, load("objective", name)()) for name in OBJECTIVES]
            try:
                trials = [
                    _trial(name, objective, kinds, shape, seed, problem)
                    for name, objective in ways
                    for kinds in QueryKinds
                ]
            except LimitError:
                refused += 1
                continue
            found += trials
            print(f"{shape}: world {seed + 1} of {worlds}", file=sys.stderr, flush=True)
    return found, refused


def _trial(
    name: str, objective: QueryObjective, kinds: QueryKinds, shape: tuple[int, int], seed: int, problem: PlanningProblem
) -> Trial:
    settings = replace(SETTINGS, kinds=kinds)
    expected = expectation(MintStrategy(objective), first_situation(problem, settings))
    return Trial(
        objective=name,
        kinds=kinds,
        shape=shape,
        seed=seed,
        seconds=expected.effort * settings.reply_s,
        questions=expected.questions,
        worse=expected.worse,
    )


def tables(trials: list[Trial]) -> list[Table]:
    """The trials as tables."""
    header = ["way of asking", *(f"{k} regions, {n} box{'es' if n > 1 else ''}" for k, n in SHAPES), "all worlds",
              "95 % of the mean", "to optimal, any", "questions", "plan worse than delta_c"]  # fmt: skip
    best = _seconds(trials, "optimal", QueryKinds.ANY)
    body = []
    for objective in ("optimal", *OBJECTIVES):
        for kinds in QueryKinds:
            mine = [t for t in trials if (t.objective, t.kinds) == (objective, kinds)]
            seconds = np.array([t.seconds for t in mine])
            half = float(stats.t.ppf(0.975, len(seconds) - 1) * seconds.std(ddof=1) / np.sqrt(len(seconds)))
            shaped = [np.mean([t.seconds for t in mine if t.shape == shape]) for shape in SHAPES]
            body.append(
                [
                    f"{objective}, {'yes/no' if kinds is QueryKinds.YES_NO else 'any'}",
                    *(f"{mean:.2f} s" for mean in shaped),
                    f"{seconds.mean():.2f} s",
                    f"± {half:.2f} s",
                    f"{seconds.mean() / np.mean(list(best.values())):.3f}",
                    f"{np.mean([t.questions for t in mine]):.3f}",
                    f"{np.mean([t.worse for t in mine]):.1%}",
                ]
            )
    return [Table(caption="The operator's expected seconds", header=header, rows=body)]


def notes(trials: list[Trial], refused: int) -> list[str]:
    """Whether the laws hold, in figures."""
    any_kind, alone = (_seconds(trials, "optimal", kinds) for kinds in (QueryKinds.ANY, QueryKinds.YES_NO))
    above = [key for key in alone if any_kind[key] > alone[key] + 1e-9]
    below = sum(any_kind[key] < alone[key] - 1e-9 for key in alone)
    default = _seconds(trials, SETTINGS.objective, QueryKinds.ANY)
    over = np.mean(list(default.values())) / np.mean(list(any_kind.values())) - 1
    made = [
        f"`optimal` over mixed questions is above yes/no alone in {len(above)} of {len(alone)} worlds, below it in "
        f"{below}, and equal in the others.",
        f"The default objective, `{SETTINGS.objective}` over mixed questions, takes {over:+.1%} of the seconds of "
        f"`optimal` (wanted: at most 3 %); n = {len(default)} worlds.",
    ]
    if refused:
        made.append(f"{refused} worlds were too large for the exact optimum and are left out of all rows.")
    return made


def _seconds(trials: list[Trial], objective: str, kinds: QueryKinds) -> dict[tuple[tuple[int, int], int], float]:
    return {(t.shape, t.seed): t.seconds for t in trials if (t.objective, t.kinds) == (objective, kinds)}


def main() -> None:
    """Measures, prints, and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few worlds; writes nothing")
    options = parser.parse_args()
    begun = time.perf_counter()
    trials, refused = measure(4 if options.quick else WORLDS)
    section = Section(
        name="22-choices",
        title="Choices among options",
        command="python -m bench.choices",
        how=(
            f"Expectations are exact: every answer is followed, weighted by its probability. {WORLDS} worlds of each "
            "kind: 24 x 40 cells of 1 m, 15 % obstacles, regions of 4 to 14 by 2 to 3 cells, each passable with "
            "probability one half; boxes with a colour and a size, each meant with the same probability; 1 m/s, "
            f"delta_c = {SETTINGS.delta_c_s:.0f} s, alpha = 0, rule regret. A yes or no takes "
            f"{SETTINGS.reply_s:.0f} s, a choice 1.6 times as long."
        ),
        tables=tables(trials),
        notes=notes(trials, refused),
    )
    print(section.markdown())
    print(f"\n{time.perf_counter() - begun:.0f} s")
    if not options.quick:
        keep(section)


if __name__ == "__main__":
    main()
