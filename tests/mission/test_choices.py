"""A mission that asks choices: scripted, replayed, and guarded where the answer is not plain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mintpilot.assembly.components import Choices, components_for
from mintpilot.assembly.worlds import build_world
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Answer, Question, Reply, Standing
from mintpilot.interaction.scripted import FunctionOperator, ScriptedOperator
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.schema import MissionFile
from mintpilot.recording.recorders import MemoryRecorder

BOXES = MissionFile.model_validate(
    {
        "mintpilot": 1,
        "name": "boxes",
        "instruction": "Pick up the medicine from the box and bring it to the injured person.",
        "world": {"scenario": "medicine-boxes"},
        "asking": {"kinds": "any"},
    }
)


def fly(answer, confirm: bool = True) -> tuple[Outcome, list[Question]]:
    """The mission with somebody who answers choices as told; the questions that were put, read-backs included."""
    put: list[Question] = []
    world = build_world(BOXES, base=None, seed=4)
    truthful = ScriptedOperator(world.truth, rng=np.random.default_rng(0))

    def reply(question: Question, patience_s: float) -> Answer | Reply:
        put.append(question)
        if question.read_back is not None:
            return replace(question.read_back, standing=Standing.CONFIRMED) if confirm else Reply.TIMEOUT
        return answer(truthful.answer(question, patience_s), question)

    with components_for(
        world, Choices(vehicle="kinematic"), operators=(FunctionOperator(reply),), recorder=MemoryRecorder()
    ) as made:
        return fly_mission(made).outcome, put


def test_a_choice_finds_the_box_in_fewer_questions() -> None:
    outcome, put = fly(lambda answer, question: answer)
    assert outcome is Outcome.SUCCESS
    assert any(question.query.is_choice for question in put)
    # Three boxes that may be meant take two questions by yes and no, if the first one is a no.
    assert len(put[0].gaps[0].values) == 3
    assert len(put) == 1


@pytest.mark.parametrize("how", [{"standing": Standing.UNCONFIRMED}, {"by": "voice"}, {"understood_by": "model"}])
def test_an_option_that_settles_what_is_picked_up_is_read_back_unless_it_is_plain(how: dict[str, str]) -> None:
    outcome, put = fly(lambda answer, question: replace(answer, **how))
    assert outcome is Outcome.SUCCESS
    read_back = [question for question in put if question.read_back is not None]
    assert len(read_back) == 1
    assert all(q.read_back.part is not None for q in read_back)


def test_what_is_never_confirmed_is_no_permission() -> None:
    outcome, put = fly(lambda answer, question: replace(answer, standing=Standing.UNCONFIRMED), confirm=False)
    assert outcome is not Outcome.SUCCESS
    assert any(question.read_back is not None for question in put)
