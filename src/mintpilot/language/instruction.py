"""Instruction [I] → task, by rules alone (method, section 1).

The documented language is a list of steps in the order in which they are to be done: *go to*, *find*, *pick up … from*,
*bring … to*, *look into*, *check every room*, *wait*, places by name or by coordinates, *check whether anyone is hurt*,
and what is to be avoided. What is unclear or impossible is an error that says what was understood; nothing is guessed.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Vec3
from mintpilot.core.task import Action, Avoidance, Reference, SubGoal, Task
from mintpilot.language import lexicon, patterns
from mintpilot.language.clauses import Reading, read_clause
from mintpilot.language.phrases import parse_phrase
from mintpilot.language.rewriting import rewritten
from mintpilot.language.slips import mended

_LONGEST = 600
_DOING = {Action.GO: "go to", Action.PICK: "pick up at", Action.DELIVER: "deliver to", Action.LOOK: "look into"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Capabilities:
    """What the vehicle can do; the instruction is checked against it."""

    actions: frozenset[Action] = frozenset(Action)
    """Without a gripper: all but `Action.PICK` and `Action.DELIVER`."""


def parse_instruction(text: str, capabilities: Capabilities | None = None, *, home_m: Vec3 | None = None) -> Task:
    """Turns an instruction into ordered sub-goals.

    Args:
        text: the words of the person, in English.
        capabilities: what the vehicle can do; None: everything that `Action` names.
        home_m: where ``come back`` leads, metres; None: such an instruction is refused.

    Raises:
        InputError: the instruction is empty, unclear, contradicts itself or asks for what the vehicle cannot do. The
            message says which part, why, and what was understood of the rest.
    """
    words = _normal(text)
    words, avoid = _avoidances(rewritten(words))
    reading, seeks = Reading(home_m=home_m), False
    for clause in _clauses(words):
        if _seeks_people(clause, reading):
            seeks = True
            continue
        for part in _parts(clause):
            if not _read(part, reading):
                raise InputError(_not_understood(part, reading))
    seeks = seeks or any(_is_anybody(g.reference) for g in reading.subgoals)
    if seeks and not any(g.reference.label == "person" for g in reading.subgoals):
        reading.add(Action.GO, parse_phrase("anyone hurt"))
    if not reading.subgoals:
        raise InputError(
            f"'{text.strip()}' says what to avoid but not what to do: add a step, as in 'go to the red box'"
        )
    _check_capable(reading.subgoals, capabilities or Capabilities())
    return Task(instruction=text, subgoals=tuple(reading.subgoals), seeks_people=seeks, avoid=avoid)


def _normal(text: str) -> str:
    spoken = patterns.FILLER.sub(" ", text.replace("\N{RIGHT SINGLE QUOTATION MARK}", "'").lower())
    words = re.sub(r"[a-z]+", lambda found: mended(found[0], lexicon.MENDED), " ".join(spoken.split()))
    if not re.search(r"[a-z]", words):
        raise InputError(f"instruction '{text[:40]}' has no words: say what to do, as in 'go to the red box'")
    if len(words) > _LONGEST:
        raise InputError(f"an instruction of {len(words)} characters: keep it under {_LONGEST}, one step after another")
    return words.strip(' .!?"')


def _avoidances(words: str) -> tuple[str, tuple[Avoidance, ...]]:
    found: list[Avoidance] = []
    for match in patterns.AVOID.finditer(words):
        what = match["what"].strip()
        kind = next((k for word, k in lexicon.AVOIDED.items() if re.search(rf"\b{word}s?\b", what)), None)
        if kind is None and not set(what.split()) & lexicon.NEVER_TOUCHED:
            raise InputError(f"'{what}' cannot be avoided by name: only smoke, doors and areas marked on the map can")
        if kind is not None:
            found.append(Avoidance(kind=kind, strict=match["soft"] is None and match["wish"] is None))
    return patterns.AVOID.sub(" ", words).strip(" ,.;"), tuple(dict.fromkeys(found))


def _clauses(words: str) -> list[str]:
    parts = (
        patterns.TRAILING.sub("", patterns.POLITE.sub("", part.strip(" ,.!?"))).strip(" ,.!?")
        for part in patterns.SPLIT.split(words)
    )
    return [part for part in parts if part and part not in ("and", "then", "please", "finally", "do", "it", "go")]


def _parts(clause: str) -> list[str]:
    """The clause, or its parts where ``and`` joins what is no step of its own: ``the red box and the blue one``."""
    if re.search(r"\b(with|wearing|containing)\b", clause):
        return [clause]
    return re.split(r",? and |, (?=(?:the|every|all|each) )", clause)


def _seeks_people(clause: str, reading: Reading) -> bool:
    """Whether the clause asks to look for whoever is hurt; a place named in it is looked into."""
    if patterns.SEEK.fullmatch(clause):
        return True
    found = patterns.SEEK_IN.fullmatch(clause)
    if found is None:
        return False
    place = parse_phrase(found["where"])
    if place.label == "room":
        reading.add(Action.LOOK, place)
    elif place.label not in lexicon.VENUES:
        return False
    return True


def _read(clause: str, reading: Reading) -> bool:
    if re.search(r"\b(not|don't|never|no|unless|until|if|while|before|after|when)\b", clause):
        raise InputError(
            f"'{clause}' is not understood: negations and conditions are only understood for smoke, doors and areas to "
            "be avoided. Give the steps in the order in which they are to be done."
        )
    for words, what in lexicon.CANNOT.items():
        if re.match(rf"{words}\b", clause):
            raise InputError(f"'{clause}' cannot be done: {what} is not among what the drone can do ({_can()})")
    return read_clause(clause, reading)


def _is_anybody(reference: Reference) -> bool:
    return reference.every and reference.label == "person"


def _check_capable(subgoals: list[SubGoal], capabilities: Capabilities) -> None:
    for subgoal in subgoals:
        if subgoal.action not in capabilities.actions:
            raise InputError(
                f"'{_DOING[subgoal.action]} {subgoal.reference.phrase}' cannot be done: the vehicle can only "
                f"{', '.join(sorted(_DOING[a] for a in capabilities.actions))}. Change the instruction or the vehicle."
            )


def _not_understood(clause: str, reading: Reading) -> str:
    done = ", then ".join(f"{_DOING[g.action]} {g.reference.phrase}" for g in reading.subgoals) or "nothing yet"
    return f"'{clause}' is not understood. Understood so far: {done}. Say it with one of: {_can()}."


def _can() -> str:
    return "go to, find, pick up, bring … to, look into, check whether anyone is hurt"
