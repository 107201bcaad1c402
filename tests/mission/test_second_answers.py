"""Answers and deadlines that come together in one moment."""

from __future__ import annotations

import pytest
from tests.mission.test_telling import Scene

from mintpilot.core.inputs import Answered, Ticked
from mintpilot.core.query import Answer, Reply
from mintpilot.mission.directives import Deliberate
from mintpilot.mission.permissions import permissions
from mintpilot.mission.requests import Purpose


def answer(scene: Scene, reply: Reply, question: str) -> None:
    scene.feed(Answered(time_s=1.0, question=question, answer=Answer(reply=reply, latency_s=1.0, text=reply.value)))


@pytest.mark.parametrize("first", [Reply.YES, Reply.NO])
def test_of_two_answers_in_one_moment_the_first_counts_and_the_second_adds_caution_only(first: Reply) -> None:
    """Before anything was thought of the first one: the map does not say yet what it has settled."""
    scene = Scene()
    assert scene.state.question is not None
    question = scene.state.question.question
    name, gap = question.id, question.query.gap_ids[0]
    settings = scene.state.setup.mission.asking
    begun = permissions(scene.beliefs, settings)
    second = Reply.NO if first is Reply.YES else Reply.YES
    answer(scene, first, name)
    after_first = scene.beliefs
    answer(scene, second, name)
    said, now = permissions(after_first, settings), permissions(scene.beliefs, settings)
    assert now.enter <= said.enter
    assert now.leave_out <= said.leave_out
    assert now.pick <= said.pick
    if said == begun:
        assert scene.beliefs.belief.marginal(gap).tolist() == after_first.belief.marginal(gap).tolist()
        assert scene.beliefs.asked == after_first.asked
    else:
        assert now == begun, "what adds caution is heard"


def test_a_question_and_what_is_worked_out_for_it_may_end_in_one_tick() -> None:
    scene = Scene()
    open_ = scene.state.question
    assert open_ is not None
    directives = scene.feed(Ticked(time_s=open_.moves_s))
    assert [d.request.purpose for d in directives if isinstance(d, Deliberate)] == [Purpose.MEANWHILE]
    scene.feed(Ticked(time_s=open_.deadline_s + 60.0))
    assert scene.state.question is None
    assert scene.state.request is None or scene.state.request.purpose is Purpose.MISSION
