"""Turns of speech that change what an answer is worth: corrections, questions back, mild conditions."""

from __future__ import annotations

import re
from dataclasses import dataclass

from mintpilot.core.gap import GapKind

_ECHO = re.compile(r"^(?:\w+ ){1,2}\? (?=\w)")
"""The question's word thrown back, before the answer: ``safe? it is burning``."""
_OPPOSITE = re.compile(
    r"^(?:(?:yes|yeah|yep|yup|ok|right|sure|well|al?l ?right|true|exactly|of course|correct)[ ,.;!]+)+"
    r"(?:(?:i|we) (?:have )?(?:just )?(?:checked|looked|know)(?: it)?[ ,.;!]+)?"
    r"(?=(?:it|that|this|the \w+|that one|this one) (?:is|was|has)\b"
    r"|there is (?:\w+ly )?(?:nobody|no one|noone|not any|no people)(?!.*\b(?:else|but|except|missing)\b)"
    r"|(?:nobody|no one|noone)\b(?!.*\b(?:else|but|except|missing)\b)"
    r"|not (?:safe|that|this|it)\b)"
)
"""A yes-word before a statement of its own, which outweighs it where it is the opposite: ``yes, it is toxic``."""
_ACKNOWLEDGING = re.compile(
    r"^(?:(?:roger(?: that)?|copy(?: that)?|ok|right|al?l ?right|understood|got it|well|listen|look|so)[ ,.;!]+)+"
    r"(?:(?:but|so|listen|look|well)[ ,]+)*(?=(?:it|that|this|there|they|we|the|is|negative|nope|no|not|nobody|find"
    r"|take|go|stay|keep|avoid|do not)\b)"
)
"""What only tells that the question was heard, before a No: ``roger, but negative``."""
_TELLS_EMPTY = re.compile(r"negative\b|(?:there is )?(?:nobody|no one)\b|(?:it|that|the \w+) is (?:\w+ )?empty\b")
_LEADING_NO = re.compile(
    r"^(?:(?:no|nope|nah|negative)(?: (?:no|sorry|please|thanks|thank you|sir|dear|love|mate))* [,.;!] )+(?=\w)"
)
"""A plain No with a break after it; what follows may say the same again."""
_CONFIRMS = re.compile(r"\b(?:confirm|confirmed|say yes|affirm)\b")
_GIVING = frozenset(
    word
    for words in (
        "i we can would hereby gladly happily yes yeah ok right roger copy also definitely absolutely",
        "certainly sure and then so it",
    )
    for word in words.split()
)
"""All that may stand before ``confirm`` where it is one: ``I can confirm``, not ``the lab must confirm``."""
_NOT_YET = frozenset(["be", "being", "half", "partly", "partially", "almost", "nearly", "yet", "once", "to"])
CORRECTION = re.compile(
    r"\b(?:actually|no wait|wait no(?= \w)|(?<!what )i mean(?! it\b)|(?<!what )i meant|(?<!^no )sorry|correction"
    r"|scratch that|strike that"
    r"|cancel that|belay that"
    r"|disregard that|make that|on second thoughts?|changed my mind|wait(?= (?:no|yes)\b)|(?:hang|hold) on"
    r"(?= (?:no|yes)\b)|(?<!^)no sorry|rather(?= the\b))\b"
)
"""What comes after counts."""
TAKEN_BACK = re.compile(r"\b(?:no wait|(?:scratch|strike|cancel|belay|disregard) that)$|(?<=.)\bno sorry$")
"""A correction that nothing follows: what was said does not count."""
NO_SPEECH = re.compile(r"[{}<>=\[\]\\|_@#^~`]|\w\(")
"""Marks of code: nobody says that to a drone."""
EITHER_WAY = re.compile(r"\bonly (?:if|when)\b.*\b(?:otherwise|else|if not)\b")
"""Both answers, by a condition: ``only if you stay high, otherwise no``."""
PLAIN_NO = re.compile(r"(?:^|[,.;!?] )(?:no|nope|nah|never|do not|hell no|absolutely not|keep out|stay out)\b")
GENTLE = re.compile(
    r"\bbut (?:please )?(?:be |go |fly |do it )?(?:very )?(?:careful|carefully|slow|slowly|gently|gentle|watch out"
    r"|quick|quickly|hurry(?: up)?|take care|mind your step)\b"
    r"|^(?:(?:yes|yeah|it|that|there) )?should be no (?:problem|trouble|issue)(?: at all)?[ ,.;]+"
    r"(?=(?:go|fly|head|come|proceed)\b)"
)
"""Conditions and doubts that change nothing."""
ASKS = re.compile(
    r"(?:^|[,.;] )(?:(?:well|so|and|but|um|uh|sorry|hey|ok|yes|no|right) )*(?:"
    r"(?:is|are|was|were|does|did|can|could|would|will|should|have|has|am|shall)"
    r" (?:not )?(?:it|that|this|there|you|i|we|they|the"
    r"|he|she|any\w+|some\w+|nobody)\b|do (?:you|i|we|they)\b|(?:which|where|whose|why|how|when|what) \w+"
    r"|who (?:is|are|was|did|told|says)\b|safe for|why$|how$|where$|who$|really \?)"
)
NOT_ASKED = re.compile(
    r"\bwhy (?:not|would it not)\b|\b(?:which one|what was that|how should i know|how would i know|how am i)\b"
    r"|(?:^|[,.;] )is not (?:it|that|this|these|those)(?: one)?(?= *$| *[,.;!])"
    r"|^is (?:not )?the [^,]*(?=, (?:yes|yeah|no)$)"
    r"|^(?:yes|yeah|ok|no|nope)(?: (?:yes|no))?[ ,.;!]+is (?:(?:it|that|this|these|those)(?: one)?(?= *$| *[,.;!])"
    r"|(?:some|no)(?:body|one)\b|not any(?:body|one)\b)"
    r"|\bare you (?:crazy|mad|insane|nuts|kidding|serious|out of your mind)\b|\bhave you lost your mind\b|\bwhat the\b"
)
_STATEMENT = re.compile(
    r"[ ,.;]*(?:(?:now|then|actually|well|not) )*(?:it|that|this|there|these|they|he|she|(?P<own>we|i)|you"
    r"|(?:some|every)(?:body|one)|all of them|the|a|an|one)\b"
)
"""How something new begins that is said of the world: no mere ``but toxic``, ``but only if``."""
_OF_IT = re.compile(r"(?:(?:yes|yeah|no|well|oh|ok|so)[ ,]+)*(?:it|that|this) (?:was|used|had|is)\b")
_LOOKS = re.compile(
    r"(?:(?:yes|no|well|oh|ok|so)[ ,]+)*(?:it|that|this|the \w+) (?:may |might )?"
    r"(?:looks?|seems?|smells?|sounds?|appears?)(?: \w+){1,2}"
)
_GO_ON = re.compile(r"\b(?:go|fly|head|pass|come)(?: on| right| straight)? (?:through|ahead|in|on)\b|\bproceed\b")
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
    only_looks: bool = False
    """Whether what stands before it only tells how it looks: ``it looks bad``."""
    goes_on: bool = False
    """Whether what stands after it tells the vehicle to go: ``… go through``."""


def turn(words: str) -> Turn | None:
    """The last turn of an answer, if there is one."""
    before, but, after = words.rpartition(" but ")
    if not but:
        before, but, after = words.rpartition(" , now ")
    found, is_past = _STATEMENT.match(after), _WAS.search(before) is not None
    if not before.strip(" ,.;") or found is None or (found["own"] and not is_past):
        return None
    return Turn(
        after,
        is_past,
        of_it=_OF_IT.match(before) is not None,
        is_now="now" in (*but.split(), *after.split()),
        only_looks=_LOOKS.fullmatch(before.strip(" ,")) is not None,
        goes_on=_GO_ON.search(after) is not None,
    )


def settled(words: str) -> str:
    """The answer with every confirmation that is still to be given, or is another's, as ``unconfirmed``."""
    return _CONFIRMS.sub(lambda found: found[0] if _is_given(found, words) else "unconfirmed", words)


def _is_given(found: re.Match[str], words: str) -> bool:
    before = re.split(r"[,.;!?]", words[: found.start()])[-1].split()
    if found[0] == "confirmed":
        return not before or before[-1] not in _NOT_YET
    return _GIVING.issuperset(before)


def lead(words: str, about: GapKind) -> re.Match[str] | None:
    """The words before an answer's own statement that a No after them outweighs.

    Of a room, an acknowledgement is outweighed only by words that tell it to be empty: not by ``ok, not yet``.
    """
    if found := _ECHO.match(words) or _OPPOSITE.match(words) or _LEADING_NO.match(words):
        return found
    found = _ACKNOWLEDGING.match(words)
    is_told = about is not GapKind.PRESENCE or (found and _TELLS_EMPTY.match(words, found.end()))
    return found if is_told else None


def corrected(words: str) -> str:
    """What is said after the last correction, if anything is."""
    parts = CORRECTION.split(words)
    return next((part for part in reversed(parts) if part.strip(" ,.;?!")), words)


def asks_back(words: str) -> bool:
    """Whether the answer is, or holds, a question; ``why not`` and ``are you mad`` are none."""
    return "?" in words or ASKS.search(NOT_ASKED.sub("", words)) is not None
