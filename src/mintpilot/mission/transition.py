"""One step in the making: the state as it becomes, and the directives that are given on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.inputs import Link
from mintpilot.core.message import Message, joined, message
from mintpilot.core.mission import Achieved, Left, Outcome, Sight, Verdict, left_of
from mintpilot.core.motion import FollowTrajectory, Land, PerformAction, TakeOff
from mintpilot.core.plan import Leg, Stop
from mintpilot.core.trajectory import Trajectory
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.directives import (
    Brake,
    Deliberate,
    Directive,
    Finish,
    Move,
    Note,
    Observe,
    Tell,
    WithdrawQuestion,
)
from mintpilot.mission.nothing_done import sentence
from mintpilot.mission.requests import Purpose, Request
from mintpilot.mission.sights import unknown
from mintpilot.mission.state import (
    Activity,
    Ending,
    Goal,
    MissionState,
    OngoingMotion,
    PendingRequest,
    uncertain_things,
)
from mintpilot.planning.meanwhile import Wait

DELIBERATION_S = 10.0
"""A deliberation that has not come back after this time is overdue, seconds of mission clock."""
MAX_RETREATS = 8
"""How often the drone may back out of places that are not known free."""


class Transition:
    """Collects what one step does. Used by `mintpilot.mission.step` and the files beside it only.

    Attributes:
        state: the state so far.
        out: the directives so far, in order.
    """

    def __init__(self, state: MissionState) -> None:
        self.state = state
        self.out: list[Directive] = []

    def set(self, **changes: Any) -> None:
        """Replaces fields of the state."""
        self.state = replace(self.state, **changes)

    @property
    def beliefs(self) -> BeliefState:
        """What is known. Only called once there is a map."""
        assert self.state.beliefs is not None, "asked for before the first map"
        return self.state.beliefs

    def give(self, directive: Directive) -> None:
        """Gives one directive."""
        self.out.append(directive)

    def tell(self, text: Message) -> None:
        """Says something to the operators."""
        self.give(Tell(text=text))

    def note(self, kind: str, text: Message) -> None:
        """Keeps a line for the report."""
        self.give(Note(kind=kind, text=text))

    def next_id(self) -> int:
        """A number that was not given yet."""
        number = self.state.next_id
        self.set(next_id=number + 1)
        return number

    def follow(
        self, trajectory: Trajectory, activity: Activity, monitored_m: Floats | None = None, *, unsafe: bool = False
    ) -> None:
        """Flies a trajectory; with ``monitored_m`` that path is watched on the way."""
        motion = FollowTrajectory(id=self.next_id(), trajectory=trajectory)
        assume = self.state.assume_passable if unsafe else frozenset[str]()
        self._begin(Move(motion=motion, monitored_m=monitored_m, assume_passable=assume), activity)

    def act(self, stop: Stop, activity: Activity = Activity.ACT) -> None:
        """Does what the stop is for."""
        motion = PerformAction(id=self.next_id(), stop=stop, dwell_s=stop.dwell_s)
        self._begin(Move(motion=motion), activity)

    def take_off(self, height_m: float) -> None:
        """Climbs to the hover point."""
        self._begin(Move(motion=TakeOff(id=self.next_id(), height_m=height_m)), Activity.TAKE_OFF)

    def climb(self) -> None:
        """Takes off to the hover point of the mission's start."""
        mission = self.state.setup.mission
        self.take_off(mission.start_m[2] - mission.volume.lo_m[2])

    def descend(self) -> None:
        """Lands right below."""
        self._begin(Move(motion=Land(id=self.next_id())), Activity.DESCENT)

    def observe(self, activity: Activity, *, look: bool = True) -> None:
        """Looks from here, or draws the map from what was seen; ``activity`` goes on with the new map."""
        self.set(activity=activity)
        self.give(Observe(look=look))

    def brake(self) -> None:
        """Brakes, where something moves and does not brake yet."""
        motion = self.state.motion
        if motion is not None and not motion.braking:
            self.set(motion=replace(motion, braking=True))
            self.give(Brake())

    def request(self, purpose: Purpose, leg: Leg | None = None, *, wait: Wait | None = None) -> None:
        """Has something worked out; an earlier request is dropped."""
        state, beliefs = self.state, self.beliefs
        if state.is_down(Link.OPERATOR):
            beliefs = replace(beliefs, silent=True)
        track = state.track_m if state.retreats < MAX_RETREATS else np.zeros((0, 3))
        request = Request(
            id=self.next_id(),
            purpose=purpose,
            state=beliefs,
            vehicle=state.vehicle,
            endurance_s=state.endurance_s(),
            track_m=track,
            explained=frozenset(account.gap_id for account in state.explanations),
            leg=leg,
            assume_passable=state.assume_passable if purpose is Purpose.LEG else frozenset(),
            survey=state.survey if purpose is Purpose.SURVEY else None,
            wait=wait,
        )
        pending = PendingRequest(
            id=request.id,
            purpose=purpose,
            deadline_s=state.clock_s + DELIBERATION_S,
            map=beliefs.map,
            begun_s=state.clock_s,
        )
        self.set(request=pending, activity=Activity.NONE)
        self.give(Deliberate(request=request))

    def withdraw(self, why: Message) -> None:
        """Takes the open question back, if there is one, and ends what is done meanwhile."""
        open_ = self.state.question
        if open_ is not None:
            if self.state.request is not None and self.state.request.purpose is Purpose.MEANWHILE:
                self.set(request=None)
            if self.state.activity in (Activity.MEANWHILE, Activity.ACT_MEANWHILE):
                self.brake()
            self.set(question=None, earlier=(*self.state.earlier, (open_.question.id, open_.question.query)))
            self.give(WithdrawQuestion(question=open_.question.id, why=why))

    def redirect(self, goal: Goal) -> None:
        """Goes after something else from the next moment of rest on: what is going on is broken off."""
        self.withdraw(message("the drone does something else now"))
        self.set(goal=goal, request=None, drops=0, hops=0)
        self.brake()

    def give_up(self, why: Message) -> None:
        """No safe way leads on: back to the start, as far as known free space leads there."""
        self.tell(message("I do not fly on: {why}", why=why))
        some = bool(self.state.achieved)
        reason = joined([partial_reason(self.state.achieved, ()), why]) if some else why
        self.set(ending=Ending(outcome=Outcome.PARTIAL if some else Outcome.NO_SAFE_PLAN, reason=reason))
        self.redirect(Goal.RETURN)

    def left(self) -> tuple[Left, ...]:
        """What is to be done still, as far as a plan has named it, and why it is not."""
        state = self.state
        finished = state.beliefs.finished if state.beliefs is not None else frozenset[str]()
        undone = state.undone if state.plan is None else state.plan.leaves_undone
        why = {one.stop.id: left_of(one) for one in undone}
        ended = message("the mission ended before it")
        unseen = tuple(unknown(look) for look in state.looks if look.result is Sight.UNSEEN)
        return unseen + tuple(
            why.get(stop.id) or Left(n=stop.step, text=stop.said, reason=ended, resource="ended")
            for stop in state.wanted
            if stop.id not in finished
        )

    def finish(self, outcome: Outcome, reason: Message) -> None:
        """The mission is over."""
        self.withdraw(message("the mission is over"))
        verdict = Verdict(
            outcome=outcome,
            reason=reason,
            achieved=self.state.achieved,
            left=self.left(),
            looks=self.state.looks,
            waiting=self.state.waiting,
        )
        self.set(goal=Goal.ENDED, request=None, verdict=verdict)
        self.give(Finish(verdict=verdict))

    def end(self, where: Message) -> None:
        """Ends as was decided when the drone set out for where it is now; ``where`` says where that is."""
        ending = self.state.ending or Ending(outcome=Outcome.ABORTED, reason=message("The mission was broken off."))
        self.finish(ending.outcome, joined([ending.reason, where]))

    def _begin(self, move: Move, activity: Activity) -> None:
        known = frozenset(uncertain_things(self.state.beliefs.map)) if self.state.beliefs else frozenset[str]()
        ongoing = OngoingMotion(id=move.motion.id, known=known, monitored=move.monitored_m is not None)
        self.set(motion=ongoing, activity=activity)
        self.give(move)


def partial_reason(achieved: Sequence[Achieved], left: Sequence[Left]) -> Message:
    """What was done and what was left, with what ran short, in plain sentences."""
    done = message("Done: {what}.", what=joined([one.text for one in achieved], "; ")) if achieved else Message()
    return joined([done, sentence(left)])
