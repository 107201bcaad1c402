"""Questions in the operator's language, made from the cut itself by template (never by translating sentences).

What the tables do not know (an odd description, a relation) stays as it was in English, between quotation marks.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.gap import PASSABLE, PRESENT, GapKind, KnowledgeGap
from mintpilot.core.ports import LanguageModel
from mintpilot.core.query import Combine, Literal, Query, Question, SayingKind
from mintpilot.core.tree import Mint
from mintpilot.models.doubles import NoModel
from mintpilot.wording.rewording import ModelWording, Wording
from mintpilot.wording.tongue_places import PLACES, split_places
from mintpilot.wording.tongues import ATTRIBUTE, TONGUES, VALUE, Tongue

ENGLISH = "en"
_PLACE = re.compile(r" (near|next to|beside|by|close to|with|at|in|inside|behind|from|on) (?=the )")
_PLACES = {"inside": "in", "in": "in", "behind": "behind", "from": "from", "on": "on"}
"""English words for a place → the key of `Tongue.places`; all others are *near*."""
_VOWEL = re.compile(r"[aeiouhéèêâô]", re.IGNORECASE)


def translated(template: Wording, language: str, names: Mapping[str, str] | None = None) -> Wording:
    """The template, speaking that language.

    Args:
        template: words a cut in English.
        language: ``en``, ``de``, ``fr`` or ``es``.
        names: what the mission itself calls things there, by their English words.

    Raises:
        UnknownNameError: another language.
    """
    if language == ENGLISH:
        return template
    if language not in TONGUES:
        raise UnknownNameError("language", language, (ENGLISH, *TONGUES))
    return TranslatedWording(template=template, tongue=replace(TONGUES[language], names=names or {}))


def wording_for(
    template: Wording,
    *,
    language: str = ENGLISH,
    model: LanguageModel | None = None,
    notice: Callable[[str], None] = lambda _: None,
    names: Mapping[str, str] | None = None,
) -> Wording:
    """How questions are worded: by template in the operator's language, in English improved by a model if there is one.

    Args:
        template: words a cut in English.
        language: ``en``, ``de``, ``fr`` or ``es``; other languages than English always speak by template, since only
            English wordings can be checked.
        model: who may propose better words; None or `NoModel`: nobody.
        notice: told once when the model fails.
        names: see `translated`.

    Raises:
        UnknownNameError: another language.
    """
    if model is None or isinstance(model, NoModel) or language != ENGLISH:
        return translated(template, language, names)
    wording = ModelWording(template=template, model=model, notice=notice)
    wording.warm()
    return wording


@dataclass(frozen=True, slots=True, kw_only=True)
class TranslatedWording:
    """Words a cut in another language; its meaning is the cut's, as ever."""

    template: Wording
    tongue: Tongue

    def __call__(self, query: Query, gaps: Sequence[KnowledgeGap], mint: Mint | None, *, attempt: int = 1) -> Question:
        """The question for a cut; see `Wording`. What no table has words for is asked in English."""
        english = self.template(query, gaps, mint, attempt=attempt)
        text = _ask(query, {gap.id: gap for gap in english.gaps}, self.tongue)
        return replace(
            english,
            text=text or english.text,
            yes_means=consequence(english.yes_means, self.tongue),
            no_means=consequence(english.no_means, self.tongue),
            option_means=tuple(consequence(means, self.tongue) for means in english.option_means),
            worded_by=f"template-{self.tongue.name}" if text else english.worded_by,
        )


def noun_phrase(english: str, tongue: Tongue) -> str:
    """``the grey smoke near the gate`` in that language; where a word is not known, in English and quotation marks."""
    named, places = split_places(english)
    first, *rest = _PLACE.split(named)
    known = tongue.names.get(named)
    said = [known] if known else [_nominal(first, tongue)]
    if not known:
        said += [
            _nominal(part, tongue, _PLACES.get(word, "near")) for word, part in zip(rest[::2], rest[1::2], strict=True)
        ]
    said += [PLACES[tongue.name].get(place, "") for place in places]
    return " ".join(said) if all(said) else tongue.quotes.format(english)


def consequence(english: str, tongue: Tongue) -> str:
    """What an answer would do to the flight, in that language; in English where no table has it."""
    plain, _, extra = english.partition(", ")
    likely = plain.startswith(("I probably ", "I may "))
    plain = re.sub(r"^I (?:probably |may )?", "", plain)
    said = tongue.outcomes.get(plain)
    if said is None and plain.startswith("fly to "):
        said = tongue.outcomes["fly to {}"].format(noun_phrase(plain.removeprefix("fly to "), tongue))
    elif left := re.fullmatch(r"ask further: (\d+) (of them|others) are left", plain):
        said = tongue.outcomes[f"ask further: {{}} {left[2]} are left"].format(left[1])
    elif which := re.fullmatch(r"ask further: (the .+?) or (the .+)", plain):
        said = tongue.outcomes["ask further: {} or {}"].format(
            *(noun_phrase(thing, tongue) for thing in which.groups())
        )
    if said is None:
        return english
    said = tongue.probably.format(said) if likely else said
    if likely_share := re.fullmatch(r"(\d+)% likely", extra):
        return f"{said}, {likely_share[1]} %"
    seconds = re.fullmatch(r"(\d+) s longer", extra)
    return tongue.longer.format(said, seconds[1]) if seconds else said


def _ask(query: Query, gaps: Mapping[str, KnowledgeGap], tongue: Tongue) -> str:
    if query.is_choice:
        return _choose(query, gaps, tongue)
    kinds = [_kind(x, gaps[x.gap]) for x in query.literals]
    subjects = [_subject(x, gaps[x.gap], tongue) for x in query.literals]
    if not all(kinds) or not all(subjects):
        return ""
    if len(kinds) == 1:
        return tongue.asks[kinds[0]].format(subjects[0])
    frame, every, either = tongue.joined
    word = every if query.combine is Combine.ALL else either
    facts = (tongue.states[kind].format(subject) for kind, subject in zip(kinds, subjects, strict=True))
    return frame.format(f" {word} ".join(facts))


def _choose(query: Query, gaps: Mapping[str, KnowledgeGap], tongue: Tongue) -> str:
    """Which of several things is meant, or which of their attributes; other choices have no sentence here."""
    if any(
        len(option.literals) > 1 or gaps[option.literals[0].gap].kind is not GapKind.TARGET for option in query.options
    ):
        return ""
    named = [_subject(option.literals[0], gaps[option.literals[0].gap], tongue) for option in query.options]
    if not all(named):
        return ""
    frame, last, none = tongue.choice
    numbered = [f"{n} {words}" for n, words in enumerate([*named, *([none] if query.none_of_these else [])], 1)]
    return frame.format(f"{', '.join(numbered[:-1])} {last} {numbered[-1]}")


def _kind(literal: Literal, gap: KnowledgeGap) -> str:
    """Which sentence says it; empty where none does."""
    if gap.kind is GapKind.OBSTACLE and gap.threshold is None:
        return PASSABLE if literal.values == {PASSABLE} else ""
    if gap.kind is GapKind.PRESENCE:
        return PRESENT if literal.values == {PRESENT} and not gap.is_thing else ""
    if gap.kind is GapKind.TARGET:
        return {SayingKind.VALUE: VALUE, SayingKind.ATTRIBUTE: ATTRIBUTE}.get(literal.saying.kind, "")
    return ""


def _subject(literal: Literal, gap: KnowledgeGap, tongue: Tongue) -> str:
    if gap.kind is not GapKind.TARGET:
        return noun_phrase(gap.description, tongue)
    if literal.saying.kind is SayingKind.ATTRIBUTE:
        forms = tongue.adjectives.get(literal.saying.value, "").split()
        # An attribute that is no adjective ("eyes: blue") has no short sentence here.
        return forms[0] if forms and literal.saying.name in ("colour", "color", "size", "shape") else ""
    named = next((c.description for c in gap.candidates if c.id == literal.saying.value), "")
    alike = [c for c in gap.candidates if c.description == named]
    return noun_phrase(named, tongue) if named and len(alike) == 1 else ""


def _nominal(english: str, tongue: Tongue, place: str = "") -> str:
    """Article, adjectives and noun; empty where a word is not known. Without an article, the bare noun."""
    words = english.lower().split()
    if not words or words[-1] not in tongue.nouns:
        return ""
    gender, name = tongue.nouns[words[-1]].split(" ", 1)
    if len(words) == 1:
        return name
    *adjectives, _ = words[1:]
    if words[0] != "the" or any(a not in tongue.adjectives for a in adjectives):
        return ""
    article = (tongue.places[place] if place else tongue.articles)[gender]
    forms = {a: _form(a, tongue, gender, is_place=bool(place)) for a in adjectives}
    before = [forms[a] for a in adjectives if a in tongue.before or tongue.ends_by_case]
    after = [forms[a] for a in adjectives if forms[a] not in before]
    return _elided(" ".join([article, *before, name, *after]), tongue)


def _elided(phrase: str, tongue: Tongue) -> str:
    """French articles before a vowel: ``l'homme``, ``près de l'objet``."""
    if tongue.name != "fr":
        return phrase
    phrase = re.sub(rf"\bdu (?={_VOWEL.pattern})", "de l'", phrase, flags=re.IGNORECASE)
    return re.sub(rf"\b(?:le|la) (?={_VOWEL.pattern})", "l'", phrase, flags=re.IGNORECASE)


def _form(adjective: str, tongue: Tongue, gender: str, *, is_place: bool) -> str:
    stem, *feminine = tongue.adjectives[adjective].split()
    if tongue.ends_by_case:
        return stem + ("en" if is_place or gender == "p" else "e")
    word = (feminine[0] if gender in "fp" else stem).replace("_", " ")
    return f"{word}s" if gender == "p" and not word.endswith("s") else word
