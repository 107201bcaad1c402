"""The loop, whole, on one page: look, think, ask, learn, fly; and again whenever something new is seen."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from mintpilot.core.errors import DeviceError, InfeasibleError
from mintpilot.core.events import MapUpdated, MissionEnded, MissionStarted, Noticed, PlanChosen, Timed
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.ports import Ask, Fly, Judge, Operator, Recorder, Vehicle
from mintpilot.core.query import Order
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.elicitation.wording import word_question
from mintpilot.mission.account import account
from mintpilot.mission.asking import Interview, Wording, put_question
from mintpilot.mission.endings import ended, home_stop, obey, stay_or_return
from mintpilot.mission.eyes import Eyes
from mintpilot.mission.flight import End, Pilot
from mintpilot.mission.mind import Mind, Thinking, think
from mintpilot.mission.rewording import Improve
from mintpilot.reasoning.belief import prior_belief

MAX_RETHINKS = 8
"""How often news in flight may send the drone back to thinking before it goes home."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Crew:
    """Everybody that the loop works with."""

    thinking: Thinking
    vehicle: Vehicle
    eyes: Eyes
    operator: Operator
    recorder: Recorder
    survey: Callable[[], SemanticMap]
    """Makes the first map; afterwards the vehicle hovers, ready for the mission."""
    judge: Judge | None = None
    """In a simulator, says how it really went."""
    word: Wording = word_question
    improve: Improve | None = None
    """Makes better words while the first ones are shown; None: nobody does."""
    remarks: Callable[[], Sequence[str]] = tuple
    """What went wrong with the words since it was last called, in sentences."""
    language: str = "en"
    language_model: str = "template"
    simulated: bool = False
    """True in a simulator only: baselines may then fly what is not known to be passable."""
    watch_map: bool = True
    """False where the map is given and nothing new can be seen."""
    strategy_name: str = "mint"
    seed: int | None = None


def fly_mission(crew: Crew) -> Verdict:
    """Flies one mission from the survey to its end. Whatever happens, the vehicle is left holding."""
    record = crew.recorder.record
    mission, task = crew.thinking.mission, crew.thinking.task
    record(
        MissionStarted(
            mission=mission,
            task=task,
            seed=crew.seed,
            strategy=crew.strategy_name,
            language=crew.language,
            language_model=crew.language_model,
        )
    )
    verdict = Verdict(outcome=Outcome.ABORTED, reason="The mission was broken off.")
    try:
        begun = time.perf_counter()
        first_map = crew.survey()
        record(Timed(stage="survey", seconds=time.perf_counter() - begun))
        record(MapUpdated(map=first_map, why="first map"))
        verdict = _think_and_fly(crew, Mind(map=first_map, belief=prior_belief(())))
    except DeviceError as error:
        verdict = Verdict(outcome=Outcome.VEHICLE_FAILED, reason=str(error))
    finally:
        crew.vehicle.hold()
        record(MissionEnded(verdict=verdict))
    return verdict


def _think_and_fly(crew: Crew, mind: Mind) -> Verdict:
    thinking, home = crew.thinking, home_stop(crew.thinking.mission.start_m)
    pilot = Pilot(
        vehicle=crew.vehicle,
        eyes=crew.eyes,
        recorder=crew.recorder,
        limits=thinking.mission.limits,
        map=mind.map,
        watch_map=crew.watch_map,
    )
    begun_s = crew.vehicle.state().time_s
    interview = Interview(crew.operator, crew.recorder, thinking.settings, crew.word, crew.improve, crew.remarks)
    why = "New things kept turning up in the way."
    for _ in range(MAX_RETHINKS):
        try:
            mind, decision = _settle(crew, mind, interview, begun_s)
        except InfeasibleError as error:
            why = str(error)
            break
        if isinstance(decision, Order):
            return obey(pilot, thinking.planner, crew.operator, home, decision)
        pilot.map = mind.map
        if decision.plan is None:
            why = decision.certificate.text
            break
        begun = time.perf_counter()
        unsafe = _regions_entered(decision) if decision.unsafe and crew.simulated else frozenset()
        progress = pilot.fly(decision.plan, pretend_passable=unsafe)
        crew.recorder.record(Timed(stage="flight", seconds=time.perf_counter() - begun))
        mind = replace(mind, map=progress.map, finished=mind.finished | progress.finished)
        if progress.end is not End.NEWS:
            return ended(progress, crew.judge)
        pilot.get_out()
    return stay_or_return(pilot, thinking.planner, crew.operator, home, why)


def _settle(crew: Crew, mind: Mind, interview: Interview, begun_s: float) -> tuple[Mind, Fly | Order]:
    """Thinks and asks until it is clear what to fly (method, sections 3 to 5)."""
    record = crew.recorder.record
    while True:
        state = crew.vehicle.state()
        unspent_s = crew.thinking.mission.limits.endurance_s - (state.time_s - begun_s)
        usable_s = min(state.endurance_left_s, unspent_s)
        begun = time.perf_counter()
        thought = think(mind, crew.thinking, start_m=state.position_m, endurance_s=usable_s)
        seconds = time.perf_counter() - begun
        record(Timed(stage="deliberation", seconds=seconds))
        if thought.mind.map is not mind.map:
            record(MapUpdated(map=thought.mind.map, why="answers"))
        mind = thought.mind
        interview.deliberated(thought, seconds)
        if not isinstance(thought.decision, Ask):
            fly = thought.decision
            accounts = account(interview, thought)
            record(PlanChosen(plan=fly.plan, certificate=fly.certificate, accounts=accounts))
            return mind, fly
        mind, command = put_question(interview, mind, thought.decision)
        if command is not None:
            return mind, command
        if mind.silent:
            record(Noticed(kind="silence", text="No answer came: the drone takes the way that is safe whatever holds."))


def _regions_entered(fly: Fly) -> frozenset[str]:
    """Regions that a deliberately unsafe baseline flies through."""
    return frozenset(gap.removeprefix("obstacle:") for gap in fly.plan.enters) if fly.plan else frozenset()
