"""Go or no-go before take-off: nothing moves without an explicit yes, whoever else asks for it."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.mission.scenes import hall

from mintpilot.assembly.briefing import briefing_of
from mintpilot.assembly.components import Choices, components_for, deliberation_parts, scripted_operator
from mintpilot.assembly.replaying import verify_run
from mintpilot.assembly.worlds import build_world
from mintpilot.core.events import LegFlown, Noticed
from mintpilot.core.inputs import Answered, Link, LinkChanged, MissionBegun, Ordered, QuestionReworded, Ticked
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.motion import TakeOff
from mintpilot.core.query import Answer, Order, Reply, Standing
from mintpilot.interaction.scripted import RecordedOperator
from mintpilot.mission.clearing import BRIEFING_S
from mintpilot.mission.directives import Finish, Move, ShowQuestion
from mintpilot.mission.loop import fly_mission
from mintpilot.mission.state import MissionState, Setup
from mintpilot.mission.step import initial_state, step
from mintpilot.mission_file.schema import OperatorSpec
from mintpilot.recording.recorders import MemoryRecorder
from mintpilot.recording.run_folder import RunFolder

WORLD = build_world(hall(), base=None, seed=0)
PARTS = deliberation_parts(WORLD, Choices(vehicle="kinematic"))


def fly(*operators: object, world: object = WORLD, briefs: bool = True) -> tuple[Verdict, list]:
    recorder = MemoryRecorder()
    with components_for(
        world, Choices(vehicle="kinematic", briefs=briefs), operators=operators, recorder=recorder
    ) as components:
        return fly_mission(components), recorder.events


def grounded() -> tuple[MissionState, str]:
    setup = Setup(mission=WORLD.mission, briefing=briefing_of(PARTS, WORLD.map))
    simulator_state = begun_vehicle()
    state, directives = step(initial_state(setup, simulator_state), MissionBegun(time_s=0.0, vehicle=simulator_state))
    (shown,) = [d for d in directives if isinstance(d, ShowQuestion)]
    assert not any(isinstance(d, Move) for d in directives)
    return state, shown.question.id


def begun_vehicle():  # type: ignore[no-untyped-def]
    with components_for(WORLD, Choices(vehicle="kinematic"), operators=(), recorder=MemoryRecorder()) as components:
        return components.vehicle.state()


def test_the_briefing_says_steps_unknowns_and_battery() -> None:
    lines = "\n".join(map(str, briefing_of(PARTS, WORLD.map).lines))
    assert "1 " in lines
    assert "the smoke" in lines
    assert "Battery" in lines


def test_after_a_yes_it_flies_and_the_record_says_who_said_go() -> None:
    verdict, events = fly(scripted_operator(WORLD, OperatorSpec()))
    assert verdict.outcome is Outcome.SUCCESS
    assert [str(e.text) for e in events if isinstance(e, Noticed) and e.kind == "go"] == ["scripted said go."]


@pytest.mark.parametrize("reply", [Reply.NO, Reply.UNSURE, Reply.TIMEOUT])
def test_no_doubt_and_silence_leave_it_on_the_ground(reply: Reply) -> None:
    verdict, events = fly(RecordedOperator([reply]))
    assert verdict.outcome is Outcome.ABORTED
    assert "stayed on the ground" in str(verdict.reason)
    assert not any(isinstance(e, LegFlown) for e in events)


def test_a_task_that_a_model_read_is_always_briefed() -> None:
    read = replace(WORLD, task=replace(WORLD.task, needs_confirmation=True))
    verdict, _ = fly(RecordedOperator([Reply.NO]), world=read, briefs=False)
    assert "stayed on the ground" in str(verdict.reason)
    assert any("language model" in str(line) for line in briefing_of(replace(PARTS, task=read.task), WORLD.map).lines)


@pytest.mark.parametrize(("standing", "by"), [(Standing.UNCONFIRMED, "typed"), (Standing.PLAIN, "voice")])
def test_a_yes_that_is_not_plain_is_read_back(standing: Standing, by: str) -> None:
    state, name = grounded()
    yes = Answer(reply=Reply.YES, latency_s=1.0, standing=standing, by=by)
    state, directives = step(state, Answered(time_s=1.0, question=name, answer=yes))
    assert not any(isinstance(d, Move) for d in directives)
    assert state.question is not None
    assert state.question.question.read_back is not None
    confirmed = replace(yes, standing=Standing.CONFIRMED)
    _, directives = step(state, Answered(time_s=2.0, question=name, answer=confirmed))
    assert any(isinstance(d, Move) and isinstance(d.motion, TakeOff) for d in directives)


def test_a_confirmation_of_nothing_is_no_go() -> None:
    state, name = grounded()
    yes = Answer(reply=Reply.YES, latency_s=1.0, standing=Standing.CONFIRMED, by="voice")
    state, directives = step(state, Answered(time_s=1.0, question=name, answer=yes))
    assert not any(isinstance(d, Move) for d in directives)
    assert state.grounded


@pytest.mark.parametrize("order", list(Order))
def test_orders_on_the_ground_wait_or_end_it(order: Order) -> None:
    state, _ = grounded()
    after, directives = step(state, Ordered(time_s=1.0, order=order))
    assert not any(isinstance(d, Move) for d in directives)
    assert after.ended == (order not in (Order.HOLD, Order.CONTINUE))


def test_what_is_lost_before_take_off_ends_it_and_better_words_change_nothing() -> None:
    state, name = grounded()
    for link in (Link.CAMERA, Link.POSITION, Link.TELEMETRY):
        after, directives = step(state, LinkChanged(time_s=1.0, link=link, up=False))
        assert after.ended
        assert any(isinstance(d, Finish) for d in directives)
    same, directives = step(state, QuestionReworded(time_s=1.0, question=name, text="Fly?", worded_by="model"))
    assert directives == ()
    assert same.question == state.question
    after, _ = step(state, Ticked(time_s=BRIEFING_S + 1.0))
    assert after.ended


@pytest.mark.long
def test_a_briefed_mission_is_thought_through_again(tmp_path) -> None:  # type: ignore[no-untyped-def]
    run = RunFolder(tmp_path / "run")
    with (
        run,
        components_for(
            WORLD,
            Choices(vehicle="kinematic", briefs=True),
            operators=(scripted_operator(WORLD, OperatorSpec()),),
            recorder=run,
            digests=True,
        ) as components,
    ):
        fly_mission(components)
    assert verify_run(tmp_path / "run").verification.difference is None
