"""The search against its targets, as ratios within one run.

python -m bench.search             # everything, several minutes; writes the section of docs/results.md
python -m bench.search --quick     # small grids, one pair each; writes nothing
python -m bench.search --json FILE # the rows as JSON as well
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from statistics import median
from typing import TypeVar

import numpy as np

from bench.search_baselines import PlainC, Scipy, Skimage, compiled
from bench.search_memory import peak_mib
from bench.search_occupancy import depot
from bench.search_worlds import Cell3, World, adversarial_regions, far_pairs, warehouse_2d, warehouse_3d
from bench.sections import Section, Table, keep
from mintpilot.core.geometry import Ints
from mintpilot.planning.grid_search import GridSearch
from mintpilot.planning.joint_search import JointSearch

T = TypeVar("T")
REPEATS = 7


@dataclass(frozen=True, kw_only=True)
class Single:
    """One query on one world: milliseconds, median of seven."""

    world: str
    length: float
    ours_ms: float
    plain_c_ms: float
    scipy_ms: float
    skimage_ms: float
    cutting_ms: float
    """Ours under scikit-image's rule (corners may be cut), where costs were compared."""


@dataclass(frozen=True, kw_only=True)
class Joint:
    """All joint hypotheses of k regions on one world."""

    world: str
    k: int
    single_ms: float
    joint_ms: float
    """Set-up of the regions included."""
    naive_ms: float
    """One search per hypothesis with only the moves near blocked regions patched; extrapolated if ``of`` < 2^k."""
    of: int
    """Number of hypotheses replanned, whose costs were compared."""
    paths: int
    labels: int


def timed(work: Callable[[], T], repeats: int = REPEATS) -> tuple[T, float]:
    """The result, and milliseconds (median)."""
    result = work()
    spent = []
    for _ in range(repeats):
        begun = time.perf_counter()
        result = work()
        spent.append(1000 * (time.perf_counter() - begun))
    return result, median(spent)


def length_of(search: GridSearch, start: Cell3, goal: Cell3) -> float:
    """Length of the shortest path, edges."""
    found = search.shortest_path(start, goal)
    return np.inf if found is None else found[0]


def single_rows(worlds: list[World], pairs: int) -> list[Single]:
    """Single queries; every cost is checked to 1e-9."""
    library = compiled()
    rows = []
    for world in worlds:
        search, cutting = GridSearch(world.free), GridSearch(world.free, cut_corners=True)
        plain, scipy, skimage = PlainC(library, search), Scipy(search), Skimage(world.free)
        slow = 3 if world.free.size > 1_000_000 else REPEATS
        for start, goal in far_pairs(world, pairs):
            ours, ours_ms = timed(partial(length_of, search, start, goal))
            cut, cutting_ms = timed(partial(length_of, cutting, start, goal))
            c, c_ms = timed(partial(plain.cost, start, goal))
            s, s_ms = timed(partial(scipy.cost, start, goal), slow)
            i, i_ms = timed(partial(skimage.cost, start, goal), slow)
            for other, mine in ((c, ours), (s, ours), (i, cut)):
                if abs(other - mine) > 1e-9:
                    raise AssertionError(f"{world.name}, {start} to {goal}: {mine} here, {other} there")
            rows.append(
                Single(
                    world=world.name,
                    length=ours,
                    ours_ms=ours_ms,
                    plain_c_ms=c_ms,
                    scipy_ms=s_ms,
                    skimage_ms=i_ms,
                    cutting_ms=cutting_ms,
                )
            )
        plain.close()
    return rows


def joint_row(name: str, search: JointSearch, ends: tuple[Cell3, Cell3], most: int) -> Joint:
    """One joint search against replanning; every compared cost agrees to 1e-9."""
    k = len(search.regions)

    def everything() -> object:
        search.forget()
        return search.between(*ends)

    found = search.between(*ends)
    labels = search.labels
    hypotheses = np.random.default_rng(0).permutation(1 << k)[:most].tolist()
    alone: list[tuple[float, Ints] | None] = []
    single, joint, naive = [], [], 0.0
    for part in np.array_split(hypotheses, REPEATS):
        single.append(timed(lambda: search.grid.shortest_path(*ends), 1)[1])
        joint.append(timed(everything, 1)[1])
        begun = time.perf_counter()
        alone += [search.under(*ends, int(h)) for h in part]
        naive += 1000 * (time.perf_counter() - begun)
    for h, one in zip(hypotheses, alone, strict=True):
        way = found.best(h)
        if (way is None) != (one is None) or (way and one and abs(way.cost - one[0]) > 1e-9):
            raise AssertionError(f"{name}, hypothesis {h:b}: {way and way.cost} here, {one and one[0]} alone")
    return Joint(
        world=name,
        k=k,
        single_ms=median(single),
        joint_ms=median(joint),
        naive_ms=naive * (1 << k) / len(hypotheses),
        of=len(hypotheses),
        paths=len(found.paths),
        labels=labels,
    )


def joint_rows(plan: list[tuple[World, tuple[int, ...]]], pairs: int, most: int) -> list[Joint]:
    """Joint searches with adversarial regions."""
    rows = []
    for world, counts in plan:
        for k in counts:
            for number, ends in enumerate(far_pairs(world, pairs)):
                regions: list[Ints] = adversarial_regions(world, ends, k, 100 * k + number)
                rows.append(joint_row(world.name, JointSearch(world.free, regions), ends, most))
    return rows


def grouped(rows: list[T], key: Callable[[T], tuple[object, ...]]) -> dict[tuple[object, ...], list[T]]:
    """Rows by key, in the order of their first appearance."""
    groups: dict[tuple[object, ...], list[T]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def tables(singles: list[Single], joints: list[Joint], peak: float | None) -> list[Table]:
    """The tables of the section: medians over the pairs, with the worst."""
    one = []
    for (world,), group in grouped(singles, lambda r: (r.world,)).items():
        c = [r.ours_ms / r.plain_c_ms for r in group]
        scipy = [r.scipy_ms / r.ours_ms for r in group]
        skimage = [r.skimage_ms / r.cutting_ms for r in group]
        one.append(
            [
                str(world),
                str(len(group)),
                f"{median(r.ours_ms for r in group):.2f} ms",
                f"{median(c):.2f} (worst {max(c):.2f})",
                f"{median(scipy):.0f} (least {min(scipy):.0f})",
                f"{median(skimage):.0f} (least {min(skimage):.0f})",
            ]
        )
    many = []
    for (world, k), group in grouped(joints, lambda r: (r.world, r.k)).items():
        ratio = [r.joint_ms / r.single_ms for r in group]
        gain = [r.naive_ms / r.joint_ms for r in group]
        many.append(
            [
                str(world),
                str(k),
                str(len(group)),
                f"{median(r.joint_ms for r in group):.1f} ms (worst {max(r.joint_ms for r in group):.1f})",
                f"{median(ratio):.1f} (worst {max(ratio):.1f})",
                f"{median(gain):.0f} (least {min(gain):.0f})",
                f"{min(r.of for r in group)}",
                f"{median(r.paths for r in group):.0f}",
                f"{median(r.labels for r in group):.0f}",
            ]
        )
    made = [
        Table(
            caption="Single query",
            header=("grid", "pairs", "time", "time / plain C", "scipy / time", "scikit-image / time"),
            rows=one,
        ),
        Table(
            caption="All 2^k joint hypotheses",
            header=(
                "grid", "k", "pairs", "time", "single queries", "naive / time", "hypotheses checked", "paths", "labels",
            ),
            rows=many,
        ),
    ]  # fmt: skip
    if peak is not None:
        made.append(
            Table(caption="Memory", header=("grid", "k", "peak"), rows=[["256 x 256 x 64", "10", f"{peak:.0f} MiB"]])
        )
    return made


def section(tables_made: list[Table], command: str) -> Section:
    """The section of docs/results.md."""
    return Section(
        name="20-search",
        title="Search",
        command=command,
        how=(
            "Times are medians of 7, warm, in one process; lines give the median over pairs of far cells. *Plain C* "
            "is `bench/search_plain_astar.c`, built with `gcc -O3 -march=native` by the benchmark. scipy gets a graph "
            "with the same moves, built beforehand. scikit-image knows one rule only, corners may be cut: it is "
            "compared with this search under that rule. All costs agree to 1e-9, or the benchmark fails. Regions are "
            "adversarial: each is centred on the best path left when the earlier ones are blocked. *Naive* is one "
            "search per hypothesis with this very search, the moves near blocked regions patched; where fewer than 2^k "
            "hypotheses were checked its time is extrapolated. The joint time includes laying the regions on the grid. "
            "Single, joint and naive times are taken by turns, in seven rounds, so that all suffer alike when the "
            "machine slows down."
        ),
        tables=tables_made,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small grids, one pair each; writes nothing")
    parser.add_argument("--json", type=Path, help="file for the rows")
    options = parser.parse_args()
    flat, flat_big = warehouse_2d(512), warehouse_2d(1024)
    hall, hall_big = warehouse_3d(100, 75, 20, (3, 4, 6)), warehouse_3d(200, 150, 40, (5, 6, 12))
    if options.quick:
        singles = single_rows([warehouse_2d(256), hall], 1)
        joints = joint_rows([(warehouse_2d(256), (4, 8)), (hall, (4,))], 1, 64)
        peak = None
    else:
        singles = single_rows([flat, flat_big, hall, hall_big], 5)
        joints = joint_rows([(flat, (8, 10, 16)), (flat_big, (8, 10)), (hall, (8, 10)), (hall_big, (8, 10))], 5, 256)
        peak = peak_mib(10)
    if (row := depot(options.quick)) is not None:
        joints.append(joint_row(*row, 256))
    made = tables(singles, joints, peak)
    print("\n\n".join(t.markdown() for t in made))
    if options.json:
        data = {"single": [asdict(r) for r in singles], "joint": [asdict(r) for r in joints], "peak_mib": peak}
        options.json.write_text(json.dumps(data, indent=1) + "\n")
    if not options.quick:
        keep(section(made, "python -m bench.search"))


if __name__ == "__main__":
    main()
