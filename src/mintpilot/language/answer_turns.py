"""Turns of speech that change what an answer is worth: corrections, questions back, mild conditions."""

from __future__ import annotations

import re
from dataclasses import dataclass

ECHO = re.compile(r"^(?:\w+ ){1,2}\? (?=\w)")
"""The question's word thrown back, before the answer: ``safe? it is burning``."""
CORRECTION = re.compile(
    r"\b(?:actually|no wait|wait no(?= \w)|(?<!what )i mean(?! it\b)|i meant|sorry|correction|scratch that|strike that"
    r"|cancel that|belay that"
    r"|disregard that|make that|on second thoughts?|changed my mind|wait(?= (?:no|yes)\b)|(?:hang|hold) on"
    r"(?= (?:no|yes)\b)|no sorry|rather(?= the\b))\b"
)
"""What comes after counts."""
NO_SPEECH = re.compile(r"[{}<>=\[\]\\|_@#^~`]|\w\(")
"""Marks of code: nobody says that to a drone."""
PLAIN_NO = re.compile(r"(?:^|[,.;!?] )(?:no|nope|nah|never|do not|hell no|absolutely not|keep out|stay out)\b")
GENTLE = re.compile(
    r"\bbut (?:please )?(?:be |go |fly |do it )?(?:very )?(?:careful|carefully|slow|slowly|gently|gentle|watch out"
    r"|quick|quickly|hurry(?: up)?|take care|mind your step)\b"
)
"""A condition that changes nothing."""
ASKS = re.compile(
    r"(?:^|[,.;] )(?:(?:well|so|and|but|um|uh|sorry|hey|ok|yes|no|right) )*(?:"
    r"(?:is|are|was|were|does|did|can|could|would|will|should|have|has|am|shall)"
    r" (?:not )?(?:it|that|this|there|you|i|we|they|the"
    r"|he|she|any\w+|some\w+|nobody)\b|do (?:you|i|we|they)\b|(?:which|where|whose|why|how|when|what) \w+"
    r"|who (?:is|are|was|did|told|says)\b|safe for|why$|how$|where$|who$|really \?)"
)
NOT_ASKED = re.compile(
    r"\bwhy (?:not|would it not)\b|\b(?:which one|what was that|how should i know|how would i know|how am i)\b"
    r"|\bare you (?:crazy|mad|insane|nuts|kidding|serious|out of your mind)\b|\bhave you lost your mind\b|\bwhat the\b"
)
_STATEMENT = re.compile(
    r"[ ,.;]*(?:(?:now|then|actually|well|not) )*(?:it|that|this|there|these|they|he|she|(?P<own>we|i)|you"
    r"|(?:some|every)(?:body|one)|all of them|the|a|an|one)\b"
)
"""How something new begins that is said of the world: no mere ``but toxic``, ``but only if``."""
_OF_IT = re.compile(r"(?:(?:yes|yeah|no|well|oh|ok|so)[ ,]+)*(?:it|that|this) (?:was|used|had|is)\b")
_WAS = re.compile(r"\b(?:was|were|used to|had been|had)\b")


@dataclass(frozen=True, slots=True)
class Turn:
    """An answer that turns at a ``but``: ``it was jammed, but now it is open``."""

    after: str
    is_past: bool
    """Whether what stands before it tells how it was."""
    of_it: bool
    """Whether that is said of the thing asked about: ``it was …``."""
    is_now: bool
    """Whether what stands after it says how it is now."""


def turn(words: str) -> Turn | None:
    """The last turn of an answer, if there is one."""
    before, but, after = words.rpartition(" but ")
    if not but:
        before, but, after = words.rpartition(" , now ")
    found, is_past = _STATEMENT.match(after), _WAS.search(before) is not None
    if not before.strip(" ,.;") or found is None or (found["own"] and not is_past):
        return None
    return Turn(after, is_past, _OF_IT.match(before) is not None, "now" in (*but.split(), *after.split()))


def corrected(words: str) -> str:
    """What is said after the last correction, if anything is."""
    parts = CORRECTION.split(words)
    return next((part for part in reversed(parts) if part.strip(" ,.;?!")), words)


def asks_back(words: str) -> bool:
    """Whether the answer is, or holds, a question; ``why not`` and ``are you mad`` are none."""
    return "?" in words or ASKS.search(NOT_ASKED.sub("", words)) is not None
