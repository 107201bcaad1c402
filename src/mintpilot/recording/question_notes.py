"""What somebody who is asked may want to see: the place on the map, pictures, and the figures behind the question."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from PIL import Image, ImageDraw

from mintpilot.core.decisions import AskQuestion
from mintpilot.core.events import Event, MapUpdated, MissionStarted, Stepped
from mintpilot.core.inputs import DeliberationEnded
from mintpilot.core.message import NOTHING, Message, message
from mintpilot.core.mission import Mission
from mintpilot.core.query import Question
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.tree import GapExplanation
from mintpilot.recording.build import speech_of
from mintpilot.recording.frames import FRAMES, FrameStore
from mintpilot.wording.speech import IN_ENGLISH, Speech

MOST_PICTURES = 2
"""Pictures written for one question: those in which most of what it is about is seen."""


@dataclass(slots=True)
class QuestionNotes:
    """Follows a mission by its events, and answers *where*, *show* and *why* for the question that is open."""

    folder: Path
    """The run folder: its pictures are read, and what is drawn is written there."""
    _map: SemanticMap | None = None
    _mission: Mission | None = None
    _why: dict[str, GapExplanation] = field(default_factory=dict)
    _worth: Message = NOTHING
    _speech: Speech = IN_ENGLISH

    def __call__(self, event: Event) -> None:
        """Takes in one event."""
        match event:
            case MissionStarted():
                self._mission = event.mission
                self._speech = speech_of(event)
            case MapUpdated():
                self._map = event.map
            case Stepped(input=DeliberationEnded(decision=AskQuestion() as asked)):
                self._why |= {one.gap_id: one for one in asked.reasoning.explanations}
                scored = asked.scored
                self._worth = message(
                    "It is worth {gain_bits:.2f} bits and {saved_s:.0f} s of flight.",
                    gain_bits=scored.gain_bits,
                    saved_s=scored.regret_saved_s,
                )

    def why(self, question: Question) -> tuple[str, ...]:
        """The figures behind a question, a sentence each; empty where it was not thought about (before take-off)."""
        found = [one.figures or one.why for gap in question.gaps if (one := self._why.get(gap.id)) is not None]
        return tuple(self._speech(one) for one in (*found, self._worth)) if found else ()

    def draw(self, question: Question) -> tuple[Path, ...]:
        """Writes the map with the places that the question is about, and pictures of them where there are any.

        Raises:
            OSError: a file cannot be written.
        """
        if self._map is None:
            return ()
        from mintpilot.recording.topdown import TopDown, save_topdown

        place = self.folder / "questions"
        place.mkdir(parents=True, exist_ok=True)
        spots = tuple((words, at) for gap in question.gaps for _, words, at in gap.spots)
        start_m = self._mission.start_m if self._mission is not None else self._map.frame.box.centre_m
        name = question.id or "question"
        chart = place / f"{name}-map.png"
        save_topdown(TopDown(map=self._map, start_m=start_m, goals=spots, speech=self._speech), chart)
        return (chart, *self._pictures(question, self._map, place, name))

    def _pictures(self, question: Question, map: SemanticMap, place: Path, title: str) -> list[Path]:
        boxes: dict[int, list[tuple[int, ...]]] = {}
        for gap in question.gaps:
            for name, _, _ in gap.spots:
                view = map.best_view(name)
                if view is not None:
                    boxes.setdefault(view[0], []).append(view[1:])
        store, written = FrameStore(self.folder / FRAMES), []
        for index, outlines in sorted(boxes.items(), key=lambda item: -len(item[1]))[:MOST_PICTURES]:
            source = store.file(index)
            if not source.is_file():
                continue
            with Image.open(source) as opened:
                picture = opened.convert("RGB")
            pen = ImageDraw.Draw(picture)
            for left, top, right, bottom in outlines:
                pen.rectangle((left, top, max(left, right), max(top, bottom)), outline=(255, 220, 0), width=2)
            file = place / f"{title}-picture-{index}.png"
            picture.save(file)
            written.append(file)
        return written
