"""Whether a simulated flight kept its rules: LTLf's own definition on what was flown (method, section 14)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from mintpilot.assembly.flown_trace import FlownTrace
from mintpilot.assembly.worlds import World
from mintpilot.core.events import Event, LegFlown, OrderTaken
from mintpilot.core.message import message
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.ports import Judge, Recorder
from mintpilot.core.trajectory import FlightEnd
from mintpilot.rules.monitor import is_kept


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
    _trace: FlownTrace = field(init=False)
    _ordered: bool = False

    def __post_init__(self) -> None:
        self._trace = FlownTrace(self.world.map, self.world.task, self.world.mission.limits.radius_m)

    def record(self, event: Event) -> None:
        """Keeps where the drone was and what it did there."""
        if isinstance(event, OrderTaken):
            self._ordered = True
        if isinstance(event, LegFlown) and event.phase != "survey" and len(event.log.position_m):
            self._trace.fly(event.log.position_m)
            if event.phase in ("mission", "meanwhile") and event.log.end is FlightEnd.ARRIVED:
                self._trace.do(event.stop_id)
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
        if failed or self._ordered or not self._trace.moments:
            return found
        broken = tuple(self.broken())
        if not broken:
            return replace(found, rules_broken=())
        reason = message("it broke the rule: {rules}", rules="; ".join(broken))
        return Verdict(outcome=Outcome.RULE_BROKEN, reason=reason, rules_broken=broken)

    def broken(self) -> list[str]:
        """Words of the rules that the flight so far has broken, if it ended now."""
        trace = self._trace
        return [str(rule.text) for rule in self.world.task.rules if not is_kept(rule.formula, trace.of, trace.moments)]
