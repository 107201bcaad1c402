"""Which candidates of a target gap an answer names: ``not the red one, the blue one``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from mintpilot.core.gap import Candidate, GapKind, KnowledgeGap
from mintpilot.core.query import Literal, Question, Saying, SayingKind
from mintpilot.language.lexicon import ADJECTIVES

_ALIKE = {
    **dict.fromkeys(("big", "bigger", "biggest", "larger", "largest", "huge"), "large"),
    **dict.fromkeys(("little", "smaller", "smallest", "tiny"), "small"),
    "gray": "grey",
}
_OPPOSITES = tuple(
    (frozenset(a.split()), frozenset(b.split()))
    for a, b in (
        ("left", "right"),
        ("larger bigger largest biggest large big taller", "smaller smallest small little tiny shorter"),
        ("nearest closest nearer closer near close", "farthest furthest farther further far"),
        ("higher above upper top", "lower below under bottom"),
        ("front", "behind back rear"),
    )
)
_STOP = frozenset(("the", "a", "an", "of", "with", "and", "to", "near", "one", "it", "is", "on", "in", "at", "by"))
_SUCH, _NO_SUCH = "such", "nosuch"
"""Stand in the rest of an answer for the words that named candidates, and for those that ruled them out."""
_NOT = re.compile(
    r"\b(?:not|never|nor|neither|except|without|none of|any\w* but|all but|other than|instead of|used to be)\b"
    r"(?: (?:the|a|an|that|this|any|of|those|these|one(?= of)))*$"
)
_SHADES = frozenset(("light", "dark", "bright", "pale", "deep"))
_OF_ANOTHER = re.compile(
    r"\b(?:(?:next to|behind|beside|near|by|under|on|from|inside|with|wearing|has|feeling|out of|opposite"
    r"|left of|right of|in(?= \w)|(?<!one )(?<!box )in)"
    r"(?: (?:the|a|an|my|its))?|all(?: \w+){0,2}|\w+ish"
    r"|(?!(?:it|that|this|ones?|they|those|these|which|there|mine|thing|colou?r|want|mean|meant|need|said|such|not|yes"
    r"|yeah)\b)\w+ (?:is|are|was|were)(?: all)?)$"
)
"""What before a colour makes it one of something else: ``next to the red …``, ``my jacket is …``."""
_TOLD = re.compile(
    r"with (?:envy|jealousy|rage|anger|shame|age)\b"
    r"|\w+ (?:is|was|has|are|were) (?!(?:it|the|right|correct|mine|what|that|fine|good|ok)\b)\w"
)
"""What follows where a thing is only described: ``the red one is empty``."""
_THINGS = tuple(
    frozenset(group.split())
    for group in ("box crate case container chest parcel", "barrel drum", "bag suitcase", "bottle can", "kit")
)
"""Nouns of things; those of two groups are never the same thing."""
_OTHER_DENIED = re.compile(r"\bnot (?:the|a|that) (\w+)(?= *$| *[,.;!])")
"""``not the bag``: of boxes it says nothing."""
_FOLLOWERS = frozenset(
    word
    for words in (
        "one ones thing box crate barrel bag bottle kit case parcel drum can container chest suitcase please yes yeah",
        "no not nor and or but with by near next on in at that which who as mate now then i we you it is are was over",
        "under behind beside to from for sir thanks there here if though of course sure obviously definitely have has",
        "both too also together either last colour color such nosuch",
    )
    for word in words.split()
)
"""What may follow the words for a thing that is asked about; after another noun they describe that."""
_SIMILE = re.compile(rf"\b{_SUCH} as (?:a|an|the) \w+(?: \w+)?(?= *$| *[,.;!])")
"""``red as a fire engine``."""
_COLOURS = frozenset(word for word, (name, _) in ADJECTIVES.items() if name == "colour")
_BESIDE = re.compile(
    r"\b(?:the|that) \w+ (?:right |just )?(?:behind|beside|next to|under|above|below|in front of|opposite"
    r"|(?:to the )?left of|(?:to the )?right of|across from) (?:it|that one|this one|that|this)(?= *$| *[,.;!])"
)
"""Another thing than the one asked about, told by where it is: ``the one behind it``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mention:
    """What an answer says about the candidates."""

    gap: KnowledgeGap | None
    values: frozenset[str]
    """Candidates that it leaves; empty where it says nothing of them, or rules out all."""
    rest: str
    """The answer without those words."""
    confused: bool = False
    """True when it names candidates in a way that leaves none."""
    another: bool = False
    """True when it names only such as are none of the candidates: ``the black one``, ``the one behind it``."""

    def literal(self) -> Literal | None:
        """The same as a cut that is answered Yes."""
        if self.gap is None or not self.values or len(self.values) == len(self.gap.values):
            return None
        return Literal(gap=self.gap.id, values=self.values, saying=Saying(kind=SayingKind.VALUE))


def mention(words: str, gaps: Sequence[KnowledgeGap]) -> Mention:
    """Finds attribute values of the candidates in an answer; a word that fits all or none of them says nothing.

    Args:
        words: the answer in lower case, punctuation apart.
        gaps: the question's gaps; only where exactly one of them is a target gap can candidates be named.
    """
    targets = [g for g in gaps if g.kind is GapKind.TARGET]
    if len(targets) != 1:
        return Mention(gap=None, values=frozenset(), rest=words)
    (gap,) = targets
    words = _OTHER_DENIED.sub(lambda found: "" if _is_other_thing(found[1], gap) else found[0], words)
    named, ruled_out, rest = set(gap.values), set[str](), list[str]()
    runs_named, elsewhere = list[set[str]](), list[set[str]]()
    for run in _runs(words, gap):
        if isinstance(run, tuple):
            elsewhere.append(run[0])
            rest.extend(run[1])
        elif isinstance(run, str):
            rest.append(run)
        elif (denied := _NOT.search(before := " ".join(rest))) is not None:
            ruled_out |= run
            rest = [*before[: denied.start()].split(), _NO_SUCH]
        else:
            rest.append(_SUCH)
            named &= run
            runs_named.append(run)
    words_left = _SIMILE.sub(_SUCH, " ".join(rest))
    values = named - ruled_out if runs_named or ruled_out else set()
    another = bool(runs_named) and not any(runs_named)
    confused = not values and not another and bool(runs_named or ruled_out)
    confused |= any(not values <= fits for fits in elsewhere)
    if _BESIDE.search(words) is not None:
        values, confused, another = set(), False, True
    return Mention(gap=gap, values=frozenset(values), rest=words_left, confused=confused, another=another)


def said_relation(words: str, question: Question) -> bool | None:
    """Whether an answer says that the relation asked about holds (``the left one``).

    None where it does not speak of that relation, or says both.
    """
    if len(question.query.literals) != 1:
        return None
    saying = question.query.literals[0].saying
    if saying.kind is not SayingKind.RELATION:
        return None
    asked = set(re.findall(r"\w+", saying.name))
    for same, opposite in (*_OPPOSITES, *((b, a) for a, b in _OPPOSITES)):
        if asked & same:
            said = {*_says(words, same), *(not truth for truth in _says(words, opposite))}
            return said.pop() if len(said) == 1 else None
    return None


def _says(words: str, names: frozenset[str]) -> set[bool]:
    """For each time that one of the names is said: whether it is not denied. ``right`` counts only as a side."""
    others = names - {"right"}
    pattern = rf"\b(?:{'|'.join(sorted(others))})\b" if others else r"\b(?:the|on|to|my|your) right\b"
    return {_NOT.search(words[: found.start()].rstrip()) is None for found in re.finditer(pattern, words)}


def _runs(words: str, gap: KnowledgeGap) -> Iterator[str | set[str] | tuple[set[str], list[str]]]:
    """Words that say nothing of the candidates, and for each run of others (``small red``) those that fit all of it.

    A run that may be about something else (``the red door is open``) comes as a tuple of both.
    """
    tokens, at = re.findall(r"[\w']+|[,.;!?]", words), 0
    nouns = {form for c in gap.candidates for w in _words_of(c) for form in (w, f"{w}s", f"{w}es")}
    while at < len(tokens):
        end, fits = at, set(gap.values)
        while end < len(tokens) and (named := _named(tokens, end, gap)) is not None:
            end, fits = end + 1, fits & named
        following = tokens[end] if end < len(tokens) else ","
        is_named = following in _FOLLOWERS | nouns or not following.isalpha()
        is_named &= _TOLD.match(" ".join(tokens[end:])) is None
        if _is_other_thing(following, gap):
            fits = set()
        if end > at and is_named and _OF_ANOTHER.search(" ".join(tokens[:at])) is None:
            yield fits
        else:
            if end > at:
                yield fits, tokens[at:end]
            else:
                yield tokens[at]
            end = max(end, at + 1)
        at = end


def _is_other_thing(noun: str, gap: KnowledgeGap) -> bool:
    """Whether a noun is one for things of another sort than all candidates: a box among barrels."""
    sorts = {group for group in _THINGS for c in gap.candidates if group & _words_of(c)}
    named = [group for group in _THINGS if group & {noun, noun.removesuffix("s"), noun.removesuffix("es")}]
    return bool(sorts and named) and named[0] not in sorts


def _named(tokens: Sequence[str], at: int, gap: KnowledgeGap) -> set[str] | None:
    """The candidates that a word fits; None where it says nothing of them. ``light`` and ``dark`` go with a colour."""
    token = tokens[at]
    if token in _SHADES and at + 1 < len(tokens) and tokens[at + 1] in _COLOURS:
        return set(gap.values)
    fits = {c.id for c in gap.candidates if _ALIKE.get(token, token) in _words_of(c)}
    is_telling = len(fits) < len(gap.candidates) and (bool(fits) or token in _COLOURS)
    return fits if is_telling else None


def _words_of(candidate: Candidate) -> frozenset[str]:
    """Words that the candidate's attributes and its description are made of."""
    values = (*(a.value for a in candidate.attributes), candidate.description)
    said = " ".join(values).lower().replace("_", " ")
    return frozenset(_ALIKE.get(w, w) for w in re.findall(r"\w+", said)) - _STOP
