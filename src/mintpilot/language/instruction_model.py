"""Instructions that the grammar refuses, put into typed steps by a language model that is not trusted.

What it gives is read by the same grammar, checked against the vehicle, and flown only after the operator's yes.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Literal

from pydantic import Field

from mintpilot.core.errors import InputError, MintPilotError
from mintpilot.core.geometry import Vec3
from mintpilot.core.ports import LanguageModel
from mintpilot.core.task import Task
from mintpilot.language import lexicon, verbs
from mintpilot.language.instruction import Capabilities, parse_instruction
from mintpilot.language.lexicon import singular, word_set
from mintpilot.language.phrases import words_of
from mintpilot.models.forms import StrictForm, read_form

INSTRUCTION_S = 20.0
_LONGEST = 300
_PROMPT = """\
Put an instruction for a drone into steps, as JSON. Actions: go (target), pick (target, place = what it is taken \
from), deliver (target = what is carried, place = to whom), look (place = a room, target = what is looked for there), \
count, photograph, report (target), seek (look for everybody who is hurt). keep_out: what to stay away from. Write \
things in English with an article. Leave nothing out and add nothing.
Instruction: Someone should get the hammer out of the green crate for the tall worker, but mind the smoke
{{"steps": [{{"action": "pick", "target": "the hammer", "place": "the green crate"}}, \
{{"action": "deliver", "target": "the hammer", "place": "the tall worker"}}], "keep_out": [{{"what": "the smoke"}}]}}
Instruction: {instruction}
"""
_FILLERS = word_set(
    """there is are was be being he she they we i you it them him her this that who which its his and then so but also
    please could can would should must want wants need needs needed use have has got get take give fetch carry hand
    grab deliver somebody someone in inside on of for with at sits lies stands poor chap fellow us me my our some
    the a an to go find pick up from every all bring look into check whether anyone else hurt out"""
)
"""Words that an English instruction may have without the steps having them, and the other way round."""
_LEFT_TO_RULES = lexicon.REASONS.keys() - _FILLERS
_FOREIGN_LEFT_TO_RULES = word_set(
    """nicht kein keine keinen keinem nie niemals ohne außer wenn falls nur oder wieder bis bevor nachdem sondern ne
    pas sans sauf si seulement ou jusqu jamais aucun avant après encore non sin excepto salvo solo o hasta nunca
    ningún ninguna antes después otra"""
)
"""Negations, exceptions, choices and conditions of other languages: a model that drops one turns the meaning round."""


class TypedStep(StrictForm):
    """One step of an instruction. What each field holds depends on the action; `Steps` says how."""

    action: Literal["go", "pick", "deliver", "look", "count", "photograph", "report", "seek"]
    target: str = Field(default="", max_length=100)
    place: str = Field(default="", max_length=100)


class Distance(StrictForm):
    """What is to be stayed away from."""

    what: str = Field(min_length=1, max_length=100)
    metres: float = Field(default=0.0, ge=0, le=100)


class Steps(StrictForm):
    """An instruction as typed steps. ``target`` is the thing, ``place`` the room, the container or the receiver."""

    steps: list[TypedStep] = Field(min_length=1, max_length=12)
    keep_out: list[Distance] = Field(default=[], max_length=6)


def parse_with_model(
    text: str,
    model: LanguageModel,
    capabilities: Capabilities | None = None,
    *,
    home_m: Vec3 | None = None,
    known: Collection[str] = (),
    timeout_s: float = INSTRUCTION_S,
) -> Task:
    """Reads an instruction: by the grammar, and what it refuses after a model has put it into typed steps.

    Of an English instruction, no word that says something may be left out and none added; numbers must stay in any
    language. Negations, conditions, exceptions and choices are never left to a model. A task that a model had a part in
    is marked by `Task.needs_confirmation`.

    Raises:
        InputError: neither way gives a task; the grammar's own reason.
    """
    try:
        return parse_instruction(text, capabilities, home_m=home_m, known=known)
    except InputError as refusal:
        if not _may_be_asked(text):
            raise
        form = _steps(model, text, timeout_s)
        if form is None or not _is_faithful(form, text, known):
            raise
        try:
            task = parse_instruction(_sentences(form), capabilities, home_m=home_m, known=known)
        except InputError:
            raise refusal from None
        return replace(task, instruction=text, needs_confirmation=True)


def _may_be_asked(text: str) -> bool:
    words = set(words_of(text))
    return bool(words) and not words & (_LEFT_TO_RULES if _is_english(text, ()) else _FOREIGN_LEFT_TO_RULES)


def _is_english(text: str, known: Collection[str]) -> bool:
    """Whether most words are of the English vocabulary."""
    words = [w for w in words_of(text) if w.isalpha()]
    english = lexicon.GRAMMAR | lexicon.NOUNS | lexicon.DETERMINERS | lexicon.REASONS.keys() | _FILLERS | set(known)
    return 2 * sum(w in english or singular(w) in english for w in words) >= len(words)


def _steps(model: LanguageModel, text: str, timeout_s: float) -> Steps | None:
    said = " ".join(text.split())[:_LONGEST]
    try:
        completion = model.complete(_PROMPT.format(instruction=said), schema=Steps, timeout_s=timeout_s)
    except MintPilotError:
        return None
    except Exception:  # a stranger's model may fail in any way: then it has no say
        return None
    return read_form(completion.text, Steps)


def _is_faithful(form: Steps, text: str, known: Collection[str]) -> bool:
    """Whether nothing that can be checked was added or left out."""
    said = words_of(text)
    given = words_of(" ".join([*(f"{s.target} {s.place}" for s in form.steps), *(k.what for k in form.keep_out)]))
    numbers = sorted(float(w) for w in said if w[0].isdecimal() and w.isascii())
    kept = sorted([float(w) for w in given if w[0].isdecimal()] + [k.metres for k in form.keep_out if k.metres])
    if numbers != kept:
        return False
    if not _is_english(text, known):
        return True
    own, steps = {singular(w) for w in said}, {singular(w) for w in given}
    actions = {word for step in form.steps for word in _verbs_of(step)}
    added = {w for w in given if w.isalpha() and w not in _FILLERS and singular(w) not in own}
    left_out = {w for w in said if w.isalpha() and w not in _FILLERS and singular(w) not in steps | actions}
    return not added and not left_out


def _verbs_of(step: TypedStep) -> set[str]:
    spoken = {
        "go": (*verbs.GO, *verbs.FIND, *verbs.VISIT, *verbs.TO), "pick": verbs.PICK,
        "deliver": (*verbs.BRING, *verbs.DROP, *verbs.TO), "look": verbs.LOOK_INTO, "count": ("count", "how many"),
        "photograph": ("photograph", *verbs.PICTURE), "report": ("report", *verbs.SEEN), "seek": verbs.FIND,
    }[step.action]  # fmt: skip
    return {singular(word) for phrase in spoken for word in phrase.split()}


def _sentences(form: Steps) -> str:
    """The typed steps in the words of the grammar."""
    keep = [f"stay {k.metres:g} m away from {k.what}" if k.metres else f"stay out of {k.what}" for k in form.keep_out]
    return ". ".join([*keep, *map(_sentence, form.steps)])


def _sentence(step: TypedStep) -> str:
    target, place = step.target.strip(), step.place.strip()
    return {
        "go": f"go to {target or place}",
        "pick": f"pick up {target} from {place}" if place else f"pick up {target}",
        "deliver": f"bring {target} to {place}",
        "look": f"search {place} for {target}" if target and place else f"look into {place or target}",
        "count": f"count {target} in {place}" if place else f"count {target}",
        "photograph": f"photograph {target or place}",
        "report": f"report what you see at {target or place}" if target or place else "report what you see",
        "seek": "check whether anyone is hurt",
    }[step.action]
