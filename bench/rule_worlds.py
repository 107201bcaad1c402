"""Worlds and rules for `bench.rules`, and the plain search that its plans are compared with."""

from __future__ import annotations

import heapq
import itertools
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from tests.oracles import ltlf
from tests.planning.test_ruled_plans import box, problem_of

from mintpilot.core.errors import MintPilotError
from mintpilot.core.plan import PlanningProblem
from mintpilot.core.semantic_map import Cell
from mintpilot.mission_file.ruling import rule_faults
from mintpilot.mission_file.schema import MissionFile
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.rules.compiling import compile_formula
from mintpilot.rules.parsing import parse
from mintpilot.rules.satisfying import can_be_kept

Rule: TypeAlias = "dict[str, str] | str"
AREAS, PLACES = ("hall", "yard", "store"), ("p", "q", "r")
REGION = ("in({})", "touches({})", "inside({})", "within({}, 0.5)")
_EDGE_M = 0.5


def _atom(rng: np.random.Generator) -> str:
    """A proposition about something that every world of this bench has."""
    kind = rng.integers(10)
    if kind < 5:
        return str(rng.choice(REGION)).format(rng.choice((*AREAS, "smoke-1")))
    if kind < 8:
        return f"{rng.choice(('did', 'at'))}({rng.choice(PLACES)})"
    return str(rng.choice(("looked(room-1)", "within(the barrel, 1)")))


def _event(rng: np.random.Generator) -> str:
    return str(rng.choice((*(f"did({p})" for p in PLACES), "looked(room-1)", "in(hall)", "touches(yard)")))


def _rule(rng: np.random.Generator) -> Rule:
    match rng.integers(8):
        case 0:
            return {"never": _atom(rng)}
        case 1:
            return {"always": f"in({rng.choice(AREAS)})"} if rng.random() < 0.3 else {"never": _atom(rng)}
        case 2:
            return {"never": _atom(rng), "before": _event(rng)}
        case 3:
            return {"first": _event(rng), "then": _event(rng)}
        case 4:
            return {"after": _event(rng), "eventually": _event(rng)}
        case 5:
            return {"end": str(rng.choice(("in(hall)", "in(store)", "touches(yard)", "did(p)")))}
        case _:
            formula = ltlf.drawn(rng, ("a", "b", "c"), 2)
            names = {name: _atom(rng) for name in ("a", "b", "c")}
            said = ltlf.text(formula)
            for name in names:
                said = said.replace(f"at({name})", f"<{name}>")
            for name, atom in names.items():
                said = said.replace(f"<{name}>", atom)
            return said


def _lawful(rules: list[Rule]) -> bool:
    """Whether the mission file takes them."""
    file = world_file(np.random.default_rng(0), tuple(rules), deep=False)
    try:
        return not list(rule_faults(MissionFile.model_validate(file)))
    except (MintPilotError, ValueError):
        return False


def _sets(count: int) -> tuple[tuple[Rule, ...], ...]:
    found: list[tuple[Rule, ...]] = []
    for number in range(count):
        rng = np.random.default_rng([1714, number])
        while True:
            rules = [_rule(rng) for _ in range(1 + number % 5)]
            if _lawful(rules):
                found.append(tuple(rules))
                break
    return tuple(found)


def world_file(rng: np.random.Generator, rules: tuple[Rule, ...], *, deep: bool) -> dict[str, object]:
    """A mission file with these rules; its map is `write_map`."""
    nx, ny, height_m = (20, 14, 3.0) if deep else (24, 16, 2.0)
    wide, long = nx * _EDGE_M, ny * _EDGE_M

    def region(name: str, low: int, high: int) -> dict[str, object]:
        w, h = (float(v) * _EDGE_M for v in rng.integers(low, high, 2))
        x, y = (
            float(rng.integers(0, int((wide - w) / _EDGE_M) + 1)),
            float(rng.integers(0, int((long - h) / _EDGE_M) + 1)),
        )
        x, y = x * _EDGE_M, y * _EDGE_M
        top = float(rng.integers(2, 7)) * _EDGE_M if deep and rng.random() < 0.5 else height_m
        return {"id": name, "description": f"the {name}",
                "box": {"lo_m": [x, y, 0.0], "hi_m": [x + w, y + h, top]}}  # fmt: skip

    def place() -> list[float]:
        x, y = rng.uniform(1.0, wide - 1.0), rng.uniform(1.0, long - 1.0)
        return [round(float(x), 2), round(float(y), 2), *([round(float(rng.uniform(1.0, 2.0)), 2)] if deep else [])]

    areas = [{**region(name, 5, 13), "passable": True} for name in AREAS]
    smoke = {**region("smoke-1", 3, 7), "kind": "smoke", "truth": str(rng.choice(("passable", "blocked")))}
    x, y = (float(rng.integers(2, n - 2)) * _EDGE_M for n in (nx, ny))
    view = [x - 1.0 if x > wide / 2 else x + 1.5, y + 0.25, *([1.25] if deep else [])]
    (left, front, *_), (right, back, *_) = areas[0]["box"]["lo_m"], areas[0]["box"]["hi_m"]
    start = place()
    if rng.random() < 0.5:  # in the hall
        start[:2] = [(left + right) / 2, (front + back) / 2]
    world: dict[str, object] = {
        "map": "hall.3dmap" if deep else "hall.map",
        "resolution_m": _EDGE_M,
        "start_m": start,
        "regions": [*areas, smoke],
        "rooms": [{"id": "room-1", "description": "the closed room",
                   "door": {"lo_m": [x, y, 0.0], "hi_m": [x + _EDGE_M, y + _EDGE_M, height_m]},
                   "viewpoint_m": view, "truth": "absent"}],
        "objects": [{"id": "barrel-1", "label": "barrel", "position_m": [*place()[:2], 0.5],
                     "size_m": [0.5, 0.5, 1.0]}],
    }  # fmt: skip
    if not deep:
        world["height_m"] = 1.0
    lo, hi = smoke["box"]["lo_m"], smoke["box"]["hi_m"]
    if all(a - 1.0 <= v <= b + 1.0 for a, v, b in zip(lo[:2], start[:2], hi[:2], strict=True)):
        smoke["truth"] = "passable"  # it starts in the smoke, or beside it
    looks = any("looked" in str(rule) for rule in rules)
    goals = [{"action": "go", "position_m": place(), "id": name} for name in PLACES]
    if looks:
        goals.insert(int(rng.integers(4)), {"action": "look", "room": "room-1", "id": "room"})
    return {
        "mintpilot": 1,
        "name": "ruled",
        "instruction": "three places",
        "world": world,
        "goals": goals,
        "vehicle": {"radius_m": 0.2, "margin_m": 0.1, "return": str(rng.choice(("none", "required")))},
        "asking": {"failure_price_s": float(rng.choice((60.0, 600.0)))},
        "rules": list(rules),
    }


def write_map(rng: np.random.Generator, folder: Path, file: dict[str, object], *, deep: bool) -> None:
    """Blocks on the ground, and one where the door is."""
    nx, ny, nz = (20, 14, 6) if deep else (24, 16, 1)
    solid = np.zeros((nz, ny, nx), bool)
    for _ in range(int(rng.integers(2, 7))):
        w, h = rng.integers(1, 5, 2)
        x, y = rng.integers(0, nx - w), rng.integers(0, ny - h)
        solid[: int(rng.integers(2, nz + 1)) if deep else 1, y : y + h, x : x + w] = True
    room = file["world"]["rooms"][0]  # type: ignore[index]
    x, y = (round(v / _EDGE_M) for v in room["door"]["lo_m"][:2])
    solid[:, y, x] = True
    if deep:
        z, y, x = np.nonzero(solid)
        lines = [f"voxel {nx} {ny} {nz}", *(f"{a} {b} {c}" for a, b, c in zip(x, y, z, strict=True))]
        (folder / "hall.3dmap").write_text("\n".join(lines) + "\n")
        return
    drawn = "\n".join("".join("@" if cell else "." for cell in row) for row in solid[0])
    (folder / "hall.map").write_text(f"type octile\nheight {ny}\nwidth {nx}\nmap\n{drawn}\n")


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanCase:
    """One planning problem of small size, with what its oracle wants to know."""

    problem: PlanningProblem
    formulas: tuple[object, ...]
    areas: dict[str, NDArray[np.bool_]]
    goals: dict[str, tuple[int, int]]
    price_s: float

    def least(self) -> float | None:
        """Least seconds of all flights, what they leave undone counted; None where no stop can be done.

        Of its own: neighbours, labels (what holds within half a diagonal of a centre), and formulas by rewriting.
        """
        grid = np.asarray(self.problem.map.cells[0] == Cell.FREE)
        names, stops = sorted(self.areas), list(self.goals)
        truths = {cell: _truths(self.areas, names, cell) for cell in np.ndindex(grid.shape)}

        def after(rules: frozenset[object], held: frozenset[str], cell: tuple[int, ...]) -> frozenset[object]:
            found, coming = set[object](), set(rules)
            while coming:
                new = {tuple(ltlf.progressed(f, option | held) for f in rule) for rule in coming
                       for option in truths[cell]}  # fmt: skip
                coming = new - found
                found |= new
                if len(found) > 60:
                    raise OverflowError
            return frozenset(found)

        begins = frozenset(name for name in names if self.areas[name][0, 0])  # where it starts is known exactly
        begun = tuple(ltlf.progressed(("now", f), begins) for f in self.formulas)
        first = after(frozenset({begun}), frozenset(), (0, 0))
        ticks = itertools.count()
        heap = [(0.0, next(ticks), (0, 0), 0, first)]
        seen, best = set[object](), np.inf
        while heap:
            cost, _, cell, done, rules = heapq.heappop(heap)
            if cost >= best:
                break
            if (cell, done, rules) in seen or any(False in rule for rule in rules):
                continue
            seen.add((cell, done, rules))
            if len(seen) > 20_000:
                raise OverflowError
            if done and all(ltlf.may_end(f) for rule in rules for f in rule):
                best = min(best, cost + self.price_s * (len(stops) - done.bit_count()))
            held = frozenset(stops[i] for i in range(len(stops)) if done >> i & 1)
            for i, name in enumerate(stops):
                if self.goals[name] == cell and not done >> i:
                    there = after(rules, held | {name}, cell)
                    heapq.heappush(heap, (cost, next(ticks), cell, done | 1 << i, there))
            for dy, dx in itertools.product((-1, 0, 1), repeat=2):
                to = (cell[0] + dy, cell[1] + dx)
                swept = {to, (cell[0] + dy, cell[1]), (cell[0], cell[1] + dx)}
                inside = all(0 <= y < grid.shape[0] and 0 <= x < grid.shape[1] for y, x in swept)
                if to != cell and inside and all(grid[s] for s in swept):
                    heapq.heappush(
                        heap, (cost + float(np.hypot(dy, dx)), next(ticks), to, done, after(rules, held, to))
                    )
        return None if np.isinf(best) else best


def _truths(areas: dict[str, NDArray[np.bool_]], names: list[str], cell: tuple[int, ...]) -> list[frozenset[str]]:
    """Every truth of the areas that may be met within half a diagonal of a cell's centre (a corner alone is not)."""
    options = []
    for name in names:
        inside, (y, x) = areas[name], cell
        beside = [(y, x), (y - 1, x), (y + 1, x), (y, x - 1), (y, x + 1)]
        around = [bool(inside[a, b]) for a, b in beside if 0 <= a < inside.shape[0] and 0 <= b < inside.shape[1]]
        options.append((True,) if all(around) else (True, False) if any(around) else (False,))
    return [frozenset(n for n, v in zip(names, values, strict=True) if v) for values in itertools.product(*options)]


def plan_case(number: int) -> PlanCase:
    """The case of that number: 6 x 7 cells, two areas, two or three stops, one to three random formulas."""
    for draw in itertools.count():
        rng = np.random.default_rng([1715, number, draw])
        shape = (6, 7)
        ground = rng.random(shape) > 0.12
        areas = {}
        for name in ("p", "q"):
            y, x = (int(v) for v in rng.integers(0, 4, 2))
            areas[name] = box((y, y + int(rng.integers(2, 4))), (x, x + int(rng.integers(2, 4))), shape)
        goals = {name: (int(rng.integers(6)), int(rng.integers(7))) for name in "abc"[: int(rng.integers(2, 4))]}
        for cell in ((0, 0), *goals.values()):
            ground[cell] = True
        names = ["p", "q", *goals]
        formulas = tuple(ltlf.drawn(rng, names, 2) for _ in range(int(rng.integers(1, 4))))
        said = [ltlf.text(f, {"p": "in", "q": "in"} | dict.fromkeys(goals, "did")) for f in formulas]
        price_s = float(rng.choice((5.0, 600.0)))
        try:
            if not all(can_be_kept(compile_formula(parse(text))) for text in said):
                continue
            problem = problem_of(ground, areas, goals, said)
            problem = replace(problem, stops=tuple(replace(stop, price_s=price_s) for stop in problem.stops))
            case = PlanCase(problem=problem, formulas=formulas, areas=areas, goals=goals, price_s=price_s)
            if case.least() is None and rng.random() < 0.9:
                continue  # few of those for which there is no plan
            GridPlanner().open(problem)
        except (OverflowError, MintPilotError):  # too large for the other search, or nothing can be reached at all
            continue
        return case
    raise AssertionError


_LONE: tuple[tuple[Rule, ...], ...] = (
    ({"never": "touches(hall)"},),
    ({"always": "in(hall)"},),
    ({"never": "touches(smoke-1)", "before": "looked(room-1)"},),
    ({"first": "did(q)", "then": "in(yard)"},),
    ({"after": "at(p)", "eventually": "in(store)"},),
    ({"end": "in(hall)"},),
    ("(!touches(yard) U did(p)) | G !touches(yard)",),
)
PATTERNS = len(_LONE)
SETS = (*_LONE, *_sets(50))
"""One for each pattern of mission files, then random ones."""
