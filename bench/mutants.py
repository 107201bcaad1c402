"""How many small faults the tests notice: `python -m bench.mutants --map`, then `python -m bench.mutants --sample 300`.

`--map` runs the default tests once and notes which of them reach which line. Then each mutant of a stratified random
sample is put into a copy of the sources and tried against the tests that reach its line, cheapest first, stopping at
the first failure. What is done is kept in a folder; the same command goes on where it stopped. The sample is drawn in
a fixed order, so a part of it is a random sample too.

An own driver, since the kept tools mutate the sources in place or run whole suites, and neither draws a sample.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import subprocess
import sys
from collections import defaultdict
from pathlib import Path
from xml.etree import ElementTree

from scipy.stats import binomtest

from bench.mutations import Mutant, mutants_of
from bench.sections import ROOT, Section, Table, keep

ROOMS = ("reasoning", "elicitation", "planning/checks.py", "mission", "mapping/fusion.py", "mapping/knowledge.py")
FOLDER = ROOT / "runs" / "mutants"
TESTS_S = 60.0
"""Each mutant is tried against the tests that reach its line, the quickest first, up to so many seconds of them."""
HANGS = 5.0
"""A mutant whose tests take so many times as long as they do without it, and a minute more, has been noticed."""


def all_mutants() -> list[Mutant]:
    """Every mutant of the rooms, stratified: rooms take turns, in a random order that does not change."""
    package = ROOT / "src" / "mintpilot"
    rows = []
    for room in ROOMS:
        place = package / room
        files = [place] if place.suffix else sorted(place.rglob("*.py"))
        mutants = [m for file in files for m in mutants_of(file, ROOT)]
        random.Random(room).shuffle(mutants)
        rows.append(mutants)
    total = sum(map(len, rows))
    placed = [((i + 0.5) / len(row), m) for row in rows for i, m in enumerate(row)]
    assert len(placed) == total
    return [mutant for _, mutant in sorted(placed, key=lambda pair: pair[0])]


def make_map(tests: list[str]) -> None:
    """Runs the tests once with coverage, and keeps which test reaches which line.

    The contexts are coverage's own, names of test functions: those of pytest-cov stay empty in one process.
    """
    import coverage

    FOLDER.mkdir(parents=True, exist_ok=True)
    data, settings, times = FOLDER / "coverage", FOLDER / "coverage.ini", FOLDER / "times.xml"
    settings.write_text(f"[run]\nsource = mintpilot\ndynamic_context = test_function\ndata_file = {data}\n")
    words = [
        "run",
        f"--rcfile={settings}",
        "-m",
        "pytest",
        "-n",
        "0",
        "-p",
        "no:cacheprovider",
        f"--junitxml={times}",
        *tests,
    ]
    subprocess.run([sys.executable, "-m", "coverage", *words], cwd=ROOT, check=True)
    read = coverage.CoverageData(str(data))
    read.read()
    found: dict[str, dict[int, list[str]]] = {}
    for name in read.measured_files():
        lines = {
            line: sorted({where for c in contexts if (where := _test_of(c)) is not None})
            for line, contexts in read.contexts_by_lineno(name).items()
        }
        found[str(Path(name).resolve().relative_to(ROOT))] = {k: v for k, v in lines.items() if v}
    if not any(found.values()):
        raise SystemExit("no line was reached by any test: coverage kept no contexts, and mutants would all be alive")
    (FOLDER / "map.json").write_text(json.dumps(found))


def _test_of(context: str) -> str | None:
    """The file and function that pytest runs for one of coverage's contexts; the file alone for a state machine."""
    parts = context.split(".")
    for count in range(len(parts) - 1, 0, -1):
        file = Path("tests", *parts[:count]).with_suffix(".py")
        if (ROOT / file).is_file():
            inside = parts[count:]
            return "::".join([str(file), *inside]) if inside[-1].startswith("test") else str(file)
    return None


def durations() -> dict[str, float]:
    """Seconds that each test function and each file of tests takes, all its cases together."""
    found: dict[str, float] = defaultdict(float)
    for case in ElementTree.parse(FOLDER / "times.xml").iter("testcase"):
        seconds = float(case.get("time", 0))
        where = _test_of(f"{case.get('classname', '').removeprefix('tests.')}.{case.get('name', '').partition('[')[0]}")
        if where is not None:
            found[where] += seconds
            if "::" in where:
                found[where.partition("::")[0]] += seconds
    return found


def tried(mutant: Mutant, reached: dict[str, dict[str, list[str]]], seconds: dict[str, float]) -> str:
    """``killed``, ``survived``, or ``not reached`` by any test."""
    lines = reached.get(mutant.file, {})
    found = {t for line in range(mutant.line, mutant.last + 1) for t in lines.get(str(line), ())}
    if not found:
        return "not reached"
    tests, total_s = [], 0.0
    for test in sorted(found, key=lambda t: (seconds.get(t, 0.0), t)):
        if tests and total_s + seconds.get(test, 0.0) > TESTS_S:
            break
        tests.append(test)
        total_s += seconds.get(test, 0.0)
    copy = FOLDER / "copy"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(ROOT / "src", copy / "src", ignore=shutil.ignore_patterns("*.nbi", "*.nbc", "*.pyc"))
    target = copy / mutant.file
    target.write_text(mutant.applied(target.read_text(encoding="utf-8")), encoding="utf-8")
    environment = {
        **os.environ,
        "HYPOTHESIS_PROFILE": "repeatable",
        "PYTHONPATH": str(copy / "src"),
        "PYTHONDONTWRITEBYTECODE": "1",
        "NUMBA_CACHE_DIR": str(FOLDER / "numba"),
    }
    words = [sys.executable, "-m", "pytest", "-n", "0", "-x", "-q", "-p", "no:cacheprovider", *tests]
    try:
        done = subprocess.run(
            words, cwd=ROOT, env=environment, capture_output=True, timeout=60 + HANGS * total_s, check=False
        )
    except subprocess.TimeoutExpired:
        return "killed"
    return "survived" if done.returncode == 0 else "killed"


def section(results: dict[str, str], chosen: list[Mutant], wanted: int) -> Section:
    """The part of docs/results.md; a mutant that no test reaches counts as alive."""
    rows, by_room = [], defaultdict(list)
    for mutant in chosen:
        if mutant.id in results:
            by_room[mutant.file.split("/")[2]].append(results[mutant.id] == "killed")
    by_room["**all**"] = [fate for fates in list(by_room.values()) for fate in fates]
    for room, fates in by_room.items():
        exact = binomtest(sum(fates), len(fates)).proportion_ci(0.95, method="exact") if fates else None
        share = f"{exact.low:.2f} to {exact.high:.2f}" if exact is not None else ""
        rows.append([room, str(len(fates)), str(sum(fates)), share])
    alive = [m for m in chosen if results.get(m.id, "killed") != "killed"]
    return Section(
        name="71-mutants",
        title="Small faults that the tests notice",
        command=f"python -m bench.mutants --sample {wanted}",
        how=f"{len(by_room['**all**'])} of a stratified random sample of {wanted}, each against the tests that reach "
        f"its line, the quickest first, up to {TESTS_S:.0f} s of them. One that no test reaches counts as alive.",
        tables=[Table(caption="", header=("room", "tried", "killed", "share killed, exact 95 %"), rows=rows)],
        notes=[f"alive: `{m.file}` line {m.line}: {m.what} ({results[m.id]})" for m in alive],
    )


def main() -> None:
    """Makes the map, or tries the sample and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--map", action="store_true", help="note once which test reaches which line")
    parser.add_argument("--sample", type=int, default=300)
    parser.add_argument("--most", type=int, default=300, help="try so many in this call")
    parser.add_argument("--keep", action="store_true", help="write docs/results.md")
    parser.add_argument("tests", nargs="*", default=["tests"], help="with --map: which tests")
    args = parser.parse_args()
    if args.map:
        make_map(args.tests)
        return
    reached = json.loads((FOLDER / "map.json").read_text())
    seconds = durations()
    kept = FOLDER / "results.json"
    results: dict[str, str] = json.loads(kept.read_text()) if kept.exists() else {}
    chosen = all_mutants()[: args.sample]
    for mutant in [m for m in chosen if m.id not in results][: args.most]:
        results[mutant.id] = tried(mutant, reached, seconds)
        kept.write_text(json.dumps(results, indent=1))
        print(f"{results[mutant.id]:12} {mutant.file}:{mutant.line} {mutant.what}", flush=True)
    done = section(results, chosen, args.sample)
    print(done.markdown())
    if args.keep:
        keep(done)


if __name__ == "__main__":
    main()
