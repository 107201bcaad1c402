"""Whether a simulated flight kept its rules: LTLf's own definition on what was flown (method, section 14).

Nothing of planning is used: no automaton, no grid of labels; distances are exact, to the surfaces of a region's cells.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from mintpilot.assembly.worlds import World
from mintpilot.core.events import Event, LegFlown, OrderTaken
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.plan import Stop
from mintpilot.core.ports import Judge, Recorder
from mintpilot.core.rule import About, Proposition, StopLetters
from mintpilot.core.trajectory import FlightEnd
from mintpilot.rules.compiling import compile_rules
from mintpilot.rules.monitor import truth
from mintpilot.rules.parsing import parse
from mintpilot.uncertainty import letters_of, ruling_of

_AT_ONCE = 2_000_000


@dataclass(slots=True, eq=False)
class RuleJudge(Judge, Recorder):
    """Judges as another judge does, and fails a flight that broke a rule. Hears what is recorded to know the flight.

    Once somebody gave an order the flight is no longer judged by rules: orders go before them. So is a flight that
    gave up: fail-safes do, too.

    Args:
        judge: of everything else.
        recorder: told everything that is heard.
        world: the rules, and the map that they speak of.
    """

    judge: Judge
    recorder: Recorder
    world: World
    _where: list[Floats] = field(default_factory=list)
    _letters: list[int] = field(default_factory=list)
    _held: int = 0
    _ordered: bool = False

    def record(self, event: Event) -> None:
        """Keeps where the drone was and what it did there."""
        if isinstance(event, OrderTaken):
            self._ordered = True
        if isinstance(event, LegFlown) and event.phase != "survey" and len(event.log.position_m):
            self._flown(event)
        self.recorder.record(event)

    def verdict(self) -> Verdict | None:
        """See `Judge.verdict`."""
        return self.judge.verdict()

    def people(self) -> tuple[int, int]:
        """See `Judge.people`."""
        return self.judge.people()

    def final(self) -> Verdict:
        """See `Judge.final`; a success under broken rules is none."""
        found = self.judge.final()
        failed = self.judge.verdict() is not None
        if failed or self._ordered or not self._where:
            return found
        broken = tuple(self.broken())
        if not broken:
            return replace(found, rules_broken=())
        reason = f"it broke the rule: {'; '.join(broken)}"
        return Verdict(outcome=Outcome.RULE_BROKEN, reason=reason, rules_broken=broken)

    def broken(self) -> list[str]:
        """Words of the rules that the flight so far has broken, if it ended now."""
        automaton = compile_rules(self.world.task.rules)
        ruling = ruling_of(self.world.map, self.world.task, automaton, ())
        points = np.vstack(self._where)
        letters = np.array(self._letters, np.int64)
        found: dict[Proposition, Bools] = {}
        for bit, what in enumerate(automaton.propositions):
            if what.about.spatial:
                found[what] = self._spatial(what, ruling.cells[bit], points)
            else:
                found[what] = np.asarray(letters >> bit & 1, bool)
        return [
            rule.text
            for rule in self.world.task.rules
            if not truth(parse(rule.formula), found.__getitem__, len(points))[0]
        ]

    def _flown(self, event: LegFlown) -> None:
        way = event.log.position_m
        self._where.append(way)
        self._letters += [self._held] * len(way)
        if event.phase not in ("mission", "meanwhile") or event.log.end is not FlightEnd.ARRIVED:
            return
        stop = self._stop(event)
        one = (
            StopLetters()
            if stop is None
            else letters_of(stop, self.world.map, self.world.task, compile_rules(self.world.task.rules))
        )
        after = (self._held | one.begins) & ~one.ends
        self._where.append(np.repeat(way[-1:], 2, axis=0))
        self._letters += [self._held | one.at, after | one.at]
        self._held = after

    def _stop(self, event: LegFlown) -> Stop | None:
        """The stop of a leg, as far as its id tells; None for one of no task: where rules want the flight to end."""
        from mintpilot.uncertainty.findings import find_gaps

        findings = find_gaps(self.world.map, self.world.task, start_m=self.world.mission.start_m)
        return next((stop for stop in findings.stops if stop.id == event.stop_id), None)

    def _spatial(self, what: Proposition, cells: Ints, points: Floats) -> Bools:
        frame, radius_m = self.world.map.frame, self.world.mission.limits.radius_m
        inside = np.zeros(frame.size, bool)
        inside[cells] = True
        own = np.clip(frame.cells_of(points), 0, np.array(frame.shape) - 1)
        centre_in = inside[np.ravel_multi_index(tuple(own.T), frame.shape)]
        match what.about:
            case About.IN:
                return np.asarray(centre_in)
            case About.INSIDE:
                return np.asarray(centre_in & (self._away_m(np.flatnonzero(~inside), points) >= radius_m))
            case About.WITHIN:
                return np.asarray(self._away_m(cells, points) <= what.metres + radius_m)
            case _:
                return np.asarray(self._away_m(cells, points) < radius_m)

    def _away_m(self, cells: Ints, points: Floats) -> Floats:
        """Metres (n,) from points to the nearest surface of these cells; heights do not count on a flat map."""
        frame = self.world.map.frame
        found = np.full(len(points), np.inf)
        if not len(cells):
            return found
        centres = frame.centres_of(np.stack(np.unravel_index(cells, frame.shape), axis=1))
        axes = 2 if frame.is_flat else 3
        step = max(1, _AT_ONCE // len(cells))
        for i in range(0, len(points), step):
            apart = np.abs(points[i : i + step, None, :axes] - centres[None, :, :axes])
            gap = np.maximum(apart - frame.resolution_m / 2, 0)
            found[i : i + step] = np.sqrt((gap**2).sum(axis=2)).min(axis=1)
        return found
