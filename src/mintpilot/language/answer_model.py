"""Answers that the rules do not understand, read with a language model that is not trusted (method, section 12)."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Literal

from mintpilot.core.errors import MintPilotError
from mintpilot.core.ports import LanguageModel
from mintpilot.core.query import Question, Reply
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind, opposite
from mintpilot.language.answer_text import LONGEST, vetoes
from mintpilot.language.answers import read_answer
from mintpilot.models.forms import StrictForm, read_form

READING_S = 2.0
"""Seconds that a model may take for one reading; it is asked twice."""
_SHOTS = (
    ("Is the bridge safe to cross?", "it collapsed last winter", "no", "yes"),
    ("Is it one of the green bags?", "big fat affirmative", "yes", "no"),
    ("Is somebody inside the tent?", "let me phone the warden first", "unsure", "unsure"),
    ("Is it the small lamp?", "my cat is asleep", "other", "other"),
    ("Is somebody inside the barn?", "my uncle never came out of it", "yes", "no"),
)
_TASK = "An operator replied to a drone's question. What does the reply mean: yes, no, unsure or other?"
_TURNED = _TASK.replace("does the reply mean", "is the opposite of the reply")


class AnswerReading(StrictForm):
    """What a model takes an answer for. Orders are not among it: those must be heard by the rules."""

    reading: Literal["yes", "no", "unsure", "other"]


def read_with_model(
    text: str,
    question: Question,
    model: LanguageModel,
    *,
    guarded: Collection[Reply],
    lang: str = "en",
    by: AnsweredBy = AnsweredBy.TYPED,
    pending: Reply | None = None,
    timeout_s: float = READING_S,
) -> Reading:
    """Reads an answer by rules, and what they do not understand by a model.

    The model is asked twice, the second time for the opposite, and counts only where both readings agree. It can only
    suggest a reply to be read back, guarded or not, and only where no veto is among the words.

    Arguments as of `read_answer`; ``timeout_s`` is for each of the two. An answer to a read-back is never given to it.
    """
    reading = read_answer(text, question, guarded=guarded, lang=lang, by=by, pending=pending)
    is_final = reading.kind is not ReadingKind.AGAIN or pending is not None or by is AnsweredBy.KEY
    is_final |= question.query.is_choice  # it is asked for yes and no only
    if is_final or not text.strip() or len(text) > LONGEST:
        return reading
    open_replies = [reply for reply in (Reply.YES, Reply.NO) if not vetoes(text, lang, reply)]
    first = _ask(model, text, question, timeout_s, turned=False) if open_replies else None
    if first not in open_replies or _ask(model, text, question, timeout_s, turned=True) is not opposite(first):
        return reading
    return replace(reading, kind=ReadingKind.READ_BACK, reply=first, vetoes=(), by="model")


def _ask(model: LanguageModel, text: str, question: Question, timeout_s: float, *, turned: bool) -> Reply | None:
    said = " ".join(text.split())
    shots = (f'Question: {q}\nReply: {a}\nAnswer: {{"reading": "{no if turned else yes}"}}' for q, a, yes, no in _SHOTS)
    asked = f"Question: {question.text}\nReply: {said}\nAnswer:"
    prompt = "\n".join((_TURNED if turned else _TASK, *shots, asked))
    try:
        completion = model.complete(prompt, schema=AnswerReading, timeout_s=timeout_s)
    except MintPilotError:
        return None
    except Exception:  # a stranger's model may fail in any way: then it has no say
        return None
    found = read_form(completion.text, AnswerReading)
    return None if found is None or found.reading == "other" else Reply(found.reading)
