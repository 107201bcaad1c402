"""The shell between the ports and `step`: brings events in, carries directives out. It keeps no knowledge."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

from mintpilot.core.errors import DeviceError
from mintpilot.core.events import Noticed, Timed, ViewTaken
from mintpilot.core.inputs import (
    Answered,
    Input,
    Link,
    LinkChanged,
    MapObserved,
    MoreTimeWanted,
    MotionEnded,
    QuestionReworded,
    QuestionShown,
    Ticked,
)
from mintpilot.core.message import message
from mintpilot.core.mission import Outcome, Sight, Verdict
from mintpilot.core.ports import Operator
from mintpilot.core.query import Question
from mintpilot.mission.components import MissionComponents
from mintpilot.mission.directives import Brake, Deliberate, Move, Observe, ShowQuestion, Tell, WithdrawQuestion
from mintpilot.mission.journal import Journal
from mintpilot.mission.path_monitor import PathMonitor
from mintpilot.mission.rewording import Rewording
from mintpilot.mission.state import MissionState

ATTENDED_S = 0.1
"""While a person is attached, or beside a real vehicle, time passes in pieces of at most this, seconds."""
HEARING_S = 0.02
"""While time passes as on the wall, it is listened so often whether somebody has said something, seconds."""
VIEW_S = 0.2
"""Between pictures for a person who watches, seconds; fewer where the machine is slow."""
SOON_S = 1e-6
"""Moments that are nearer than this are the same, seconds: clocks round."""
MOST_UNTIMED = 50
"""After so many events time passes before more are taken in: whoever talks without end must not stop the clock."""
MOST_WAITING = 1000
"""Of what waits longer, the latest that operators merely said is dropped, and that is noted."""
SPEAKING_S = 1.2
"""Better words are waited for so long before a question is put where nobody watches a screen, seconds."""


class Shell:
    """One mission's ports.

    Args:
        components: the ports.
        clock: seconds of the clock on the wall, never going back.
        sleep: waits that many seconds.
    """

    def __init__(
        self,
        components: MissionComponents,
        *,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._parts = components
        self._clock, self._sleep = clock, sleep
        self.journal = Journal(components.recorder, digests=components.digests)
        self._worker = components.worker(components.parts)
        self._operators: list[Operator] = list(components.operators)
        self._monitor: PathMonitor | None = None
        self._moving = self._braking = False
        self._next_look_s = self._next_view_s = 0.0
        self._viewing_s = 0.0
        self._ahead_s = 0.0
        self._rewording: tuple[str, Rewording] | None = None
        self._waiting: list[Input] = []
        self._untimed = 0
        self._flooded = False
        self._begun = time.perf_counter()
        self._flying_s = 0.0
        self._now_s = components.vehicle.state().time_s

    def observe(self, state: MissionState) -> list[Input]:
        """What has come since the last call; where nothing has, lets time pass until the next thing may happen."""
        self._take(self._heard())
        now = self._waiting[: MOST_UNTIMED - self._untimed]
        if now:
            self._untimed += len(now)
            del self._waiting[: len(now)]
            return now
        self._untimed = 0
        return self._advance(state)

    def look(self, state: MissionState, directive: Observe) -> list[Input]:
        """Takes a picture, or not, and draws the map."""
        try:
            if directive.look:
                self._parts.map_source.look()
            newer = self._parts.map_source.draw(state.beliefs.map if state.beliefs is not None else None)
        except DeviceError as error:
            return [LinkChanged(time_s=self._now_s, link=Link.CAMERA, up=False, reason=str(error))]
        return [MapObserved(time_s=self._now_s, map=newer)]

    def deliberate(self, directive: Deliberate) -> list[Input]:
        """Hands a request on; what is worked out at once comes back at once."""
        self._worker.submit(directive.request, self._now_s)
        return list(self._worker.poll(self._now_s))

    def fly(self, directive: Move | Brake) -> list[Input]:
        """Tells the vehicle to move, or to brake."""
        try:
            if isinstance(directive, Brake):
                self._braking = True
                self._parts.vehicle.brake()
                return []
            path = directive.monitored_m
            limits = self._parts.parts.mission.limits
            self._monitor = None if path is None else PathMonitor(path, limits, directive.assume_passable)
            self._moving, self._braking = True, False
            self._next_look_s = self._now_s + self._parts.camera_period_s
            self._parts.vehicle.command(directive.motion)
        except DeviceError as error:
            return [self._telemetry_lost(error)]
        return []

    def speak(self, directive: ShowQuestion | WithdrawQuestion | Tell) -> None:
        """Shows, withdraws, or tells, to all operators."""
        if isinstance(directive, ShowQuestion):
            self._reword(directive.question)
        for operator in self._operators:
            match directive:
                case ShowQuestion():
                    operator.show(directive.question, directive.patience_s)
                case WithdrawQuestion():
                    operator.withdraw(directive.question, self._parts.spoken(directive.why))
                case Tell():
                    operator.tell(self._parts.spoken(directive.text))

    def begin_task(self) -> list[Input]:
        """The survey is over. The vehicle's battery may be another one now: how it stands is said at once."""
        self._parts.begin_task()
        self._parts.recorder.record(Timed(stage="survey", seconds=time.perf_counter() - self._begun))
        self._flying_s = 0.0
        try:
            vehicle = self._parts.vehicle.state()
        except DeviceError as error:
            return [self._telemetry_lost(error)]
        return [Ticked(time_s=self._now_s, vehicle=vehicle)]

    def verdict(self, state: MissionState) -> Verdict:
        """How it really went where somebody can tell, else how the mission believes that it went."""
        believed = state.verdict or Verdict(outcome=Outcome.ABORTED, reason=message("The mission was broken off."))
        judge = self._parts.judge
        if judge is None:
            return believed
        failure = judge.verdict()
        if failure is None:
            if believed.outcome not in (Outcome.SUCCESS, Outcome.PARTIAL):
                return believed
            failure = judge.final()
            missed = failure.outcome in (Outcome.PERSON_MISSED, Outcome.NOT_REACHED)
            unseen = any(look.result is Sight.UNSEEN for look in believed.looks)
            if believed.outcome is Outcome.PARTIAL and (missed or unseen or state.lacks_wanted):
                return believed  # the judge of people and things does not know of every place that was asked for
        return replace(
            failure, achieved=believed.achieved, left=believed.left, looks=believed.looks, waiting=believed.waiting
        )

    def close(self) -> None:
        """Leaves the vehicle holding, and ends the worker."""
        with suppress(DeviceError):
            self._parts.vehicle.hold()
        self._worker.close()

    def _take(self, heard: list[Input]) -> None:
        """Puts what was heard behind what waits. In a flood orders come first, then answers: they may add caution."""
        self._waiting += heard
        if len(self._waiting) <= MOST_UNTIMED:
            return
        self._waiting.sort(
            key=lambda event: 2 * isinstance(event, QuestionShown | MoreTimeWanted) + isinstance(event, Answered)
        )
        if len(self._waiting) > MOST_WAITING:
            del self._waiting[MOST_WAITING:]
            if not self._flooded:
                self._flooded = True
                text = message(
                    "More than {most} inputs of operators came at once: some are not looked at.", most=MOST_WAITING
                )
                self._parts.recorder.record(Noticed(kind="operator", text=text))

    def _heard(self) -> list[Input]:
        """What operators and worker bring without time passing."""
        events: list[Input] = [*self._worker.poll(self._now_s), *self._reworded()]
        for operator in tuple(self._operators):
            try:
                events += operator.poll(self._now_s)
            except DeviceError as error:
                self._operators.remove(operator)
                self._parts.recorder.record(Noticed(kind="operator", text=error.said))
                if not self._operators:
                    lost = LinkChanged(time_s=self._now_s, link=Link.OPERATOR, up=False, reason=str(error))
                    events.append(lost)
        for remark in self._parts.remarks():
            self._parts.recorder.record(Noticed(kind="language", text=remark))
            self.speak(Tell(text=remark))
        return events

    def _advance(self, state: MissionState) -> list[Input]:
        """Lets time pass: the vehicle moves on, the camera looks when it is due."""
        parts, began, wall_s, before_s = self._parts, time.perf_counter(), self._clock(), self._now_s
        attended = self._attended()
        until_s = min(self._now_s + parts.camera_period_s, state.next_deadline_s())
        if attended or parts.lands:
            until_s = min(until_s, self._now_s + ATTENDED_S)
        watching = parts.watch_map and self._moving and not self._braking
        if watching:
            until_s = min(until_s, self._next_look_s)
        events: list[Input] = []
        try:
            ended = parts.vehicle.advance(until_s)
            vehicle = parts.vehicle.state()
        except DeviceError as error:
            return [self._telemetry_lost(error)]
        self._now_s = vehicle.time_s
        for event in (event for event in ended if isinstance(event, MotionEnded)):
            self._moving, self._monitor = False, None
            if event.log is not None:
                parts.map_source.flown(event.log.position_m, parts.parts.mission.limits.radius_m)
            parts.recorder.record(Timed(stage="flight", seconds=self._flying_s + time.perf_counter() - began))
            self._flying_s, began = 0.0, time.perf_counter()
        events += ended
        if watching and self._moving and self._now_s >= self._next_look_s - SOON_S:
            self._next_look_s += parts.camera_period_s
            events += self._glance(state)
        failure = parts.judge.verdict() if parts.judge is not None else None
        if failure is not None and not ended:
            events.append(LinkChanged(time_s=self._now_s, link=Link.TELEMETRY, up=False, reason=str(failure.reason)))
        events.append(Ticked(time_s=self._now_s, vehicle=vehicle))
        self._flying_s += time.perf_counter() - began
        if attended:
            self._ahead_s = max(0.0, self._ahead_s + self._now_s - before_s - (self._clock() - wall_s))
            self._view()
            events += self._let_pass()
        return events

    def _let_pass(self) -> list[Input]:
        """Waits until as much time has passed on the wall, or somebody says something: that is heard at once."""
        while self._ahead_s > 0:
            wall_s = self._clock()
            self._sleep(min(HEARING_S, self._ahead_s))
            self._ahead_s -= max(self._clock() - wall_s, SOON_S)
            heard = self._heard()
            if heard:
                return heard
        return []

    def _view(self) -> None:
        """A picture for whoever watches, where one is due and there is time for it."""
        camera, wall_s = self._parts.viewed, self._clock()
        if camera is None or self._now_s < self._next_view_s:
            return
        if self._viewing_s > self._ahead_s:
            self._viewing_s *= 0.9  # it may have been slow for once
            return
        self._next_view_s = self._now_s + VIEW_S
        with suppress(DeviceError):  # a camera that is gone is found out by whoever needs it
            self._parts.recorder.record(ViewTaken(frame=camera.capture()))
        self._viewing_s = self._clock() - wall_s
        self._ahead_s = max(0.0, self._ahead_s - self._viewing_s)

    def _attended(self) -> bool:
        """Whether a person is attached: time then passes as fast as on the wall."""
        return any(operator.attended for operator in self._operators)

    def _glance(self, state: MissionState) -> list[Input]:
        """A picture in flight; where the path is monitored, the map with the monitor's verdict."""
        try:
            self._parts.map_source.look()
            if self._monitor is None or state.beliefs is None:
                return []
            newer = self._parts.map_source.draw(state.beliefs.map)
        except DeviceError as error:
            return [LinkChanged(time_s=self._now_s, link=Link.CAMERA, up=False, reason=str(error))]
        where = self._parts.vehicle.state().position_m
        return [MapObserved(time_s=self._now_s, map=newer, obstruction=self._monitor.assess(newer, where))]

    def _telemetry_lost(self, error: DeviceError) -> LinkChanged:
        return LinkChanged(time_s=self._now_s, link=Link.TELEMETRY, up=False, reason=str(error))

    def _reword(self, question: Question) -> None:
        """Begins to make better words for a question that is put for the first time."""
        improve = self._parts.improve
        if (
            improve is None
            or not question.gaps
            or question.attempt > 1
            or (self._rewording and self._rewording[0] == question.id)
        ):
            return
        self._rewording = (question.id, Rewording(improve, question))
        if all(operator.hears_once for operator in self._operators):
            self._rewording[1].wait(SPEAKING_S)

    def _reworded(self) -> list[Input]:
        if self._rewording is None or not self._rewording[1].done:
            return []
        (question, rewording), self._rewording = self._rewording, None
        made = rewording.wait(0.0)
        if made is None:
            return []
        return [
            QuestionReworded(
                time_s=self._now_s,
                question=question,
                text=made.text,
                worded_by=made.worded_by,
                seconds=rewording.seconds,
            )
        ]
