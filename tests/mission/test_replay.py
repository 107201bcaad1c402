"""Recorded missions are thought through again: equal, or the first difference is named."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from tests.mission.scenes import hall, wall

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.components import Choices, VehicleChoice, components_for
from mintpilot.assembly.replaying import parts_of, verify_run
from mintpilot.assembly.worlds import build_world
from mintpilot.cli.main import main
from mintpilot.core.errors import RecordError
from mintpilot.core.events import MissionStarted, Stepped
from mintpilot.core.inputs import Answered, DeliberationEnded
from mintpilot.core.query import Answer, Order, Reply
from mintpilot.interaction.scripted import RecordedOperator
from mintpilot.mission.loop import fly_mission
from mintpilot.mission.replay import verify
from mintpilot.mission.worker import InlineWorker
from mintpilot.recording.event_log import EVENTS_SCHEMA_VERSION
from mintpilot.recording.recorders import MemoryRecorder

BUSY = {"orders": [(2.0, Order.HOLD), (6.0, Order.CONTINUE), (14.0, Order.RETURN)]}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("runs") / "run"
    late = Answer(reply=Reply.NO, latency_s=1.5, text="no")
    operator = RecordedOperator([late, Reply.NO], **BUSY)
    run_mission(
        hall(solids=[wall("fallen", 8.0, (0.5, 6.0), appears_s=9.0)]), operator=operator, vehicle="kinematic", out=out
    )
    return out


@pytest.mark.long
def test_a_mission_with_questions_orders_and_news_is_equal(run: Path) -> None:
    done = verify_run(run)
    assert done.verification.difference is None
    assert done.verification.steps > 50
    assert done.verification.deliberations >= 4
    assert done.cut == ""


def test_the_strategy_is_the_one_that_was_flown_with_its_arguments_and_all_that_it_is_put_into() -> None:
    world = build_world(hall(), base=Path(), seed=3)
    for choices in (
        Choices(vehicle=VehicleChoice.KINEMATIC),
        Choices(vehicle=VehicleChoice.KINEMATIC, strategy="knowno", strategy_arguments={"quantile": 0.8}),
    ):
        with components_for(world, choices, operators=(), recorder=MemoryRecorder()) as made:
            assert layers(parts_of(made.started()).strategy) == layers(made.parts.strategy)


def layers(strategy: object) -> list[tuple[str, object]]:
    """What a strategy is made of, from outside in."""
    inner = getattr(strategy, "strategy", None)
    own = {key: value for key, value in vars(strategy).items() if isinstance(value, int | float | str)}
    return [(type(strategy).__name__, own), *(layers(inner) if inner is not None else [])]


@pytest.mark.long
def test_the_command_says_so(run: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", str(run), "--verify", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["equal"] is True
    assert main(["replay", str(run), "--verify"]) == 0
    assert "bit for bit" in capsys.readouterr().out
    assert main(["replay", str(run)]) == 0
    assert "What it asked" in capsys.readouterr().out


@pytest.mark.parametrize("delay_s", [0.0, 3.0, 12.0])
def test_late_deliberations_are_equal(delay_s: float) -> None:
    steps = recorded(delay_s)
    assert verify(steps[0], numbered(steps), parts_of(steps[0])).difference is None


def recorded(delay_s: float) -> list:
    world, recorder = build_world(hall(), base=None, seed=0), MemoryRecorder()
    choices, people = Choices(vehicle="kinematic"), (RecordedOperator([Reply.NO]),)
    with components_for(world, choices, operators=people, recorder=recorder, digests=True) as made:
        fly_mission(replace(made, worker=lambda parts: InlineWorker(parts, delay_s=delay_s)))
    return [e for e in recorder.events if isinstance(e, MissionStarted | Stepped)]


def numbered(events: list) -> list[tuple[int, Stepped]]:
    return [(number, event) for number, event in enumerate(events) if isinstance(event, Stepped)]


def test_another_answer_is_found_and_told_with_the_event_before_it() -> None:
    events = recorded(0.0)
    at = next(i for i, e in enumerate(events) if isinstance(e, Stepped) and isinstance(e.input, Answered))
    answered = events[at].input
    events[at] = replace(events[at], input=replace(answered, answer=replace(answered.answer, reply=Reply.YES)))
    difference = verify(events[0], numbered(events), parts_of(events[0])).difference
    assert difference is not None
    assert difference.number == at
    assert "Answered" in difference.event
    assert "QuestionShown" in difference.before


def test_another_decision_is_found() -> None:
    events = recorded(0.0)
    at = max(
        i
        for i, e in enumerate(events)
        if isinstance(e, Stepped) and isinstance(e.input, DeliberationEnded) and hasattr(e.input.decision, "plan")
    )
    ended = events[at].input
    plan = replace(ended.decision.plan, cost_s=ended.decision.plan.cost_s + 1e-6)
    events[at] = replace(events[at], input=replace(ended, decision=replace(ended.decision, plan=plan)))
    difference = verify(events[0], numbered(events), parts_of(events[0])).difference
    assert difference is not None
    assert difference.number == at
    assert "plan.cost_s" in difference.what


def test_another_instruction_or_another_code_is_found() -> None:
    """Settings that the mission was not flown with stand for a program that behaves otherwise."""
    events = recorded(0.0)
    asking = replace(events[0].mission.asking, max_questions=0)
    started = replace(events[0], mission=replace(events[0].mission, asking=asking))
    assert verify(started, numbered(events), parts_of(started)).difference is not None


def test_records_that_cannot_be_replayed_say_why(run: Path, tmp_path: Path) -> None:
    lines = (run / "events.ndjson").read_bytes().splitlines(keepends=True)

    def written(name: str, data: bytes) -> Path:
        (tmp_path / name).mkdir()
        (tmp_path / name / "events.ndjson").write_bytes(data)
        return tmp_path / name

    cut = verify_run(written("cut", b"".join(lines[:60]) + lines[60][:30]))
    assert cut.cut
    assert cut.verification.difference is None
    for name, data in (
        ("edited", b"".join(lines).replace(b'"no"', b'"yes"', 1)),
        ("missing", b"".join([*lines[:20], *lines[21:]])),
        ("foreign", b'{"hello": "world"}\n'),
        ("empty", b""),
        ("newer", b"".join(lines).replace(b'"schema_version":%d' % EVENTS_SCHEMA_VERSION, b'"schema_version":99', 1)),
    ):
        with pytest.raises(RecordError):
            verify_run(written(name, data))
    with pytest.raises(RecordError):
        verify_run(tmp_path / "nothing")
    assert main(["replay", str(tmp_path / "foreign"), "--verify"]) == 4
