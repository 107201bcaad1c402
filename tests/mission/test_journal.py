"""What the recorder is told of a question's time."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mintpilot.core.events import QuestionTimed
from mintpilot.core.inputs import MoreTimeWanted, Ticked
from mintpilot.mission.journal import Journal
from mintpilot.mission.state import MissionState
from mintpilot.mission.step import step
from mintpilot.recording.recorders import MemoryRecorder

from .test_telling import asking


def told(before: MissionState, event, after: MissionState) -> list[QuestionTimed]:
    recorder = MemoryRecorder()
    Journal(recorder).keep(before, event, after, ())
    return [entry for entry in recorder.events if isinstance(entry, QuestionTimed)]


def test_a_new_deadline_is_told_whatever_moved_it() -> None:
    state = asking()
    open_ = state.question
    assert open_ is not None
    tick = Ticked(time_s=0.0)
    assert told(state, tick, step(state, tick)[0]) == []
    granted = MoreTimeWanted(time_s=1.0, question=open_.question.id)
    longer = step(state, granted)[0]
    told_once = told(state, granted, longer)
    assert [(one.question, one.extended) for one in told_once] == [(open_.question.id, True)]
    assert told_once[0].deadline_s == longer.question.deadline_s  # type: ignore[union-attr]
    moved = replace(state, question=replace(open_, needed_s=12.5))  # as flying meanwhile does
    assert [one.deadline_s for one in told(state, tick, moved)] == [12.5]
    put = told(replace(state, question=None), tick, state)
    assert [one.deadline_s for one in put] == [pytest.approx(open_.deadline_s)]
