"""Phrases for gaps and their values: small pieces of plain English."""

from __future__ import annotations

from mintpilot.core.gap import Candidate, KnowledgeGap
from mintpilot.elicitation.referents import FARTHEST, LARGER, LEFT, NEAREST, RIGHT, name_of

_ARTICLES = ("the", "a", "an")
_LINKS = ("with", "near", "in", "on", "at", "by", "behind", "beside", "next", "under", "between", "to", "of", "from")
_POSSESSIONS = ("accessories", "equipment")
_ADJECTIVES = ("age", "age_range", "color", "colour", "gender", "material", "shape", "size")


def plain(text: str) -> str:
    """An identifier as words: ``hair_color`` → ``hair color``."""
    return text.replace("_", " ").strip()


def subject_of(gap: KnowledgeGap) -> str:
    """The gap's subject with its article, as the operator can see it."""
    text = gap.description.strip() or plain(gap.subject.replace("-", " "))
    return text if text.split(" ")[0].lower() in _ARTICLES else f"the {text}"


def shortened(text: str) -> str:
    """A description up to its first linking word: ``the grey smoke near the gate`` → ``the grey smoke``."""
    words = text.split(" ")
    end = next((i for i, word in enumerate(words) if i > 1 and word.lower() in _LINKS), len(words))
    return " ".join(words[:end]).rstrip(",")


def thing_called(gap: KnowledgeGap, value: str) -> str:
    """A candidate in plain words, with its article or by its name; with its id where two are called alike."""
    candidate = _candidate(gap, value)
    if candidate is None:
        return plain(value.replace("-", " "))
    name = name_of(candidate)
    alike = [c for c in gap.candidates if name_of(c) == name]
    return name if len(alike) == 1 else f"{name} ({candidate.id})"


def noun_of(gap: KnowledgeGap) -> str:
    """What all candidates are called: ``box`` for 'the red box' and 'the blue box by the rack'; else ``one``."""
    heads = set()
    for candidate in gap.candidates:
        words = shortened(name_of(candidate)).split(" ")
        heads.add(words[-1].lower() if len(words) > 1 and words[0].lower() in _ARTICLES else "one")
    return heads.pop() if len(heads) == 1 else "one"


def plural(noun: str) -> str:
    """The plural of a noun."""
    if noun == "person":
        return "people"
    if noun.endswith(("s", "x", "z", "ch", "sh")):
        return noun + "es"
    if noun.endswith("y") and noun[-2:-1] not in "aeiou":
        return noun[:-1] + "ies"
    return noun + "s"


def joined(parts: list[str], word: str) -> str:
    """``a``, ``a or b``, ``a, b or c``."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} {word} {parts[-1]}"


def is_adjective(attribute: str) -> bool:
    """Whether a value of that attribute can stand alone: 'it is red', but not 'it is blue' of eyes."""
    return attribute in _ADJECTIVES


def is_possession(attribute: str) -> bool:
    """Whether a value of that attribute is a thing that one has: 'it has glasses'."""
    return attribute in _POSSESSIONS


def inset(text: str) -> str:
    """A description inside a sentence: with a comma at its end where it has one in the middle."""
    return f"{text}," if "," in text else text


def relation_phrase(name: str, value: str, gap: KnowledgeGap) -> str:
    """A relation in words: ``larger than the red box``, ``the box nearest to the drone``."""
    if name == LARGER:
        return f"larger than {thing_called(gap, value)}"
    if name in (LEFT, RIGHT):
        return f"to the {'left' if name == LEFT else 'right'} of {thing_called(gap, value)}, seen from the drone"
    if name == NEAREST:
        return f"the {noun_of(gap)} nearest to the drone"
    if name == FARTHEST:
        return f"the {noun_of(gap)} farthest from the drone"
    return f"{name} {thing_called(gap, value)}"


def _candidate(gap: KnowledgeGap, value: str) -> Candidate | None:
    return next((c for c in gap.candidates if c.id == value), None)
