"""Asking without stopping, paired with holding, on Table 1's worlds. `python -m bench.waiting [--worlds 200] [--keep]`.

Two measures. Flown: whole missions on the kinematic simulator, with `asking.while_waiting` move and hold, in the same
worlds with the same answers, batteries long enough for all delays. Within battery: of the plan classes of the first
question that fit Table 1's old batteries, the mass that still fits when an answer comes after so many seconds.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, replace
from statistics import mean

import numpy as np

from bench.sections import Section, Table, keep
from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.benchmark.conditions import true_world
from mintpilot.benchmark.experiments import table1
from mintpilot.benchmark.methods import method_of
from mintpilot.benchmark.records import TrialRecord
from mintpilot.benchmark.trial import fly_trial
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import Assumptions
from mintpilot.core.ports import Ask
from mintpilot.core.trajectory import VehicleState
from mintpilot.mission.deliberation import prospects_of
from mintpilot.mission.rehearsal import begin
from mintpilot.planning.meanwhile import Wait, meanwhile

DELAYS_S = (3.0, 5.0, 10.0, 20.0)
SPARE_S = 40.0
"""How much longer the batteries last for each gap in the flown measure: twice the longest delay."""
MASS_AFTER_S = 10.0
WANTED = {3.0: 45, 5.0: 52, 10.0: 55, 20.0: 55}


@dataclass(frozen=True, kw_only=True)
class Pair:
    """One world under one delay."""

    seed: int
    delay_s: float
    held: TrialRecord
    moved: TrialRecord

    @property
    def same(self) -> bool:
        """Whether both did the same stops and reached the same people: only then their times compare."""
        return (self.held.outcome, self.held.stops_done, self.held.people_found) == (
            self.moved.outcome,
            self.moved.stops_done,
            self.moved.people_found,
        )

    @property
    def earlier_s(self) -> float:
        """By how much the moving drone was done sooner, seconds of the mission clock."""
        return self.held.flight_s - self.moved.flight_s


def pairs(worlds: int, first: int, delay_s: float) -> Iterator[Pair]:
    """The worlds in which something is asked."""
    experiment = table1(trials=worlds, seed=first, vehicle="kinematic", think=delay_s, spare_s=SPARE_S)
    cell = experiment.cells[0]
    for seed in range(first, first + worlds):
        flown = [
            fly_trial(experiment, cell, method_of(name), true_world(cell, seed)) for name in ("mint-holding", "mint")
        ]
        if flown[0].questions:
            yield Pair(seed=seed, delay_s=delay_s, held=flown[0], moved=flown[1])


def within_battery(worlds: int, first: int, after_s: float) -> tuple[float, float, int]:
    """(holding, moving, worlds): share of the feasible class mass still within the old battery after that delay."""
    experiment = table1(trials=worlds, seed=first, vehicle="kinematic", think=0)
    feasible = held = moved = 0.0
    count = 0
    for seed in range(first, first + worlds):
        world = true_world(experiment.cells[0], seed)
        # Nothing is left unasked because an answer would come too late: what waiting loses is to be seen.
        asking = replace(world.mission.asking, reply_s=0.0)
        world = replace(world, mission=replace(world.mission, asking=asking))
        parts = deliberation_parts(world, Choices())
        try:
            thought = begin(parts, world.map).deliberated()
        except InfeasibleError:
            continue
        if not isinstance(thought.decision, Ask):
            continue
        count += 1
        prospects = prospects_of(thought.situation, thought.decision.mint)
        classes = [p for p in prospects if p.probability > 0 and p.spare_s >= 0]
        feasible += sum(p.probability for p in classes)
        held += sum(p.probability for p in classes if p.spare_s >= after_s)
        problem = thought.situation.problem
        vehicle = VehicleState(time_s=0.0, position_m=problem.start_m, velocity_mps=(0.0, 0.0, 0.0), yaw_rad=0.0)
        vehicle, now_s, finished = _waited(Wait(
            prospects=prospects, asked_s=0.0, until_s=parts.settings.patience_s, now_s=0.0, finished=frozenset()
        ), after_s, problem, vehicle)  # fmt: skip
        for p in classes:
            again = parts.planner.open(_from(problem, vehicle, now_s, finished))
            plan = again.optimistic(p.given[0] if p.given else Assumptions())
            done = {leg.stop.id for leg in p.plan.legs} - finished
            fits = not done or (plan is not None and done <= {leg.stop.id for leg in plan.legs})
            moved += p.probability * fits
    return held / feasible, moved / feasible, count


def _waited(wait, after_s, problem, vehicle):
    """Where the drone is at rest, when, and what it has done, if the answer comes after that time."""
    now_s, finished = 0.0, frozenset()
    while now_s < after_s:
        what = meanwhile(replace(wait, now_s=now_s, finished=finished), problem.map, problem.limits, vehicle)
        if what.stop is not None:
            if now_s + what.stop.dwell_s > after_s:
                return vehicle, after_s, finished
            now_s, finished = now_s + what.stop.dwell_s, finished | {what.stop.id}
        elif what.trajectory is not None:
            way = what.trajectory
            if now_s + way.duration_s > after_s:
                # Braking from cruise speed takes 0.75 s, over half the way that is flown in it.
                at = min(len(way.time_s) - 1, int(np.searchsorted(way.time_s, after_s - now_s + 0.375)))
                x, y, z = (float(v) for v in way.position_m[at])
                return replace(vehicle, position_m=(x, y, z)), after_s + 0.75, finished
            now_s += way.duration_s
            x, y, z = (float(v) for v in way.position_m[-1])
            vehicle = replace(vehicle, position_m=(x, y, z), yaw_rad=float(way.yaw_rad[-1]))
        else:
            lost = [p.spare_s for p in wait.prospects if p.probability > 0 and p.spare_s > now_s]
            now_s = min([after_s, *(s + 0.05 for s in lost)])
    return vehicle, after_s, finished


def _from(problem, vehicle, now_s, finished):
    limits = replace(problem.limits, endurance_s=max(1e-3, problem.limits.endurance_s - now_s))
    stops = tuple(stop for stop in problem.stops if stop.id not in finished)
    return replace(problem, start_m=vehicle.position_m, limits=limits, stops=stops, finished=finished)


def interval(values: list[float]) -> str:
    """Mean with Student's interval, 95 %, by the normal quantile for more than 30."""
    spread = 1.96 * float(np.std(values, ddof=1)) / len(values) ** 0.5 if len(values) > 1 else 0.0
    return f"{mean(values):.2f} [{mean(values) - spread:.2f}, {mean(values) + spread:.2f}]"


def section(found: list[Pair], mass: tuple[float, float, int], worlds: int, command: str) -> Section:
    """The section of docs/results.md."""
    rows, notes = [], []
    for delay_s in sorted({p.delay_s for p in found}):
        alike = [p for p in found if p.delay_s == delay_s and p.same]
        every = [p for p in found if p.delay_s == delay_s]
        waited = sum(p.held.waited_s for p in alike)
        share = 100 * sum(p.earlier_s for p in alike) / waited
        believed = 100 * sum(p.moved.hidden_s for p in alike) / sum(p.moved.waited_s for p in alike)
        questions = [sum(getattr(p, side).questions for p in alike) / len(alike) for side in ("held", "moved")]
        rows.append(
            (
                f"{delay_s:g} s",
                str(len(alike)),
                f"{share:.1f} %",
                f"{WANTED[delay_s]} %" if delay_s in WANTED else "",
                interval([p.earlier_s for p in alike]),
                f"{min(p.earlier_s for p in alike):.2f}",
                f"{believed:.1f} %",
                f"{questions[0]:.2f} / {questions[1]:.2f}",
            )
        )
        other = [p.seed for p in every if not p.same]
        if other:
            notes.append(f"{delay_s:g} s: not the same was done in {len(other)} worlds: {other}.")
        if share < WANTED.get(delay_s, 0):
            notes.append(f"{delay_s:g} s: {WANTED[delay_s] - share:.1f} points below what is wanted.")
    notes.append(
        f"Of the feasible class mass of {mass[2]} worlds (old batteries) {100 * mass[1]:.0f} % is within battery after "
        f"{MASS_AFTER_S:g} s, holding {100 * mass[0]:.0f} % (wanted: 75 %)."
    )
    return Section(
        name="31-waiting",
        title="Asking without stopping",
        command=command,
        how=f"Table 1's worlds in which something is asked, {worlds} drawn, kinematic simulator, right answers after a "
        f"fixed delay that the drone does not know, batteries {SPARE_S:g} s longer for each gap. *Hidden*: seconds of "
        "mission time saved against holding in the same world, over the seconds that the person thought when holding. "
        "*By its plans*: what the drone itself reports.",
        tables=(
            Table(
                caption="",
                header=(
                    "delay",
                    "worlds",
                    "hidden",
                    "wanted",
                    "earlier than holding, s",
                    "worst, s",
                    "by its plans",
                    "questions, hold / move",
                ),
                rows=rows,
            ),
        ),
        notes=notes,
    )


def main() -> None:
    """Measures, prints, and keeps the section where that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=200)
    parser.add_argument("--first", type=int, default=40000)
    parser.add_argument("--delays", type=float, nargs="+", default=DELAYS_S)
    parser.add_argument("--keep", action="store_true", help="write docs/results.md")
    args = parser.parse_args()
    found = [pair for delay_s in args.delays for pair in pairs(args.worlds, args.first, delay_s)]
    mass = within_battery(args.worlds, args.first, MASS_AFTER_S)
    delays = " ".join(f"{d:g}" for d in args.delays)
    command = f"python -m bench.waiting --worlds {args.worlds} --first {args.first} --delays {delays} --keep"
    made = section(found, mass, args.worlds, command)
    print(made.markdown())
    if args.keep:
        keep(made)


if __name__ == "__main__":
    main()
