"""Look or ask (method, section 11): whichever tells more of the plan for each second, where it pays."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.components import Choices, VehicleChoice, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.core.events import Noticed
from mintpilot.core.ports import Ask, Fly
from mintpilot.core.query import Answer, Reply
from mintpilot.core.tree import StopReason
from mintpilot.mission.rehearsal import begin
from mintpilot.mission_file.schema import MissionFile

KINEMATIC = Choices(vehicle=VehicleChoice.KINEMATIC)


def hall(
    *, dwell_s: float = 1.0, sees: float = 0.9, looks: bool = True, toxic: bool = False, asking: dict | None = None,
    **more: object,
) -> MissionFile:  # fmt: skip
    """A cloud in the short way and a way round it; beside the short way a place to look at the cloud from."""
    wall = {"kind": "wall"}
    return MissionFile.model_validate(
        {
            "mintpilot": 1,
            "name": "look",
            "instruction": "Go to the injured person.",
            "looks": [{"at": "s1", "viewpoint_m": [5, 4, 1.2], "dwell_s": dwell_s, "sees": sees}] if looks else [],
            "asking": asking or {},
            "world": {
                "scene": {
                    "volume": {"lo_m": [0, 0, 0], "hi_m": [14, 16, 2.6]},
                    "start_m": [2, 4, 1.2],
                    "solids": [
                        {"id": "w1", "extent_m": {"lo_m": [7.0, 0, 0], "hi_m": [7.2, 3, 2.6]}, **wall},
                        {"id": "w2", "extent_m": {"lo_m": [7.0, 5, 0], "hi_m": [7.2, 14, 2.6]}, **wall},
                    ],
                    "smokes": [
                        {"id": "s1", "extent_m": {"lo_m": [6.2, 2.8, 0], "hi_m": [8.0, 5.2, 2.6]}, "toxic": toxic}
                    ],
                    "persons": [{"id": "p1", "position_m": [12, 4, 0]}],
                }
            },
            **more,
        }
    )


def decided(file: MissionFile):
    world = build_world(file, base=Path(), seed=0)
    return begin(deliberation_parts(world, KINEMATIC), world.map).deliberated()


def test_a_cheap_look_on_the_way_is_taken_instead_of_asking():
    decision = decided(hall()).decision
    assert isinstance(decision, Fly)
    assert decision.certificate.reason is StopReason.LOOK
    assert [leg.stop.gap for leg in decision.plan.legs] == ["obstacle:s1"]


@pytest.mark.long
@settings(deadline=None, max_examples=12)
@given(dwell_s=st.floats(0, 30), sees=st.floats(0.05, 1), reply_s=st.floats(0.5, 30))
def test_what_tells_more_a_second_is_done(dwell_s: float, sees: float, reply_s: float):
    found = decided(hall(dwell_s=dwell_s, sees=sees, asking={"reply_s": reply_s}))
    (option,) = found.situation.looks
    # One cloud of even odds, two plans: the question tells one bit, the look as much where it sees.
    saved_s = sees * (19.2188 - 8.8016) / 2
    looks = sees / option.seconds > 1 / reply_s and saved_s > option.seconds
    assert isinstance(found.decision, Fly if looks else Ask)


def test_without_looks_the_query_is_that_of_the_method_alone():
    dear, none = decided(hall(dwell_s=100.0)).decision, decided(hall(looks=False)).decision
    assert isinstance(dear, Ask)
    assert isinstance(none, Ask)
    assert dear.scored == none.scored


def test_with_questions_forbidden_it_looks_where_that_pays_and_only_there():
    pays = decided(hall(sees=0.9, asking={"max_questions": 0, "reply_s": 0.0})).decision
    assert isinstance(pays, Fly)
    assert pays.certificate.reason is StopReason.LOOK
    dear = decided(hall(dwell_s=6.0, asking={"max_questions": 0})).decision
    assert isinstance(dear, Fly)
    assert dear.certificate.reason is not StopReason.LOOK


def test_no_look_spends_the_battery_of_the_way_that_is_safe():
    """The cautious way takes 19.2 s; a fifth of the battery is left by plans."""
    just = decided(hall(vehicle={"endurance_s": 19.5 / 0.8}))
    assert not just.situation.looks


@pytest.mark.parametrize("toxic", [False, True])
def test_flown_it_looks_once_asks_nothing_and_never_enters_toxic_smoke(toxic: bool):
    record = run_mission(hall(sees=1.0, toxic=toxic), vehicle="kinematic")
    assert record.outcome.value == "success", record.reason
    assert not record.questions
    assert [one.text for one in record.achieved].count("look at the smoke") == 1
    assert record.gaps[0].why.startswith("Looked at")


@pytest.mark.long
def test_a_look_that_sees_nothing_is_not_tried_again():
    file = hall(sees=0.5, asking={"reply_s": 30.0})
    records = [run_mission(file, vehicle="kinematic", seed=seed) for seed in range(6)]
    looks = [[one.text for one in record.achieved].count("look at the smoke") for record in records]
    assert looks == [1] * 6
    assert {len(record.questions) for record in records} == {0, 1}


def test_an_unsure_operator_makes_it_look_where_that_pays():
    world = build_world(hall(dwell_s=1.0, asking={"reply_s": 0.5}), base=Path(), seed=0)
    here = begin(deliberation_parts(world, KINEMATIC), world.map)
    found = here.deliberated()
    assert isinstance(found.decision, Ask)
    after = here.asked(found).answered(Answer(reply=Reply.UNSURE, latency_s=0.0)).deliberated()
    assert isinstance(after.decision, Fly)
    assert after.decision.certificate.reason is StopReason.LOOK


@pytest.mark.parametrize("vehicle", [VehicleChoice.MAVLINK, VehicleChoice.MUJOCO])
def test_where_nothing_settles_a_look_it_is_not_offered(vehicle: VehicleChoice):
    world = build_world(hall(sees=1.0), base=Path(), seed=0)
    parts = deliberation_parts(world, Choices(vehicle=vehicle))
    assert parts.mission.looks == ()
    assert isinstance(begin(parts, world.map).deliberated().decision, Ask)


@pytest.mark.sim
@pytest.mark.slow
def test_and_that_is_said():
    pytest.importorskip("mujoco", reason="needs MuJoCo")
    events: list[object] = []
    run_mission(hall(sees=1.0), vehicle="mujoco", progress=events.append)
    assert [e for e in events if isinstance(e, Noticed) and "left out" in str(e.text) and "s1" in str(e.text)]


@pytest.mark.parametrize(("valid_s", "through"), [(120.0, True), (2.0, False)])
def test_what_was_seen_ages_like_an_answer(valid_s: float, through: bool):
    """With two seconds nothing that was seen lasts until the drone is through the cloud: it goes round."""
    file = hall(sees=1.0, asking={"answer_valid_s": valid_s, "max_questions": 0})
    record = run_mission(file, vehicle="kinematic")
    assert record.outcome.value == "success", record.reason
    assert [one.text for one in record.achieved].count("look at the smoke") == 1
    assert (record.achieved[-1].at_s < 15.0) is through
