"""How many small faults the tests notice: `python -m bench.mutants --map`, then `python -m bench.mutants --sample 300`.

`--map` runs the default tests once and notes which of them reach which line. Then each mutant of a stratified random
sample is tried against the tests that reach its line, the quickest first, stopping at the first failure. What is done
is kept in a folder; the same command goes on where it stopped. The sample is drawn in a fixed order for each seed, so
a part of it is a random sample too. A figure counts when no test was written after looking at the survivors of its
seed.

What counts: every changed expression inside of a function (`bench.mutations`), with two exceptions that no test should
hold: the text of messages, and `strict=` of `zip`, which only says what holds anyway.

An own driver, since the kept tools mutate the sources in place or run whole suites, and neither draws a sample.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import sys
from collections import defaultdict
from dataclasses import asdict

import pytest
from scipy.stats import binomtest

from bench.mutant_map import Mapper
from bench.mutant_trials import Fate, Trials
from bench.mutations import Mutant, mutants_of
from bench.sections import ROOT, Section, Table, keep

ROOMS = ("reasoning", "elicitation", "planning/checks.py", "mission", "mapping/fusion.py", "mapping/knowledge.py")
FOLDER = ROOT / "runs" / "mutants"
MAP = FOLDER / "map.json"
TESTS_S = 60.0
"""Each mutant is tried against the tests that reach its line, the quickest first, up to so many CPU seconds of them."""
Reached = dict[str, dict[str, list[str]]]


def all_mutants(seed: int) -> list[Mutant]:
    """Every mutant of the rooms, stratified: rooms take turns, in a random order that the seed decides."""
    package = ROOT / "src" / "mintpilot"
    rows = []
    for room in ROOMS:
        place = package / room
        files = [place] if place.suffix else sorted(place.rglob("*.py"))
        mutants = [m for file in files for m in mutants_of(file, ROOT)]
        random.Random(f"{seed} {room}").shuffle(mutants)
        rows.append(mutants)
    placed = [((i + 0.5) / len(row), m) for row in rows for i, m in enumerate(row)]
    return [mutant for _, mutant in sorted(placed, key=lambda pair: pair[0])]


def run_pytest(plugin: object, tests: list[str]) -> None:
    """Pytest in this process, with a plug-in of ours."""
    os.environ["HYPOTHESIS_PROFILE"] = "mutants"
    sys.path.insert(0, str(ROOT / "src"))
    pytest.main(["-n", "0", "-p", "no:cacheprovider", "--tb=no", f"--rootdir={ROOT}", *tests], plugins=[plugin])


def wanted(mutant: Mutant, reached: Reached, seconds: dict[str, float]) -> tuple[list[str], float]:
    """The tests that a mutant is tried against, and how long they take without it.

    Behind those that reach its line come the others of their files: they may use a world that the first one made.
    """
    lines = reached.get(mutant.file, {})
    first = {t for line in range(mutant.line, mutant.last + 1) for t in lines.get(str(line), ())}
    files = {test.partition("::")[0] for test in first}
    others = {test for test in seconds if test.partition("::")[0] in files} - first
    tests, total_s = [], 0.0
    for test in (*sorted(first, key=lambda t: (seconds[t], t)), *sorted(others, key=lambda t: (seconds[t], t))):
        if tests and total_s + seconds[test] > TESTS_S:
            break
        tests.append(test)
        total_s += seconds[test]
    return tests, total_s


def section(results: dict[str, Fate], chosen: list[Mutant], seed: int, command: str) -> Section:
    """The part of docs/results.md; a mutant that no test reaches counts as alive."""
    rows, by_room = [], defaultdict(list)
    tried = [mutant for mutant in chosen if mutant.id in results]
    for mutant in tried:
        by_room[mutant.file.split("/")[2]].append(results[mutant.id].killed)
    by_room["**all**"] = [fate for fates in list(by_room.values()) for fate in fates]
    for room, fates in by_room.items():
        exact = binomtest(sum(fates), len(fates)).proportion_ci(0.95, method="exact") if fates else None
        interval = f"{exact.low:.2f} to {exact.high:.2f}" if exact is not None else ""
        share = f"{sum(fates) / len(fates):.2f}" if fates else ""
        rows.append([room, str(len(fates)), str(sum(fates)), share, interval])
    return Section(
        name="71-mutants",
        title="Small faults that the tests notice",
        command=command,
        how=f"{len(tried)} of a stratified random sample of {len(chosen)} (seed {seed}, not looked at while tests were "
        f"written), each against the tests that reach its line, the quickest first, up to {TESTS_S:.0f} s of them. "
        "Every changed expression inside of a function counts, except texts of messages and `strict=` of `zip`; one "
        "that no test reaches counts as alive.",
        tables=[Table(caption="", header=("room", "tried", "killed", "share", "exact 95 %"), rows=rows)],
        notes=[
            f"alive: `{m.file}` line {m.line}: {m.what} ({results[m.id].by})" for m in tried if not results[m.id].killed
        ],
    )


def main() -> None:
    """Makes the map, or tries the sample and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--map", action="store_true", help="note once which test reaches which line")
    parser.add_argument("--sample", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--most", type=int, default=300, help="try so many in this call")
    parser.add_argument("--keep", action="store_true", help="write docs/results.md")
    parser.add_argument("tests", nargs="*", default=["tests"], help="with --map: which tests")
    args = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    if args.map:
        sources = [f"src/mintpilot/{room}{'' if room.endswith('.py') else '/*'}" for room in ROOMS]
        run_pytest(Mapper(sources, MAP), args.tests)
        return
    known = json.loads(MAP.read_text())
    kept = FOLDER / f"results-{args.seed}.json"
    rows = json.loads(kept.read_text()) if kept.exists() else {}
    results = {name: Fate(**row) for name, row in rows.items()}
    chosen = all_mutants(args.seed)[: args.sample]

    def done(mutant: Mutant, fate: Fate) -> None:
        results[mutant.id] = fate
        kept.write_text(json.dumps({name: asdict(fate) for name, fate in results.items()}, indent=1))
        print(f"{'killed' if fate.killed else 'ALIVE '} {mutant.file}:{mutant.line} {mutant.what}: {fate.by}", file=out)

    left = [m for m in chosen if m.id not in results][: args.most]
    out = os.fdopen(os.dup(1), "w", buffering=1)
    if left:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what pytest says of each trial
        files = sorted({test.partition("::")[0] for test in known["seconds"]})
        run_pytest(Trials(left, lambda m: wanted(m, known["lines"], known["seconds"]), done), files)
    command = f"python -m bench.mutants --sample {args.sample} --seed {args.seed}"
    shown = section(results, chosen, args.seed, command)
    print(shown.markdown(), file=out)
    if args.keep:
        keep(shown)


if __name__ == "__main__":
    main()
