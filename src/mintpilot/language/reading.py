"""Answers that the rules do not understand, read with a language model that is not trusted."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.errors import MintPilotError
from mintpilot.core.gap import GapKind
from mintpilot.core.ports import LanguageModel
from mintpilot.core.query import Question
from mintpilot.language.answers import Reading, Understood, understand_answer
from mintpilot.language.forms import AnswerReading, read_form

READING_S = 2.0
_LONGEST = 300

_SHOTS = (
    ("Is the bridge safe to cross?", "it collapsed last winter", "no", "yes"),
    ("Is it one of the green bags?", "big fat affirmative", "yes", "no"),
    ("Is somebody inside the tent?", "let me phone the warden first", "unsure", "unsure"),
    ("Is it the small lamp?", "my cat is asleep", "other", "other"),
    ("Is somebody inside the barn?", "my uncle never came out of it", "yes", "no"),
)
_TASK = "An operator replied to a drone's question. What does the reply mean: yes, no, unsure or other?"
_TURNED = "An operator replied to a drone's question. What is the opposite of the reply: yes, no, unsure or other?"


def understand_with_model(
    text: str, question: Question, model: LanguageModel, *, timeout_s: float = READING_S
) -> Understood:
    """Reads a free answer: by rules, and what they take for OTHER by a model.

    The model is asked twice, the second time for the opposite, and counts only where both readings agree.
    It can never open a region: a Yes about an obstacle must be one that the rules understand.

    Args:
        text: the words.
        question: what was asked.
        model: who is asked where the rules do not understand.
        timeout_s: for each of the two, seconds.
    """
    understood = understand_answer(text, question)
    if understood.reading is not Reading.OTHER or not text.strip() or len(text) > _LONGEST:
        return understood
    first = _ask(model, text, question, timeout_s, turned=False)
    if first not in (Reading.YES, Reading.NO):
        return replace(understood, reading=first or Reading.OTHER)
    opens = any(g.kind is GapKind.OBSTACLE for g in question.gaps)
    if first is Reading.YES and opens:
        return understood
    second = _ask(model, text, question, timeout_s, turned=True)
    agrees = {Reading.YES: Reading.NO, Reading.NO: Reading.YES}[first] is second
    return Understood(reading=first, by="model") if agrees else understood


def _ask(model: LanguageModel, text: str, question: Question, timeout_s: float, *, turned: bool) -> Reading | None:
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
    return Reading(found.reading) if found is not None else None
