"""One trial: one method flies one mission in one world, and one record comes of it, whatever happens."""

from __future__ import annotations

import time
import traceback
from dataclasses import replace

from mintpilot.assembly.components import Choices, VehicleChoice, components_for, scripted_operator
from mintpilot.assembly.strategies import make_strategy
from mintpilot.assembly.talk import talk_for
from mintpilot.assembly.worlds import World
from mintpilot.benchmark.conditions import asking_for
from mintpilot.benchmark.deadline import TrialTimeoutError, deadline
from mintpilot.benchmark.experiment import Cell, Experiment
from mintpilot.benchmark.methods import Method
from mintpilot.benchmark.records import TrialRecord
from mintpilot.benchmark.shared_survey import SharedSurvey
from mintpilot.benchmark.tally import Tally
from mintpilot.core.mission import Outcome, Verdict, Waiting
from mintpilot.core.ports import Planner
from mintpilot.mission.components import MissionComponents
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.schema import LanguageSpec, OperatorSpec

RAISED = "raised"
"""Outcome of a trial whose method, or a part under it, raised an exception."""
TIMED_OUT = "timed-out"
"""Outcome of a trial that computed longer than it may."""
CRASHED = "crashed"
"""Outcome of a trial whose process died."""


def fly_trial(
    experiment: Experiment,
    cell: Cell,
    method: Method,
    world: World,
    planner: Planner | None = None,
    survey: SharedSurvey | None = None,
) -> TrialRecord:
    """Flies one mission. Never raises for what the method does: that is the trial's own failure.

    Args:
        experiment: the configuration.
        cell: the kind of world and the condition.
        method: who decides.
        world: as the drone believes it; the truth is the scene's.
        planner: shares plans with other methods in the same world; None for one of its own.
        survey: hands on the first survey of this world; None: the method flies its own.
    """
    begun = time.perf_counter()
    tally, flight = Tally(), _Flight()
    error = ""
    waiting, done = Waiting(), 0
    try:
        with deadline(experiment.time_limit_s):
            verdict = flight.fly(experiment, cell, method, world, planner, survey, tally)
            outcome, reason = verdict.outcome.value, str(verdict.reason)
            waiting, done = verdict.waiting, len(verdict.achieved)
    except TrialTimeoutError:
        outcome = TIMED_OUT
        reason = f"'{method.name}' was not done within {experiment.time_limit_s:g} s of computing"
    except Exception as raised:  # a stranger's strategy may raise anything: it is recorded, and the run goes on
        outcome, reason = RAISED, f"'{method.name}' raised {type(raised).__name__}: {raised}"
        error = traceback.format_exc(limit=-12)
    return TrialRecord(
        experiment=experiment.name,
        cell=cell.name,
        seed=world.seed,
        method=method.name,
        vehicle=experiment.vehicle,
        outcome=outcome,
        success=outcome == Outcome.SUCCESS.value,
        reason=reason,
        people_found=flight.people[0],
        people_there=flight.people[1],
        questions=len(tally.asked),
        unsure=tally.unsure,
        contradictions=tally.contradictions,
        flight_s=flight.seconds(),
        flown_m=tally.flown_m,
        waited_s=waiting.delay_s,
        hidden_s=waiting.hidden_s,
        stops_done=done,
        planned_s=tally.planned_s,
        stop_reason=tally.stop_reason,
        stages_s=tally.stages,
        deliberation_max_s=tally.deliberation_max_s,
        survey_s=tally.survey_s,
        frames=tally.frames,
        asked=tuple(tally.asked),
        path_m=tally.path(),
        wall_s=time.perf_counter() - begun,
        error=error,
    )


def broken_trial(experiment: Experiment, cell: Cell, seed: int, method: str, outcome: str, reason: str) -> TrialRecord:
    """The record of a trial of which nothing came back."""
    return TrialRecord(
        experiment=experiment.name,
        cell=cell.name,
        seed=seed,
        method=method,
        vehicle=experiment.vehicle,
        outcome=outcome,
        success=False,
        reason=reason,
    )


class _Flight:
    """One mission, and its clock."""

    def __init__(self) -> None:
        self._begun_s = 0.0
        self.people = (0, 0)
        self._ended_s = 0.0

    def seconds(self) -> float:
        """Mission clock from the end of the survey to the end."""
        return max(0.0, self._ended_s - self._begun_s)

    def fly(
        self,
        experiment: Experiment,
        cell: Cell,
        method: Method,
        world: World,
        planner: Planner | None,
        survey: SharedSurvey | None,
        tally: Tally,
    ) -> Verdict:
        condition = cell.condition
        asking = asking_for(world.mission.asking, experiment, condition, method)
        world = replace(world, mission=replace(world.mission, asking=asking))
        person = OperatorSpec(
            answer_error=condition.answer_error, unsure=condition.unsure_rate, latency_s=str(experiment.think)
        )
        choices = Choices(strategy="mint", vehicle=VehicleChoice(experiment.vehicle))
        operator = scripted_operator(world, person)
        talk = talk_for(LanguageSpec(), llm=experiment.llm)
        with components_for(world, choices, operators=(operator,), recorder=tally, talk=talk) as made:
            strategy = make_strategy(method.strategy, seed=world.seed, arguments=method.arguments)
            parts = replace(made.parts, strategy=strategy)
            if planner is not None:
                parts = replace(parts, planner=planner)
            named = replace(made, parts=parts, strategy_name=method.name)
            verdict = fly_mission(self._timed(named if survey is None else survey.shared(named)))
            self._ended_s = made.vehicle.state().time_s
            if made.judge is not None:
                self.people = made.judge.people()
        return verdict

    def _timed(self, components: MissionComponents) -> MissionComponents:
        def begin_task() -> None:
            components.begin_task()
            self._begun_s = self._ended_s = components.vehicle.state().time_s

        return replace(components, begin_task=begin_task)
