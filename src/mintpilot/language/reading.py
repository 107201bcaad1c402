"""Instructions that the rules do not understand, read with a language model that is not trusted."""

from __future__ import annotations

import re
from dataclasses import replace

from mintpilot.core.errors import InputError, MintPilotError
from mintpilot.core.geometry import Vec3
from mintpilot.core.ports import LanguageModel
from mintpilot.core.task import Task
from mintpilot.language.forms import Steps, read_form
from mintpilot.language.instruction import Capabilities, parse_instruction
from mintpilot.language.phrases import singular

INSTRUCTION_S = 20.0
_LONGEST = 300

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
_FILLERS = frozenset(
    word
    for form in (
        "there is are was be being he she they we i you it them him her this that who which its his and then so but",
        "also please could can would should must want wants need needs needed use have has got get take give fetch",
        "carry hand",
        "grab deliver somebody someone in inside on of for with at sits lies stands poor chap fellow us me my our some",
    )
    for word in form.split()
)
"""Words that an instruction may have without the steps having them."""
_CANNOT_BE_CHECKED = re.compile(
    r"\b(?:not|never|no|without|avoid\w*|skip\w*|\w+n't|unless|if|except|out of|away from)\b"
)
"""Negations and conditions that a model might drop: instructions with them are read by the rules only."""


def parse_with_model(
    text: str,
    model: LanguageModel,
    capabilities: Capabilities | None = None,
    *,
    home_m: Vec3 | None = None,
    timeout_s: float = INSTRUCTION_S,
) -> Task:
    """Reads an instruction: by rules, and what they do not understand after a model has put it into documented steps.

    The steps are read by the same rules. Every word in them must be one of the instruction's own, and every word of
    the instruction that says something must be in them: a model can reorder what was said, not add to it or drop it.

    Raises:
        InputError: neither way gives a task; the rules' own reason.
    """
    try:
        return parse_instruction(text, capabilities, home_m=home_m)
    except InputError as refusal:
        if _CANNOT_BE_CHECKED.search(text.lower()):
            raise
        steps = _steps(model, text, timeout_s)
        if not steps or _added(steps, text) or _left_out(steps, text):
            raise
        try:
            task = parse_instruction("; ".join(steps), capabilities, home_m=home_m)
        except InputError:
            raise refusal from None
        return replace(task, instruction=text)


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


def _left_out(steps: list[str], text: str) -> set[str]:
    """Words of the instruction that say something and that the steps do not have."""
    said = {singular(w) for step in steps for w in re.findall(r"\w+", step.lower())}
    return {w for w in re.findall(r"\w+", text.lower()) if singular(w) not in said} - _STEP_WORDS - _FILLERS
