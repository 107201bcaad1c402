"""A mission thought through without a flight: the shipped `step`, with a vehicle that waits at the start.

For `mintpilot plan`, the Gymnasium environment, conformance checks and tests: all learn from answers as a flight does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from mintpilot.core.decisions import Decision
from mintpilot.core.inputs import Answered, DeliberationEnded, Input, MapObserved, MissionBegun, MotionEnded, Ticked
from mintpilot.core.motion import MotionEnd
from mintpilot.core.query import Answer, Question, Reply
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.trajectory import VehicleState
from mintpilot.mission.deliberation import Deliberation, DeliberationParts, decision_of, deliberate
from mintpilot.mission.directives import Deliberate, Directive, Move
from mintpilot.mission.requests import Purpose, Request
from mintpilot.mission.state import MissionState, Setup
from mintpilot.mission.step import initial_state, step


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rehearsal:
    """One moment of it. A value: every answer gives another one."""

    parts: DeliberationParts
    state: MissionState
    request: Request | None = None
    """The deliberation that is asked for now; None: a question is open, or the asking is over."""

    @property
    def question(self) -> Question | None:
        """The question that is open."""
        return self.state.question.question if self.state.question is not None else None

    def deliberated(self, parts: DeliberationParts | None = None) -> Deliberation:
        """Works out what is asked for now, with other parts where they are given.

        Raises:
            InfeasibleError: nothing can be flown, whatever the answers are.
            ValueError: nothing is asked for.
        """
        request = self.request
        if request is None:
            raise ValueError("no deliberation is asked for: answer the question first")
        return deliberate(
            request.state,
            parts or self.parts,
            start_m=request.vehicle.position_m,
            endurance_s=request.endurance_s,
        )

    def asked(self, found: Deliberation) -> Rehearsal:
        """After the question of that deliberation was put; nothing is explained again."""
        every = frozenset(gap.id for gap in found.findings.gaps)
        return self.decided(decision_of(found, self.parts, every))

    def decided(self, decision: Decision) -> Rehearsal:
        """After that decision came back."""
        request = self.request
        if request is None:
            raise ValueError("no deliberation is asked for: there is nothing to decide")
        return self._after(DeliberationEnded(time_s=self.state.clock_s, request=request.id, decision=decision))

    def answered(self, answer: Answer) -> Rehearsal:
        """After that answer to the open question; silence is waited for."""
        open_ = self.state.question
        if open_ is None:
            raise ValueError("no question is open: there is nothing to answer")
        if answer.reply is Reply.TIMEOUT:
            return self._after(Ticked(time_s=open_.deadline_s, vehicle=self.state.vehicle))
        event = Answered(time_s=self.state.clock_s, question=open_.question.id, answer=answer)
        return self._after(event)

    def _after(self, event: Input) -> Rehearsal:
        state, directives = step(self.state, event)
        return replace(self, state=state, request=_requested(directives))


def begin(parts: DeliberationParts, map: SemanticMap) -> Rehearsal:
    """The moment of the first deliberation on a map that is known."""
    mission = parts.mission
    still = VehicleState(time_s=0.0, position_m=mission.start_m, velocity_mps=(0.0, 0.0, 0.0), yaw_rad=0.0)
    state, directives = step(initial_state(Setup(mission=mission), still), MissionBegun(time_s=0.0, vehicle=still))
    motion = next(d.motion.id for d in directives if isinstance(d, Move))
    for event in (
        MotionEnded(time_s=0.0, motion=motion, end=MotionEnd.ARRIVED, vehicle=still),
        MapObserved(time_s=0.0, map=map),
        Ticked(time_s=0.0, vehicle=still),
    ):
        state, directives = step(state, event)
    return Rehearsal(parts=parts, state=state, request=_requested(directives))


def _requested(directives: tuple[Directive, ...]) -> Request | None:
    """The deliberation on the mission that is asked for, if any."""
    wanted = (d.request for d in directives if isinstance(d, Deliberate))
    return next((request for request in wanted if request.purpose is Purpose.MISSION), None)
