"""What is to be stayed out of or away from: clauses → avoidances and distances."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.task import KEEP_AWAY_M, Avoidance, KeepAway, Reference
from mintpilot.language import lexicon, verbs
from mintpilot.language.clauses import ROOM, Reading
from mintpilot.language.phrases import Unread, Words, noun_phrase, refuse


def keeps_out(reading: Reading) -> bool:
    """Takes one clause that says what is to be stayed out of; False where there is none."""
    return reading.attempt(_keep_out)


def _keep_out(reading: Reading) -> None:
    words = reading.words
    wish = bool(words.take(*verbs.WISH))
    words.take(",")
    distance_m: float | None = None
    if words.take("avoid", "avoiding", "bypass", "skip", "skipping"):
        pass
    elif words.take("without"):
        words.need(*verbs.ENTERING)
    elif words.take("do not", "don't", "never"):
        words.need(*verbs.ENTER)
    elif words.take("stay", "staying", "keep", "keeping", "steer", "steering", "remain"):
        distance_m = _distance(words)
        words.need("out of", "away from", "clear of", "outside of", "outside", "from", "off")
        if words.tokens[words.at - 1] == "from" and distance_m is None and words.tokens[words.at - 2] != "away":
            words.fail()
    else:
        _off_limits(reading)
        return
    for reference in _kept_out(reading):
        _note(reading, reference, distance_m, strict=not wish)
    if words.take(*verbs.WISH, *(f", {wish}" for wish in verbs.WISH)):
        reading.avoid = [replace(a, strict=False) for a in reading.avoid]


def _off_limits(reading: Reading) -> None:
    reference = noun_phrase(reading.words)
    reading.words.need("is off limits", "are off limits", "is forbidden", "are forbidden", "must be avoided")
    _note(reading, reference, None, strict=True)


def _distance(words: Words) -> float | None:
    words.take("at least", "a distance of", "at least a distance of", "a distance of at least")
    distance_m = words.number()
    if distance_m is None:
        number = words.take("one", "two", "three", "four", "five", "ten", "a", "half a")
        distance_m = verbs.NUMBERS[number] if number else None
    if distance_m is not None:
        words.need(*verbs.METRES)
        words.take("or more")
    return distance_m


def _kept_out(reading: Reading) -> list[Reference]:
    found = []
    while True:
        reading.words.take("any", "any of")
        found.append(noun_phrase(reading.words))
        at = reading.words.at
        if not reading.words.take(", and", ", or", "and", "or", ","):
            return found
        ahead = reading.words.at
        try:
            reading.words.take("any", "any of")
            noun_phrase(reading.words)
        except Unread:
            reading.words.at = at
            return found
        reading.words.at = ahead


def _note(reading: Reading, reference: Reference, distance_m: float | None, *, strict: bool) -> None:
    if reference.position_m is not None or reference.label == ROOM:
        refuse(reference.phrase, "cannot be stayed out of by name: smoke, doors, marked areas and things can")
    kind = lexicon.AVOIDED.get(reference.label)
    if kind is None:
        keep = KeepAway(
            reference=replace(reference, every=True), distance_m=KEEP_AWAY_M if distance_m is None else distance_m
        )
        reading.keep_away.append(keep)
        return
    if any(a.value not in ("marked", "restricted") for a in reference.attributes):
        refuse(reference.phrase, f": only all {kind} can be stayed out of; say 'avoid the {kind}'")
    reading.avoid.append(Avoidance(kind=kind, strict=strict))
    if distance_m is not None:
        reading.keep_away.append(
            KeepAway(reference=Reference(phrase=str(kind), label=str(kind)), distance_m=distance_m)
        )
