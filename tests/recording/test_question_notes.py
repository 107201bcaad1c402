"""What is shown of an open question: figures, the map, and pictures of what it is about."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mintpilot.assembly.api import run_mission
from mintpilot.core.events import Asked, Event, MapUpdated
from mintpilot.core.gap import GapKind
from mintpilot.core.query import Question
from mintpilot.recording.question_notes import QuestionNotes

MISSION = Path("examples/my-building/mission.yaml")


@pytest.fixture(scope="module")
def flown(tmp_path_factory) -> tuple[QuestionNotes, list[Event]]:
    folder = tmp_path_factory.mktemp("run")
    notes, events = QuestionNotes(folder), []

    def both(event: Event) -> None:
        notes(event)
        events.append(event)

    run_mission(MISSION, operator="scripted", vehicle="kinematic", out=folder, progress=both)
    return notes, events


def asked(events: list[Event]) -> Question:
    return next(e.question for e in events if isinstance(e, Asked) and e.question.gaps[0].kind is not GapKind.GO)


@pytest.mark.long
def test_the_figures_behind_a_question_are_told(flown):
    notes, events = flown
    said = notes.why(asked(events))
    assert "bits" in said[-1]
    assert any(" s " in line for line in said[:-1])
    assert notes.why(replace(asked(events), gaps=())) == ()


@pytest.mark.long
def test_the_map_is_written(flown):
    notes, events = flown
    (chart,) = notes.draw(asked(events))
    with Image.open(chart) as picture:
        assert len(np.unique(np.asarray(picture.convert("L")))) > 10


@pytest.mark.long
def test_a_picture_of_the_thing_is_written_with_its_outline(flown):
    notes, events = flown
    question = asked(events)
    name = (question.gaps[0].values if question.gaps[0].candidates else (question.gaps[0].subject,))[0]
    map = [e.map for e in events if isinstance(e, MapUpdated)][-1]
    seen = replace(
        map,
        objects=tuple(replace(o, best_view=(7, 10, 10, 30, 30)) if o.id == name else o for o in map.objects),
        regions=tuple(replace(o, best_view=(7, 10, 10, 30, 30)) if o.id == name else o for o in map.regions),
        rooms=tuple(replace(o, best_view=(7, 10, 10, 30, 30)) if o.id == name else o for o in map.rooms),
    )
    notes(MapUpdated(map=seen, why="seen"))
    (notes.folder / "frames").mkdir(exist_ok=True)
    Image.new("RGB", (64, 48)).save(notes.folder / "frames" / "00007.jpg")
    _, file = notes.draw(question)
    with Image.open(file) as picture:
        assert picture.getpixel((10, 20)) == (255, 220, 0)
        assert picture.getpixel((20, 20)) == (0, 0, 0)


@pytest.mark.long
def test_without_a_map_there_is_nothing_to_draw(tmp_path, flown):
    assert QuestionNotes(tmp_path).draw(asked(flown[1])) == ()
