"""Answers read without a mission: their readings and what they would allow (method, section 12)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from mintpilot.assembly.sample_question import question_about, sample_question
from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import InputError
from mintpilot.core.gap import ABSENT, PASSABLE, Candidate, GapKind, KnowledgeGap
from mintpilot.core.observation import Attribute
from mintpilot.core.query import Question, Reply
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind, guarded_replies, possible_values
from mintpilot.language.answers import read_answer
from mintpilot.mission_file.reader import read_mission
from mintpilot.mission_file.yaml_places import Value, read_document
from mintpilot.uncertainty.findings import find_gaps


@dataclass(frozen=True, slots=True, kw_only=True)
class UnderstoodAnswer:
    """One answer with its reading."""

    text: str
    reading: Reading
    permissions: tuple[str, ...]
    """What it would allow, after a confirmation where it needs one: ``enter:smoke-1``, ``leave-out:room-1``,
    ``pick:box-1``."""

    @property
    def needs_read_back(self) -> bool:
        """Whether it has no effect before it is confirmed."""
        return self.reading.kind in (ReadingKind.READ_BACK, ReadingKind.EVIDENCE)


def understand_answers(
    texts: Iterable[str], question: Question, *, lang: str, by: AnsweredBy
) -> tuple[UnderstoodAnswer, ...]:
    """Reads each text as an answer to the question. Raises `UnknownNameError` for a language that is not known."""
    guarded = guarded_replies(question)
    readings = ((text, read_answer(text, question, guarded=guarded, lang=lang, by=by)) for text in texts)
    return tuple(
        UnderstoodAnswer(text=text, reading=reading, permissions=permissions_of(reading, question))
        for text, reading in readings
    )


def permissions_of(reading: Reading, question: Question) -> tuple[str, ...]:
    """What the reading alone would allow: regions that may be entered, searches left out, the thing that is meant.

    Of a question about several gaps only what the reply settles by itself: every part of a Yes to *all of*, or of a No
    to *any of*.
    """
    return tuple(allowed for gap in question.gaps if (allowed := _allowed(gap, _left(gap, reading, question))))


def question_from(path: Path, kind: GapKind, *, lang: str) -> Question:
    """A question about the things in a file.

    Args:
        path: a YAML list of two or more candidates (``id``, ``description``, ``attributes``), or a mission file, whose
            first gap of that kind is asked about.
        kind: what is asked.
        lang: of the words.

    Raises:
        InputError: the file cannot be used; the reason says why.
    """
    document = read_document(path)
    if isinstance(document.value, list) and not document.faults:
        if kind is not GapKind.TARGET:
            raise InputError(f"{path} is a list of candidates: it goes with --kind target only, not {kind.value}")
        return sample_question(kind, lang=lang, candidates=_candidates(document.value, path))
    world = build_world(read_mission(path), base=path.parent, seed=None)
    gaps = find_gaps(world.map, world.task, start_m=world.mission.start_m).gaps
    found = next((gap for gap in gaps if gap.kind is kind), None)
    if found is None:
        there = ", ".join(sorted({gap.kind.value for gap in gaps})) or "none"
        raise InputError(f"{path} has no gap of the kind {kind.value} (kinds there: {there}); choose another --kind")
    return question_about(found, lang=lang)


def _left(gap: KnowledgeGap, reading: Reading, question: Question) -> tuple[str, ...]:
    """The values of the gap that the reading leaves; all where it says nothing of that gap alone."""
    if reading.kind is ReadingKind.EVIDENCE:
        return possible_values(reading, question)
    if reading.kind not in (ReadingKind.YES, ReadingKind.NO, ReadingKind.READ_BACK):
        return gap.values
    if len(question.query.literals) == 1:
        said = reading.reply is Reply.YES
        return tuple(v for v in gap.values if question.query.holds({gap.id: v}) == said)
    said_here = [lit for lit in question.query.literals if lit.gap == gap.id]
    settles = question.query.combine == ("all" if reading.reply is Reply.YES else "any")
    if not settles:
        return gap.values
    holds = reading.reply is Reply.YES
    return tuple(v for v in gap.values if all((v in lit.values) == holds for lit in said_here))


def _allowed(gap: KnowledgeGap, left: tuple[str, ...]) -> str:
    if gap.kind is GapKind.OBSTACLE and left == (PASSABLE,):
        return f"enter:{gap.subject}"
    if gap.kind is GapKind.PRESENCE and left == (ABSENT,):
        return f"leave-out:{gap.subject}"
    return f"pick:{left[0]}" if gap.kind is GapKind.TARGET and len(left) == 1 else ""


def _candidates(items: list[Value], path: Path) -> list[Candidate]:
    found = [_candidate(item, path, number) for number, item in enumerate(items, 1)]
    if len(found) < 2 or len({c.id for c in found}) < len(found):
        raise InputError(f"{path}: candidates must be two or more, with different ids; there are {len(found)}")
    return found


def _candidate(item: Value, path: Path, number: int) -> Candidate:
    attributes = item.get("attributes", {}) if isinstance(item, dict) else None
    if not isinstance(item, dict) or not isinstance(item.get("id"), str) or not isinstance(attributes, dict):
        raise InputError(
            f"{path}: candidate {number} is {str(item)[:80]!r}; write 'id: box-1', 'description: the red box' and "
            "'attributes: {colour: red}'"
        )
    return Candidate(
        id=str(item["id"]),
        position_m=(0.0, 0.0, 0.0),
        attributes=tuple(Attribute(name=name, value=str(value)) for name, value in attributes.items()),
        description=str(item.get("description", "")),
    )
