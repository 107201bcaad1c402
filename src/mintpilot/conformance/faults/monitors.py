"""Monitors: each says what a mission did wrong, by the ledger and the truth. They share no code with it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from mintpilot.assembly.worlds import World
from mintpilot.conformance.faults import geometry, told_monitor
from mintpilot.conformance.faults.kinds import ENDS, Fault, FaultKind, rule_of
from mintpilot.conformance.faults.ledger import INTRUDER, Commanded, Ledger, Said
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.motion import FollowTrajectory, Land
from mintpilot.core.query import Query, Standing
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap

ROUNDING_M = 1e-6
TRACK_M = 0.2
"""Whoever goes back the way it came is nearer than this to where it has been."""
PAD_M = 0.7
"""So near to its start it may land: whoever put it down there vouches for the ground."""
WITHIN_M = 0.03
"""Touches that differ by less than this are the same for both geometries."""
STILL_MPS = 0.1
STARVED_S = 0.5
"""The mission is looked at ten times as often: what is longer is the machine's delay."""
PASSABLE = "passable"
VOICE = "voice"
CONFIRMED_S = 30.0
"""Whoever confirms by voice says so at most this long before it counts."""
_FAILURES = (Outcome.COLLISION, Outcome.TOXIC_SMOKE, Outcome.LEFT_VOLUME, Outcome.ENDURANCE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Breach:
    """One thing that a mission did wrong."""

    rule: str
    """Short stable name."""
    what: str
    """One sentence."""


def judged(ledger: Ledger, world: World, verdict: Verdict | None) -> Iterator[Breach]:
    """All that was wrong. ``verdict`` is None where the process died before its end."""
    yield from moved_safely(ledger, world)
    yield from commanded_safely(ledger, world)
    yield from became_safe(ledger, verdict)
    yield from let_nobody_in(ledger)
    if ledger.crashed and ledger.beyond_s == np.inf:
        yield Breach(rule="touch", what=ledger.crashed)
    if ledger.left_flying:
        yield Breach(rule="left flying", what=ledger.left_flying)
    if verdict is not None:
        yield from told_the_truth(ledger, world, verdict)
        if not ledger.held:
            yield Breach(rule="left flying", what="the vehicle was not told to hold at the end")


def let_nobody_in(ledger: Ledger) -> Iterator[Breach]:
    """Nobody is heard who has no right to be."""
    for name in sorted(ledger.heard):
        if INTRUDER in name:
            yield Breach(rule="let in", what=f"'{name}' was heard")
    for said in ledger.said:
        if said.operator == VOICE and said.answer.standing is Standing.CONFIRMED:
            before = [words for at_s, words in ledger.spoken if said.time_s - CONFIRMED_S <= at_s <= said.time_s]
            if not any("confirm" in words for words in before):
                yield Breach(rule="let in", what=f"at {said.time_s:.2f} s a confirmation was heard that nobody gave")


def touches(ledger: Ledger, world: World, *, more_m: float = 0.0, until_s: float = np.inf) -> str:
    """What was touched until then, with a hull that is larger by so much."""
    trace = ledger.array()
    trace = trace[trace[:, 0] <= until_s]
    if not len(trace):
        return ""
    points = geometry.densely(trace[:, 1:])
    times = np.interp(np.linspace(0, 1, len(points)), np.linspace(0, 1, len(trace)), trace[:, 0])
    rules = world.rules
    return geometry.touched(points, times, world.scene, rules.radius_m + more_m, rules.half_height_m + more_m)


def moved_safely(ledger: Ledger, world: World) -> Iterator[Breach]:
    """Nothing is touched; and no place is flown that the map of a moment ago does not call free.

    Once the position is not known the mission cannot say where on the map it is: from then on only touches count here,
    and landings are judged by where it was told to be (`commanded_safely`).
    """
    what = touches(ledger, world, until_s=ledger.beyond_s)
    if what:
        yield Breach(rule="touch", what=f"it touched '{what}'")
    trace = ledger.array()
    trace = trace[trace[:, 0] <= ledger.beyond_s]
    late_s = rule_of(FaultKind.DEPTH_WRONG).within_s
    if len(trace) < 3 or not ledger.maps:
        return
    lost_s = min((at for at, kind, _ in ledger.known if kind is FaultKind.POSITION_LOST), default=np.inf)
    trace = trace[trace[:, 0] <= lost_s]
    times = np.array([at for at, _ in ledger.maps])
    speed = np.r_[np.zeros(min(1, len(trace))), np.linalg.norm(np.diff(trace[:, 1:], axis=0), axis=1)]
    which = np.searchsorted(times, trace[:, 0] - late_s, side="right") - 1
    for number in np.unique(which[which >= 0]):
        rows = np.flatnonzero((which == number) & (speed > 1e-4) & ~_descending(ledger, trace[:, 0]))
        if not len(rows):
            continue
        inside = _not_free(trace[rows, 1:], ledger.maps[number][1])
        for row in rows[inside]:
            since = ledger.maps[number + 1 : int(np.searchsorted(times, trace[row, 0], side="right"))]
            still = all(_not_free(trace[row, 1:][None], map).all() for _, map in since)
            if still and not _been_there(trace[row, 1:][None], trace[: max(row - 40, 1), 1:]).all():
                yield Breach(
                    rule="flown where the map says no",
                    what=f"at {trace[row, 0]:.2f} s it flew on through a cell that was not free for {late_s:g} s",
                )
                return


def commanded_safely(ledger: Ledger, world: World) -> Iterator[Breach]:
    """Every trajectory and every descent stays, with the whole body, in what was known free when it was commanded."""
    over = {kind: at for at, kind, _ in reversed(ledger.known) if kind in (FaultKind.PILOT, FaultKind.LINK_LOST)}
    for order in ledger.commands:
        for kind, at_s in over.items():
            if order.time_s > at_s:
                yield Breach(rule="commanded after hands off", what=f"at {order.time_s:.2f} s, after {kind.value}")
        map = ledger.maps[order.maps - 1][1] if order.maps else None
        if isinstance(order.motion, FollowTrajectory):
            if map is None:
                yield Breach(rule="flown without a map", what=f"at {order.time_s:.2f} s")
                continue
            yield from _flight_is_known(order, map, ledger, world)
            yield from _flight_is_free(order, ledger, world)
        elif isinstance(order.motion, Land) and map is not None:
            yield from _landing_is_known(order, map, ledger, world)


def _flight_is_known(order: Commanded, map: SemanticMap, ledger: Ledger, world: World) -> Iterator[Breach]:
    assert isinstance(order.motion, FollowTrajectory)
    points = geometry.densely(np.asarray(order.motion.trajectory.position_m, float))
    radius = world.mission.limits.radius_m
    flown = ledger.array()
    flown = flown[flown[:, 0] <= order.time_s][:, 1:]
    drawn = told_monitor.drawn_over(points, order, ledger)
    if drawn.any() and not _been_there(points[drawn], flown).all():
        x, y, _ = points[drawn][0]
        yield Breach(rule="flown where drawn", what=f"commanded at {order.time_s:.2f} s, over ({x:.2f}, {y:.2f})")
    gaps = geometry.gap_to_cells(points, barred_cells(map, order, ledger, world), map.frame, radius)
    wanted = min(radius, float(gaps[0])) - ROUNDING_M if gaps[0] > 0 else radius - ROUNDING_M
    short = gaps < wanted
    if not short.any() or _been_there(points[short], flown).all():
        return
    at = points[short][0]
    yield Breach(
        rule="flown where not known free",
        what=f"commanded at {order.time_s:.2f} s: {float(gaps[short].min()):.2f} m of {radius:.2f} m clear at "
        f"({at[0]:.2f}, {at[1]:.2f}, {at[2]:.2f})",
    )


def _flight_is_free(order: Commanded, ledger: Ledger, world: World) -> Iterator[Breach]:
    """By the truth: a commanded flight touches nothing, whatever the map says, unless it is broken off in time."""
    assert isinstance(order.motion, FollowTrajectory)
    off_m = np.asarray(ledger.at(order.time_s)) - np.asarray(order.at_m)
    points = geometry.densely(np.asarray(order.motion.trajectory.position_m, float)) + off_m
    rules, times = world.rules, np.full(len(points), order.time_s)
    what = geometry.touched(points, times, world.scene, rules.radius_m, rules.half_height_m)
    if what and order.time_s < ledger.beyond_s:
        yield Breach(rule="commanded into something", what=f"at {order.time_s:.2f} s into '{what}'")


def _landing_is_known(order: Commanded, map: SemanticMap, ledger: Ledger, world: World) -> Iterator[Breach]:
    at_start_m = np.linalg.norm(np.asarray(order.at_m[:2]) - world.mission.start_m[:2])
    if map.frame.is_flat or at_start_m <= PAD_M:
        return
    barred = barred_cells(map, order, ledger, world)
    nz, ny, nx = barred.shape
    x, y, z = ((np.asarray(order.at_m) - np.asarray(map.frame.origin_m)) // map.frame.resolution_m).astype(int)
    if not (0 <= x < nx and 0 <= y < ny):
        yield Breach(rule="landed where not known free", what=f"at {order.time_s:.2f} s, outside of the map")
        return
    column = map.cells[: min(z, nz - 1) + 1, y, x][::-1]
    block = barred[: min(z, nz - 1) + 1, y, x][::-1]
    ground = np.flatnonzero(column == Cell.OCCUPIED)
    last = int(ground[0]) if len(ground) else len(column)
    if block[:last].any():
        yield Breach(rule="landed where not known free", what=f"at {order.time_s:.2f} s, at ({x}, {y}) cells")


def _not_free(points: Floats, map: SemanticMap) -> Bools:
    """Which of the points (n, 3) lie in cells that are not free."""
    gaps = geometry.gap_to_cells(points, map.cells != Cell.FREE, map.frame, map.frame.resolution_m)
    return np.asarray(gaps <= 0)


def _descending(ledger: Ledger, times_s: Floats) -> Bools:
    """At which times (n,) the last motion that was commanded is a descent."""
    commanded = np.array([order.time_s for order in ledger.commands])
    lands = np.array([isinstance(order.motion, Land) for order in ledger.commands], bool)
    last = np.searchsorted(commanded, times_s, side="right") - 1
    return np.asarray((last >= 0) & lands[last]) if len(lands) else np.zeros(len(times_s), bool)


def _been_there(points: Floats, flown: Floats) -> Bools:
    """Which of the points (n, 3) are near to where the vehicle has been (m, 3)."""
    if not len(flown):
        return np.zeros(len(points), bool)
    gaps = np.array([np.linalg.norm(flown - point, axis=1).min() for point in points])
    return np.asarray(gaps <= TRACK_M)


def barred_cells(map: SemanticMap, order: Commanded, ledger: Ledger, world: World) -> Bools:
    """What may not be flown by that command: all that is not free, and every region without a yes that still counts."""
    barred = np.array(map.cells != Cell.FREE)
    given = {region.id for region in world.map.regions if region.passable is Knowledge.YES}
    for region in map.regions:
        if told_monitor.blocked(region.id, order, ledger) or not (
            region.id in given
            or allowed(region.id, region.cells, order.time_s, ledger, world, heard=order.said)
            or _told_passable(region.id, region.cells, order, ledger, world)
        ):
            barred.ravel()[region.cells] = True
    return barred


def _told_passable(region: str, cells: Ints, order: Commanded, ledger: Ledger, world: World) -> bool:
    """Whether a fact that was told and confirmed opens these cells: the outline of the map at that time covers them."""
    for told_s in told_monitor.opened(region, order, ledger, world.mission.asking.answer_valid_s):
        shown = [map for at_s, map in ledger.maps if at_s <= told_s][-1:]
        outlines = [r.cells for map in shown for r in map.regions if r.id == region]
        if outlines and _covers(outlines[0], cells, world):
            return True
    return False


def _covers(outline: Ints, cells: Ints, world: World) -> bool:
    flags = np.zeros(world.map.frame.shape, bool)
    flags.ravel()[outline] = True
    return bool(geometry.grown(flags).ravel()[cells].all())


def allowed(region: str, cells: Ints, time_s: float, ledger: Ledger, world: World, *, heard: int | None = None) -> bool:
    """Whether somebody's explicit yes for a region counts at that time, and covers these cells."""
    gap, covered, since_s = f"obstacle:{region}", None, -np.inf
    for said in ledger.said[:heard]:
        shown = ledger.shown.get(said.question)
        if said.time_s > time_s or shown is None or gap not in shown.question.query.gap_ids:
            continue
        if said.operator == VOICE and said.answer.standing is not Standing.CONFIRMED and said.answer.part == 0:
            continue  # a spoken yes is read back
        open_ = ledger.withdrawn.get(said.question, np.inf) >= said.time_s
        if open_ and said.answer.standing is not Standing.UNCONFIRMED and _says(shown.question.query, said, gap):
            outlines = [r.cells for _, m in ledger.maps[: shown.maps][-1:] for r in m.regions if r.id == region]
            covered, since_s = (outlines[0] if outlines else None), said.time_s
        elif not open_ and said.answer.part is not None and not _says(shown.question.query, said, gap):
            covered = None
    if covered is None or time_s >= since_s + world.mission.asking.answer_valid_s:
        return False
    return _covers(covered, cells, world)


def _says(query: Query, said: Said, gap: str) -> bool:
    """Whether that answer says outright that the region is passable."""
    part = said.answer.part
    if part is None:
        return False
    if query.options:
        literals = query.options[part].literals if part < len(query.options) else ()
        joined_by_or = part < len(query.options) and query.options[part].combine.value == "any"
    else:
        literals, joined_by_or = (query.literals if part == 0 else ()), query.combine.value == "any"
    if joined_by_or and len(literals) > 1:
        return False
    return any(one.gap == gap and set(one.values) == {PASSABLE} for one in literals)


def became_safe(ledger: Ledger, verdict: Verdict | None) -> Iterator[Breach]:
    """After each fault that the mission was told of the safe state is there in time."""
    for at_s, kind, what in ledger.known:
        rule, took_s = rule_of(kind), safe_after(ledger, at_s)
        if kind in (FaultKind.PILOT, FaultKind.LINK_LOST, FaultKind.MOTOR_LOST):
            took_s = min(ledger.over_s, float(ledger.trace[-1][0])) - at_s
        took_s -= starved_s(ledger, at_s, at_s + took_s)
        if took_s > rule.within_s and verdict is not None:
            yield Breach(
                rule="not safe in time",
                what=f"{kind.value} {what} at {at_s:.2f} s: {rule.state} after {took_s:.1f} s, not {rule.within_s:g} s",
            )


def ended_in_time(ledger: Ledger, faults: Iterable[Fault]) -> Iterator[Breach]:
    """A mission that a fault leaves to itself is over in time, unless somebody let it hold."""
    end_s = min(ledger.over_s, ledger.now_s)
    if any(kind is FaultKind.ORDERS for _, kind, _ in ledger.known):
        return
    for fault in faults:
        took_s = end_s - fault.at_s - starved_s(ledger, fault.at_s, end_s)
        if rule_of(fault.kind) is ENDS and took_s > ENDS.within_s:
            yield Breach(rule="not safe in time", what=f"{fault.kind.value}: over after {took_s:.0f} s")


def starved_s(ledger: Ledger, at_s: float, until_s: float) -> float:
    """How long the machine did not let a mission on the wall's time run between these times, seconds."""
    if not ledger.on_the_wall:
        return 0.0
    times = ledger.array()[:, 0]
    gaps_s = np.diff(times[(times >= at_s - STARVED_S) & (times <= until_s)])
    return float(gaps_s[gaps_s > STARVED_S].sum())


def safe_after(ledger: Ledger, at_s: float) -> float:
    """Seconds from that time until the vehicle is at rest, or the mission over."""
    trace = ledger.array()
    after = trace[trace[:, 0] >= at_s - 0.11]
    if len(after) < 2:
        return 0.0
    steps = np.diff(after[:, 0])
    speed = np.linalg.norm(np.diff(after[:, 1:], axis=0), axis=1) / np.maximum(steps, 1e-9)
    rest = np.flatnonzero((speed < STILL_MPS) & (after[1:, 0] >= at_s))
    return max(0.0, float(after[1:, 0][rest[0]] if len(rest) else after[-1, 0]) - at_s)


def told_the_truth(ledger: Ledger, world: World, verdict: Verdict) -> Iterator[Breach]:
    """The verdict says what the monitors saw."""
    outcome, scene, trace = verdict.outcome, world.scene, ledger.array()
    lie = f"it is called {outcome.value}: {verdict.reason}"
    claims = outcome not in _FAILURES if ledger.simulated else outcome in (Outcome.SUCCESS, Outcome.PARTIAL)
    if claims and touches(ledger, world):
        yield Breach(rule="verdict", what=f"it touched something; {lie}")
    tilted_m = world.rules.radius_m if ledger.beyond_s < np.inf else WITHIN_M
    if outcome is Outcome.COLLISION and not touches(ledger, world, more_m=tilted_m):
        yield Breach(rule="verdict", what=f"it touched nothing; {lie}")
    points, rules = geometry.densely(trace[:, 1:]), world.rules
    smoked = any(
        geometry.inside_smoke(points, smoke.extent_m, rules.radius_m, rules.half_height_m).any()
        for smoke in scene.smokes
        if smoke.toxic
    )
    if smoked and outcome not in _FAILURES:
        yield Breach(rule="verdict", what=f"it was in toxic smoke; {lie}")
    kinds = {kind for _, kind, _ in ledger.known}
    if kinds & {FaultKind.LINK_LOST, FaultKind.MOTOR_LOST} and outcome in (Outcome.SUCCESS, Outcome.PARTIAL):
        yield Breach(rule="verdict", what=f"the vehicle was lost; {lie}")
    if outcome is Outcome.SUCCESS:
        yield from _really_done(trace, world, lie)


def _really_done(trace: Floats, world: World, lie: str) -> Iterator[Breach]:
    scene, rules = world.scene, world.rules
    for person in scene.persons:
        if person.must_be_found and not geometry.hovered_near(trace, person.position_m, rules.person_reach_m + 0.9):
            yield Breach(rule="verdict", what=f"nobody was near '{person.id}'; {lie}")
    for room in scene.rooms:
        wanted = room.occupant is not None and room.occupant.must_be_found
        if wanted and not geometry.hovered_near(trace, room.viewpoint_m, rules.look_reach_m):
            yield Breach(rule="verdict", what=f"nobody looked into '{room.id}'; {lie}")
    things = {solid.id: solid.extent_m for solid in scene.solids}
    for goal in scene.goal_objects:
        if goal in things:
            middle = things[goal].centre_m
            reach = rules.pick_reach_m + float(np.linalg.norm(things[goal].size_m)) / 2
            if not geometry.hovered_near(trace, middle, reach):
                yield Breach(rule="verdict", what=f"nobody was near '{goal}'; {lie}")
