"""Answers that are beside the point: courtesies, how the thing looks or where it is, and what is said of others."""

from __future__ import annotations

import re

from mintpilot.core.gap import GapKind
from mintpilot.language.answer_echo import PREPOSITION
from mintpilot.language.answer_scope import Claim, Said
from mintpilot.language.lexicon import ADJECTIVES

_HEARD = r"(?:ok|al?l ?right|right|fine|good|great|well|so|then|sure|roger|copy|oh|ah|and|now|lovely|that)"
_COURTESY = (
    r"(?:(?:(?:many )?thanks|thank you)(?: a lot| a bunch| a million| very much| so much| again| all)?(?: for \w+)?"
    r"|cheers|ta|noted|(?:very )?(?:cool|nice)(?: (?:talking|chatting) (?:to|with) you)?|talk to you (?:later|soon)"
    r"|(?:good)?bye(?: bye| now)?|good ?night|see you(?: later| soon)?|i see|i hear you|i understand|understood|got it"
    r"|(?:i|we) (?:have )?(?:looked|will look|will see)"
    r"|have a (?:good|nice) \w+|mate|drone|sir)"
)
ACKNOWLEDGED = re.compile(rf"(?:{_HEARD}[ ,.;!]*)*{_COURTESY}[ ,.;!]*(?:(?:{_HEARD}|{_COURTESY})[ ,.;!]*)*")
"""All that is said where somebody only tells that they heard: ``okay thanks``."""
CUT_OFF = re.compile(
    r"\b(?:(?:it|that|there|he|she|they|we|i|you)['\N{RIGHT SINGLE QUOTATION MARK}](?:s|re|m)"
    r"|its|thats|theres|hes|shes|theyre|youre|im)\W*$",
    re.I,
)
"""An answer that breaks off before what matters: ``yes, it's``."""
_LOOKS = "|".join(word for word, (name, _) in ADJECTIVES.items() if name == "colour")
_DESCRIBED = re.compile(
    r"^(?:yes|yeah|ok) (?:, )?on$|(?<!is )\b(?:around|round|out|away)(?: it)?$|"
    rf"\b\w+ is (?:\w+ly |very |quite |all |still |just )?(?:{_LOOKS})\b"
    rf"|\b(?:is|are) (?:right |just |still )?(?:over|up|down|out) there\b"
    r"|\b(?:it|that|this|smoke|cloud|door|room|area) is (?:there(?= *$| *[,.;!])|made of|(?:(?:a|an|the) )?"
    rf"(?:smoke|cloud|area|room|door|doorway|gate)(?= *$| *[,.;!])|{PREPOSITION} (?!control|order|good|it)\w)"
    r"|\b(?:we|i|they|you) (?:also )?(?:have|got|own|brought|wear)(?: got)? (?!(?:no|not|to|it|that|you|just|been|seen"
    r"|done|gone|had|made|known|permission|clearance|already|never|the|a|an|my|your|his|our|this|all)\b)(?!\w+ed\b)\w+"
)
"""How the thing looks, where it is, or what somebody has, and what is left of a mistyped ``no``, ``stay out``."""
_PLACES = (
    "room|corridor|hallway|window|office|kitchen|workshop|hall|cellar|basement|garage|roof|garden|yard|street|canteen"
    "|toilet|shed"
)
_DOORS = "door|doorway|gate"
_NAMED = re.compile(rf"\b(?:the|that|this|other) (?P<noun>{_PLACES}|{_DOORS}) (?:there )?(?:is|are|looks|seems|was)\b")
_INSIDE_OF = re.compile(rf"\bin the (?P<noun>{_PLACES})\b")
_COLOURED = re.compile(rf"\b(?:the|that|this) (?P<noun>{_LOOKS}) \w")
_AT = re.compile(
    r"\b(?:next to|beside|behind|around|near|above|below|under|outside|opposite|in front of) (?:it|the smoke)\b"
    r"|\b(?:it|that|this|smoke|door) will be (?:safe|clear|open|passable)\b"
    rf"|\b(?:one|smoke|cloud|room|area|{_DOORS}) (?:that is |over )?(?!in the way)"
    rf"{PREPOSITION} (?:the|that|my|our|your|it)\b"
)
"""Another one than the one asked about, or another time: ``the one by the gate``; its own name was taken out before."""
_OTHER_ROOM = re.compile(r"\b(?:in|inside) the (?:other|next|second)\b")
_OTHERS_FAIL = re.compile(
    r"\b(?:the|my|our) (?!(?:drone|smoke|way|path|door|route|thing)\b)(?P<noun>\w+)"
    r" (?:can|could|will|would|did|does) not (?:get|go|come|fit|pass|drive|walk)\b"
)
_SHUT = re.compile(r"\b(?:window|windows|lid|drawer|shutter|shutters|eyes|mouth|shop|curtain|curtains)\b")
_WORLD = frozenset((Claim.PASSABLE, Claim.BLOCKED, Claim.PRESENT, Claim.ABSENT))


def beside_yes(words: str, said: Said, about: GapKind, asked: str) -> bool:
    """Whether something in the answer tells that its Yes may be about something else.

    Args:
        words: the answer, as it was read.
        said: its claims; a description beside a clear statement takes nothing from that.
        about: what kind of thing was asked; of things to choose, looks and places are what is asked.
        asked: the words of the question.
    """
    if about not in (GapKind.OBSTACLE, GapKind.PRESENCE):
        return False
    if _DESCRIBED.search(words) and not said.claims & _WORLD:
        return True
    own = _known(asked)
    named = [found["noun"] for pattern in (_NAMED, _COLOURED, _INSIDE_OF) for found in pattern.finditer(words)]
    return _AT.search(words) is not None or not own.issuperset(named)


def beside_no(words: str, said: Said, about: GapKind, asked: str) -> bool:
    """Whether a No that is only concluded is about something else: ``I shut the window``; arguments as above."""
    if about is GapKind.PRESENCE:
        return _OTHER_ROOM.search(words) is not None
    if about is not GapKind.OBSTACLE or Claim.NO in said.claims:
        return False
    own = _known(asked)
    found = (*_OTHERS_FAIL.finditer(words), *_SHUT.finditer(words))
    return any((match.groupdict().get("noun") or match[0]) not in own for match in found)


def _known(asked: str) -> frozenset[str]:
    """The words of the question; all words for a door are one."""
    words = frozenset(re.findall(r"\w+", asked.lower()))
    doors = frozenset(_DOORS.split("|"))
    return words | doors if words & doors else words
