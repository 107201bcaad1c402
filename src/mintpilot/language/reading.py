"""Answers and instructions that the rules do not understand, read with a language model that is not trusted."""

from __future__ import annotations

import re
from dataclasses import replace

from mintpilot.core.errors import InputError, MintPilotError
from mintpilot.core.gap import GapKind
from mintpilot.core.geometry import Vec3
from mintpilot.core.ports import LanguageModel
from mintpilot.core.query import Question
from mintpilot.core.task import Task
from mintpilot.language.answers import Reading, Understood, understand_answer
from mintpilot.language.forms import AnswerReading, Steps, read_form
from mintpilot.language.instruction import Capabilities, parse_instruction
from mintpilot.language.phrases import singular

READING_S = 2.0
INSTRUCTION_S = 20.0
_LONGEST = 300

_ANSWER_PROMPT = """\
A drone asked an operator: "{question}"
Yes would mean: {yes}. No would mean: {no}.
The operator said: "{answer}"
What is the answer to the drone's question? yes, no, unsure, or other if it answers something else.
Answer with JSON only: {{"reading": "yes"}}"""

_STEPS_PROMPT = """\
Rewrite an instruction for a drone as steps. Use only these forms: "go to X", "find X", "pick up X", \
"pick up X from Y", "bring it to X", "look into X", "check whether anyone else is hurt". Use the instruction's own \
words for things. Leave nothing out and add nothing.
Instruction: Someone should get the hammer out of the green crate for the tall worker
{{"steps": ["pick up the hammer from the green crate", "bring it to the tall worker"]}}
Instruction: {instruction}
"""
_STEP_WORDS = frozenset(
    word
    for form in (
        "go to find the a an and",
        "pick up from every all",
        "bring it look into",
        "check whether anyone else is hurt",
    )
    for word in form.split()
)
_CANNOT_BE_CHECKED = re.compile(
    r"\b(?:not|never|no|without|avoid\w*|skip\w*|\w+n't|unless|if|except|out of|away from)\b"
)
"""Negations and conditions that a model might drop: instructions with them are read by the rules only."""


def understand_with_model(
    text: str, question: Question, model: LanguageModel, *, timeout_s: float = READING_S
) -> Understood:
    """Reads a free answer: by rules, and what they take for OTHER by a model.

    The model is asked twice, the second time with Yes and No exchanged, and counts only where both readings agree.
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
    first = _ask(model, text, question.text, question.yes_means, question.no_means, timeout_s)
    if first not in (Reading.YES, Reading.NO):
        return replace(understood, reading=first or Reading.OTHER)
    opens = any(g.kind is GapKind.OBSTACLE for g in question.gaps)
    if first is Reading.YES and opens:
        return understood
    opposite = f"Is it the other way round than this: {question.text}"
    second = _ask(model, text, opposite, question.no_means, question.yes_means, timeout_s)
    agrees = {Reading.YES: Reading.NO, Reading.NO: Reading.YES}[first] is second
    return Understood(reading=first, by="model") if agrees else understood


def parse_with_model(
    text: str,
    model: LanguageModel,
    capabilities: Capabilities | None = None,
    *,
    home_m: Vec3 | None = None,
    timeout_s: float = INSTRUCTION_S,
) -> Task:
    """Reads an instruction: by rules, and what they do not understand after a model has put it into documented steps.

    The steps are read by the same rules, and every word in them must be one of the instruction's own: a model can
    reorder what was said, but not add to it.

    Raises:
        InputError: neither way gives a task; the rules' own reason.
    """
    try:
        return parse_instruction(text, capabilities, home_m=home_m)
    except InputError as refusal:
        if _CANNOT_BE_CHECKED.search(text.lower()):
            raise
        steps = _steps(model, text, timeout_s)
        if not steps or _added(steps, text):
            raise
        try:
            task = parse_instruction("; ".join(steps), capabilities, home_m=home_m)
        except InputError:
            raise refusal from None
        return replace(task, instruction=text)


def _ask(model: LanguageModel, text: str, question: str, yes: str, no: str, timeout_s: float) -> Reading | None:
    said = re.sub(r'["\n\r]+', " ", text)
    prompt = _ANSWER_PROMPT.format(question=question, yes=yes, no=no, answer=said)
    try:
        completion = model.complete(prompt, schema=AnswerReading, timeout_s=timeout_s)
    except MintPilotError:
        return None
    except Exception:  # a stranger's model may fail in any way: then it has no say
        return None
    found = read_form(completion.text, AnswerReading)
    # An order must be one that the rules heard: a model gives none.
    return None if found is None or found.reading is Reading.COMMAND else found.reading


def _steps(model: LanguageModel, text: str, timeout_s: float) -> list[str]:
    said = " ".join(text.split())[:_LONGEST]
    try:
        completion = model.complete(_STEPS_PROMPT.format(instruction=said), schema=Steps, timeout_s=timeout_s)
    except MintPilotError:
        return []
    except Exception:  # a stranger's model may fail in any way: then it has no say
        return []
    found = read_form(completion.text, Steps)
    return found.steps if found is not None else []


def _added(steps: list[str], text: str) -> set[str]:
    """Words of the steps that the instruction does not have."""
    own = {singular(w) for w in re.findall(r"\w+", text.lower())}
    return {w for step in steps for w in re.findall(r"\w+", step.lower()) if singular(w) not in own} - _STEP_WORDS
