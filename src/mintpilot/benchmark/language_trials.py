"""What a language model adds to the rules: instructions, answers, wordings, time."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import mean, quantiles

from mintpilot.benchmark.instruction_trials import Score, read_rows, score
from mintpilot.benchmark.language_cases import AnswerCase, asked, box
from mintpilot.core.gap import (
    ABSENT,
    BLOCKED,
    PASSABLE,
    PRESENT,
    GapKind,
    KnowledgeGap,
    obstacle_id,
    presence_id,
    target_id,
)
from mintpilot.core.ports import Completion, LanguageModel
from mintpilot.core.query import Question, Reply, Saying, SayingKind
from mintpilot.core.reading import Reading, ReadingKind, guarded_replies, reply_of
from mintpilot.elicitation.wording import word_question
from mintpilot.language.answer_model import read_with_model
from mintpilot.language.instruction_model import parse_with_model
from mintpilot.wording.rewording import ModelWording

PATIENT_S = 60.0
"""Quality is measured without hurry; speed apart from it, seconds."""
_HOME_M = (0.0, 0.0, 1.0)
_AGAIN = {"unsure", "other"}
"""Either way it is asked again."""


class Counting(LanguageModel):
    """Notes how often a model was asked, how long it took and what it wrote."""

    def __init__(self, model: LanguageModel) -> None:
        self._model = model
        self.seconds: list[float] = []
        self.tokens = 0

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:
        """The model's own completion, counted."""
        started_s = time.perf_counter()
        completion = self._model.complete(prompt, schema=schema, timeout_s=timeout_s)
        self.seconds.append(time.perf_counter() - started_s)
        self.tokens += completion.tokens
        return completion

    def speed(self) -> Speed:
        """The figures so far."""
        cuts = quantiles(self.seconds, n=20) if len(self.seconds) > 1 else self.seconds * 19
        return Speed(
            calls=len(self.seconds), p50_s=cuts[9] if cuts else None, p95_s=cuts[18] if cuts else None,
            tokens=self.tokens,
        )  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Speed:
    """How long a model took."""

    calls: int
    p50_s: float | None
    p95_s: float | None
    tokens: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Answered:
    """Answers understood at once and after a read-back; guarded replies taken but not said; Yes taken for a No."""

    n: int
    understood: int
    after_read_back: int
    false_guarded: int
    no_for_yes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Worded:
    """Wordings proposed by a model, and those that the check let through."""

    n: int
    accepted: int
    changed: int
    """Accepted ones that are not just the template's words."""
    template_words: float
    model_words: float | None
    speed: Speed


def parse_all(file: Path, model: LanguageModel) -> Score:
    """A list of instructions with the steps that they mean, each read by the grammar and, where refused, the model."""
    return score(read_rows(file), lambda text: parse_with_model(text, model, home_m=_HOME_M, timeout_s=PATIENT_S))


def answer_all(cases: Sequence[AnswerCase], model: LanguageModel) -> Answered:
    """Answers read. Where a person was unsure or spoke of something else, both lead to asking again and count."""
    right = confirmed = false_guarded = flipped = 0
    for case in cases:
        guarded = guarded_replies(case.question)
        reading = read_with_model(case.text, case.question, model, guarded=guarded, timeout_s=PATIENT_S)
        got = _as_case(reading, case.question)
        right += got == case.reading or (got in _AGAIN and case.reading in _AGAIN)
        confirmed += reading.label == f"read-back:{case.reading}"
        is_plain = reading.kind in (ReadingKind.YES, ReadingKind.NO) and reading.reply in guarded
        false_guarded += is_plain and got != case.reading
        flipped += got == Reply.NO and case.reading == Reply.YES
    return Answered(
        n=len(cases),
        understood=right,
        after_read_back=right + confirmed,
        false_guarded=false_guarded,
        no_for_yes=flipped,
    )


def _as_case(reading: Reading, question: Question) -> str:
    """The reading in the words of the cases; what needs a read-back is not understood yet."""
    if reading.kind is ReadingKind.ORDER:
        return "command"
    if reading.kind in (ReadingKind.YES, ReadingKind.NO, ReadingKind.UNSURE, ReadingKind.EVIDENCE):
        return reply_of(reading, question).value
    return "other" if reading.kind is not ReadingKind.READ_BACK else reading.label


def sampled(cases: Sequence[AnswerCase], most: int) -> list[AnswerCase]:
    """A seeded sample, in order; all where there are no more."""
    kept = set(random.Random(0).sample(range(len(cases)), min(most, len(cases))))
    return [case for index, case in enumerate(cases) if index in kept]


def word_all(model: LanguageModel) -> Worded:
    """Questions as missions ask them, worded by the model."""
    counting = Counting(model)
    wording = ModelWording(template=word_question, model=counting, timeout_s=PATIENT_S)
    questions = list(_questions())
    for question in questions:
        wording.improve(question)
    used = [trial for trial in wording.trials if not trial.doubt]
    return Worded(
        n=len(questions),
        accepted=len(used),
        changed=sum(trial.proposed != trial.template for trial in used),
        template_words=mean(len(q.text.split()) for q in questions),
        model_words=mean(len(t.proposed.split()) for t in used) if used else None,
        speed=counting.speed(),
    )


def _questions() -> Iterator[Question]:
    clouds = (
        "the grey smoke near the gate",
        "the dark smoke next to the blue rack",
        "the smoke",
        "the thin smoke by the fire",
    )
    rooms = "the closed room", "the closed room with the brown door", "the room in the far corner"
    for number, called in enumerate(clouds):
        yield _about(obstacle_id(str(number)), GapKind.OBSTACLE, called, (PASSABLE, BLOCKED))
    for number, called in enumerate(rooms):
        yield _about(presence_id(str(number)), GapKind.PRESENCE, called, (PRESENT, ABSENT))
    looks = (("small", "red"), ("large", "blue"), ("small", "green"), ("large", "white"))
    boxes = tuple(box(f"box-{i}", size, colour) for i, (size, colour) in enumerate(looks))
    gap = KnowledgeGap(
        id=target_id(1, "box"), kind=GapKind.TARGET, subject="the box", description="the box", candidates=boxes,
        values=tuple(c.id for c in boxes), prior=(0.25,) * 4, position_m=(0.0, 0.0, 0.0),
    )  # fmt: skip
    for i, (_, colour) in enumerate(looks):
        yield _worded(gap, {f"box-{i}"}, Saying(kind=SayingKind.VALUE, value=f"box-{i}"))
        yield _worded(gap, {f"box-{i}"}, Saying(kind=SayingKind.ATTRIBUTE, name="colour", value=colour))
    for size, ids in (("small", {"box-0", "box-2"}), ("large", {"box-1", "box-3"})):
        yield _worded(gap, ids, Saying(kind=SayingKind.ATTRIBUTE, name="size", value=size))


def _about(name: str, kind: GapKind, called: str, values: tuple[str, str]) -> Question:
    gap = KnowledgeGap(
        id=name, kind=kind, subject=name, description=called, values=values, prior=(0.5, 0.5),
        position_m=(0.0, 0.0, 0.0),
    )  # fmt: skip
    return _worded(gap, {values[0]}, Saying(kind=SayingKind.VALUE, value=values[0]))


def _worded(gap: KnowledgeGap, values: set[str], saying: Saying) -> Question:
    return word_question(asked(gap, values, saying, "?", yes="", no="").query, (gap,), None)
