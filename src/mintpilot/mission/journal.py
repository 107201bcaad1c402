"""What the recorder is told: made from each step's event, states and directives."""

from __future__ import annotations

from collections.abc import Iterator

from mintpilot.core.decisions import AskQuestion, FlyPlan
from mintpilot.core.digest import digest
from mintpilot.core.events import (
    Asked,
    Deliberated,
    Event,
    FactsChanged,
    LegFlown,
    MapUpdated,
    Noticed,
    OrderTaken,
    PlanChosen,
    QuestionTimed,
    Stepped,
    StopsDone,
    Timed,
)
from mintpilot.core.inputs import Answered, DeliberationEnded, Input, MapObserved, MotionEnded, Ordered
from mintpilot.core.message import joined, message
from mintpilot.core.motion import FollowTrajectory
from mintpilot.core.ports import Recorder
from mintpilot.core.query import Answer, Reply
from mintpilot.core.task import Action
from mintpilot.mission.directives import BeginTask, Directive, Move, Note, Tell, WithdrawQuestion
from mintpilot.mission.looking import looked_at
from mintpilot.mission.requests import Purpose
from mintpilot.mission.state import Activity, MissionState, OpenQuestion
from mintpilot.reasoning.explain import decided

_PHASES = {
    Activity.SWEEP: "survey",
    Activity.EXPLORE: "survey",
    Activity.SURVEY_BACK: "survey",
    Activity.LEG: "mission",
    Activity.MEANWHILE: "meanwhile",
    Activity.RETREAT: "retreat",
    Activity.HOMEWARD: "return",
    Activity.TO_LANDING: "landing",
    Activity.DESCENT: "landing",
}


class Journal:
    """Turns steps into the events of the record.

    Args:
        recorder: who keeps them.
        digests: whether each step keeps a digest of its directives, for a later replay.
    """

    def __init__(self, recorder: Recorder, *, digests: bool = False) -> None:
        self._recorder = recorder
        self._digests = digests
        self._round = 0
        self._flight: FollowTrajectory | None = None

    def keep(self, before: MissionState, event: Input, after: MissionState, directives: tuple[Directive, ...]) -> None:
        """Keeps one step."""
        names = tuple(type(directive).__name__ for directive in directives)
        told = digest(directives) if self._digests else ""
        self._recorder.record(Stepped(input=event, directives=names, digest=told))
        for entry in self._entries(before, event, after, directives):
            self._recorder.record(entry)
        for directive in directives:
            if isinstance(directive, Move) and isinstance(directive.motion, FollowTrajectory):
                self._flight = directive.motion

    def _entries(
        self, before: MissionState, event: Input, after: MissionState, directives: tuple[Directive, ...]
    ) -> Iterator[Event]:
        match event:
            case DeliberationEnded() if before.request is not None and before.request.id == event.request:
                yield from self._deliberated(before, event, after)
            case MotionEnded():
                yield from self._flown(before, event)
            case MapObserved() if before.beliefs is None:
                yield MapUpdated(map=event.map, why="first map")
            case MapObserved() if before.activity is Activity.ACTED and before.plan is not None and after.beliefs:
                leg = before.plan.legs[before.leg]
                if leg.stop.action is Action.LOOK:
                    yield MapUpdated(map=after.beliefs.map, why=f"looked into {leg.site.label}")
            case Ordered():
                said = joined([d.text for d in directives if isinstance(d, Tell)])
                yield OrderTaken(
                    order=event.order, operator=event.operator, text=event.text, answer=said, time_s=after.clock_s
                )
            case _:
                pass
        if after.question is not None and _timing(after.question) != _timing(before.question):
            name, deadline_s, extended = _timing(after.question)
            yield QuestionTimed(question=name, deadline_s=deadline_s, extended=extended)
        if after.told is not before.told:
            yield FactsChanged(told=tuple(one.known for one in after.told))
        done = after.beliefs.finished if after.beliefs is not None else frozenset[str]()
        if before.beliefs is not None and done != before.beliefs.finished:
            yield StopsDone(stops=tuple(sorted(done)))
        yield from _asked(before, event, after)
        for directive in directives:
            if isinstance(directive, Note):
                yield Noticed(kind=directive.kind, text=directive.text)
            elif isinstance(directive, BeginTask) and after.setup.surveys and after.beliefs is not None:
                yield MapUpdated(map=after.beliefs.map, why="survey")
            elif isinstance(directive, WithdrawQuestion) and _broken_off(before, event):
                assert before.question is not None
                asked = before.question.question.text
                text = message("'{question}' was withdrawn: {why}.", question=asked, why=directive.why)
                yield Noticed(kind="withdrawn", text=text)

    def _deliberated(self, before: MissionState, event: DeliberationEnded, after: MissionState) -> Iterator[Event]:
        assert before.request is not None
        stage = {Purpose.MISSION: "deliberation", Purpose.LEG: "planning"}.get(before.request.purpose, "navigation")
        yield Timed(stage=stage, seconds=event.seconds)
        decision = event.decision
        if not isinstance(decision, AskQuestion | FlyPlan):
            return
        if before.beliefs and after.beliefs and after.beliefs.map is not before.beliefs.map:
            yield MapUpdated(map=after.beliefs.map, why="answers")
        yield Deliberated(
            round=self._round,
            gaps=decision.reasoning.gaps,
            mint=decision.reasoning.mint,
            chosen=decision.scored if isinstance(decision, AskQuestion) else None,
            alternatives=decision.alternatives if isinstance(decision, AskQuestion) else (),
            certificate=None if isinstance(decision, AskQuestion) else decision.certificate,
            seconds=event.seconds,
            proposed=decision.reasoning.proposed,
            bound_bits=decision.bound_bits if isinstance(decision, AskQuestion) else None,
        )
        self._round += 1
        if isinstance(decision, FlyPlan):
            explained = sorted(after.explanations, key=lambda e: e.gap_id)
            looked = looked_at(after.beliefs.finished) if after.beliefs else frozenset[str]()
            yield PlanChosen(
                plan=decision.plan,
                certificate=decision.certificate,
                explanations=tuple(decided(e, e.gap_id in after.asked_gaps, e.gap_id in looked) for e in explained),
            )

    def _flown(self, before: MissionState, event: MotionEnded) -> Iterator[Event]:
        flight, motion = self._flight, before.motion
        phase = _PHASES.get(before.activity, "")
        if motion is None or flight is None or not event.motion == motion.id == flight.id or not phase:
            return
        if event.log is None:
            return
        stop = ""
        if before.activity is Activity.LEG and before.plan is not None:
            stop = before.plan.legs[before.leg].stop.id
        elif before.activity is Activity.HOMEWARD:
            stop = "home"
        yield LegFlown(phase=phase, stop_id=stop, trajectory=flight.trajectory, log=event.log)


def _asked(before: MissionState, event: Input, after: MissionState) -> Iterator[Event]:
    """The question that was open, once it was answered or its time was over."""
    open_ = before.question
    if (
        open_ is None
        or before.grounded
        or (after.question is not None and after.question.question.id == open_.question.id)
    ):
        return
    if isinstance(event, Answered) and event.question == open_.question.id and after.learnt is not None:
        answer = after.learnt
    elif after.clock_s >= open_.deadline_s and not isinstance(event, Ordered):
        begun_s = open_.asked_s if open_.shown_s is None else open_.shown_s
        answer = Answer(reply=Reply.TIMEOUT, latency_s=max(0.0, after.clock_s - begun_s))
    else:
        return
    yield _entry(open_, answer)
    yield Timed(stage="answer", seconds=answer.latency_s)


def _entry(open_: OpenQuestion, answer: Answer) -> Asked:
    return Asked(
        question=open_.question,
        scored=open_.scored,
        answer=answer,
        wording_s=0.0,
        first_text=open_.first_text,
        better_s=open_.reworded_s,
    )


def _timing(open_: OpenQuestion | None) -> tuple[str, float, bool]:
    return ("", 0.0, False) if open_ is None else (open_.question.id, open_.deadline_s, open_.extended)


def _broken_off(before: MissionState, event: Input) -> bool:
    """Whether a question was taken back without an answer."""
    open_ = before.question
    if open_ is None or (isinstance(event, Answered) and event.question == open_.question.id):
        return False
    return isinstance(event, Ordered) or event.time_s < open_.deadline_s
