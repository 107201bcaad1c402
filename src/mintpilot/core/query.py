"""Queries: partitions without words. Questions: their words. Answers: what came back."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations
from types import MappingProxyType

import numpy as np

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import GapKind, Joint, KnowledgeGap, kind_of
from mintpilot.core.geometry import SmallInts
from mintpilot.core.predicate import (
    Combine,
    Domain,
    Literal,
    Option,
    Saying,
    SayingKind,
    contents,
    exclusive,
    holds,
    truths,
)

YES_PART, NO_PART = 0, 1
"""The two parts of a yes/no query."""
NONE_OF_THESE = "none of these"
"""What the part of a choice is called that no option covers."""
MAX_PARTS = 4
"""A query divides the joint hypotheses into no more parts than this."""
CHOICE_EFFORT = 1.6
"""How many times as long as a yes or no the answer to a choice takes (method, section 13)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Query:
    """A symbolic partition of the joint hypotheses into two to four parts [q]. It has no words.

    A yes/no query has ``literals``: its parts are `YES_PART` and `NO_PART`. A choice has ``options``, of which no two
    hold at once: part i is that of option i, and what no option covers is a last part, if ``none_of_these``.

    Raises:
        MissionError: neither or both forms are given, options overlap, or there are too few or too many parts.
    """

    literals: tuple[Literal, ...] = ()
    """Of a yes/no query: one, or two and more joined by ``combine``."""
    combine: Combine = Combine.ALL
    options: tuple[Option, ...] = ()
    """Of a choice: one to four, in the order in which they are offered."""
    none_of_these: bool = False
    """Of a choice: whether a last part holds what no option covers; `choice` finds out whether there is any."""

    def __post_init__(self) -> None:
        if bool(self.literals) == bool(self.options):
            raise MissionError("a query needs either literals (a yes/no query, at least one) or options (a choice)")
        if not 2 <= self.part_count <= MAX_PARTS:
            raise MissionError(f"a query with {self.part_count} parts: it must have 2 to {MAX_PARTS}")
        if self.none_of_these and not self.options:
            raise MissionError("'none of these' is a part of choices only")
        for one, other in combinations(self.options, 2):
            if not exclusive(one, other):
                raise MissionError(f"options '{one.label}' and '{other.label}' may hold at once; they must exclude")

    @property
    def is_choice(self) -> bool:
        """Whether it is answered by one of its options, not by yes or no."""
        return bool(self.options)

    @property
    def part_count(self) -> int:
        """How many parts it has, 2 to `MAX_PARTS`."""
        return len(self.options) + self.none_of_these if self.options else 2

    @property
    def effort(self) -> float:
        """How many times as long as a yes or no its answer takes: 1, or `CHOICE_EFFORT`."""
        return CHOICE_EFFORT if self.options else 1.0

    @property
    def id(self) -> str:
        """Stable name made of its contents: equal queries said alike have equal ids."""
        if not self.options:
            return contents(self.literals, self.combine)
        named = [f"[{contents(x.literals, x.combine)}]" for x in self.options]
        return " | ".join([*named, "else"] if self.none_of_these else named)

    @property
    def every_literal(self) -> tuple[Literal, ...]:
        """Its literals, or those of all its options."""
        return self.literals or tuple(x for option in self.options for x in option.literals)

    @property
    def gap_ids(self) -> tuple[str, ...]:
        """The gaps that it speaks of, sorted, none twice."""
        return tuple(sorted({x.gap for x in self.every_literal}))

    def holds(self, assignment: Mapping[str, str]) -> bool:
        """The true answer to a yes/no query under a joint hypothesis (gap id → value).

        Raises `MissionError` for a choice.
        """
        if self.options:
            raise MissionError(f"query '{self.id}' is a choice: it has no yes and no")
        return holds(self.literals, self.combine, assignment)

    def part_of(self, assignment: Mapping[str, str]) -> int:
        """The part, 0 to `part_count` - 1, that holds a joint hypothesis (gap id → value).

        Raises:
            KeyError: the hypothesis lacks a gap.
            MissionError: no option of a choice without "none of these" covers it.
        """
        if not self.options:
            return YES_PART if self.holds(assignment) else NO_PART
        for part, option in enumerate(self.options):
            if option.holds(assignment):
                return part
        if not self.none_of_these:
            raise MissionError(f"query '{self.id}' has no part for {dict(assignment)}: it needs 'none of these'")
        return len(self.options)

    def part_table(self, joint: Joint) -> SmallInts:
        """The part of each joint hypothesis, in the shape of ``joint.probability``.

        Raises:
            KeyError: the query speaks of a gap that ``joint`` does not hold.
            MissionError: no option of a choice without "none of these" covers some hypothesis.
        """
        return self.parts_over(tuple((gap.id, gap.values) for gap in joint.gaps))

    def parts_over(self, domain: Domain) -> SmallInts:
        """As `part_table`, over the values of these gaps, one axis each."""
        if not self.options:
            return np.where(truths(self.literals, self.combine, domain), YES_PART, NO_PART).astype(np.int8)
        parts: SmallInts = np.full([len(values) for _, values in domain], len(self.options), np.int8)
        for part, option in enumerate(self.options):
            parts[truths(option.literals, option.combine, domain)] = part
        if not self.none_of_these and parts.max() == len(self.options):
            raise MissionError(f"the options of query '{self.id}' do not cover everything: it needs 'none of these'")
        return parts

    def part_words(self, part: int) -> str:
        """That answer in a word or two: ``yes``, ``no``, the label of an option, ``none of these``."""
        if not self.options:
            return "yes" if part == YES_PART else "no"
        return self.options[part].label if part < len(self.options) else NONE_OF_THESE

    def asserted(self, part: int) -> tuple[Literal, ...]:
        """The literals that this answer says outright, each by itself: none for a No, nor for an any-of of several."""
        if self.options:
            named = self.options[part : part + 1]
            literals, combine = (named[0].literals, named[0].combine) if named else ((), Combine.ALL)
        else:
            literals, combine = (self.literals if part == YES_PART else ()), self.combine
        return literals if combine is Combine.ALL or len(literals) == 1 else ()


def choice(options: Sequence[Option], gaps: Iterable[KnowledgeGap]) -> Query:
    """A choice among options, with "none of these" where they leave some values of the gaps uncovered.

    Args:
        options: one to four, of which no two hold at once.
        gaps: at least those that they speak of.

    Raises:
        KeyError: an option speaks of another gap.
        MissionError: options overlap, or there are fewer than two or more than four parts.
    """
    known = {gap.id: gap for gap in gaps}
    spoken_of = sorted({x.gap for option in options for x in option.literals})
    domain = tuple((name, known[name].values) for name in spoken_of)
    covered = np.zeros([len(values) for _, values in domain], bool)
    for option in options:
        covered |= truths(option.literals, option.combine, domain)
    return Query(options=tuple(options), none_of_these=not covered.all())


ATTRIBUTES_NOT_KNOWN = 2
"""Somebody who did not know so many attributes of a thing is not asked about it any more (method, section 5)."""


def topics(query: Query) -> frozenset[str]:
    """What somebody does not know who does not know the answer (method, section 5).

    Regions, rooms and values by gap id; of a target gap the attribute that was asked about: ``target:1:box/colour``.
    """
    return frozenset(
        f"{x.gap}/{x.saying.name or 'which one'}" if kind_of(x.gap) is GapKind.TARGET else x.gap
        for x in query.every_literal
    )


def is_refused(query: Query, withdrawn: Collection[str]) -> bool:
    """Whether a query is not to be asked: it was withdrawn itself, or turns on something that is not known.

    Args:
        query: the query.
        withdrawn: ids of queries, `topics`, and ids of gaps that are withdrawn altogether.
    """
    if not withdrawn:
        return False
    about = topics(query)
    if query.id in withdrawn or any(name in withdrawn for name in (*query.gap_ids, *about)):
        return True
    return any(_too_many(name, about, withdrawn) for name in query.gap_ids if kind_of(name) is GapKind.TARGET)


def _too_many(gap_id: str, about: frozenset[str], withdrawn: Collection[str]) -> bool:
    """Whether a query would ask somebody who did not know one attribute of a thing about too many others at once."""
    unknown = [name for name in withdrawn if name.startswith(f"{gap_id}/")]
    asked = [name for name in about if name.startswith(f"{gap_id}/")]
    return bool(unknown) and len(unknown) + len(asked) > ATTRIBUTES_NOT_KNOWN


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """A query with words. The words never decide the meaning."""

    query: Query
    text: str
    """What is shown or spoken: one short question, never negated."""
    yes_means: str
    """The consequence of Yes, in plain words: ``fly through the smoke``. Empty for a choice."""
    no_means: str
    """The consequence of No, in plain words. Empty for a choice."""
    gaps: tuple[KnowledgeGap, ...]
    """The gaps that the query speaks of, for pictures and for operators that compute their answer."""
    attempt: int = 1
    """1 for the first time, 2 and more when the same query is asked again in other words."""
    worded_by: str = "template"
    """Who made the words."""
    option_means: tuple[str, ...] = ()
    """Of a choice: the consequence of each part, in order."""
    id: str = ""
    """Names the question in one mission; answers carry it. Empty until the question is put."""
    read_back: Answer | None = None
    """What was understood and takes effect only if it is confirmed now; None: the question itself is asked."""

    def means(self, part: int) -> str:
        """The consequence of the answer that names that part; empty where none was worded."""
        means = self.option_means if self.query.is_choice else (self.yes_means, self.no_means)
        return means[part] if part < len(means) else ""


class Reply(StrEnum):
    """What came back. Silence is a reply."""

    YES = "yes"
    NO = "no"
    OPTION = "option"
    """One of the parts of a choice; `Answer.option` says which."""
    UNSURE = "unsure"
    TIMEOUT = "timeout"


class Order(StrEnum):
    """What an operator may order at any time; obeyed by the very next motion."""

    HOLD = "hold"
    """Brake, hover, and wait for another order."""
    CONTINUE = "continue"
    """Think again from here, and go on."""
    RETURN = "return"
    """Fly back to the start through space that is known to be free."""
    ABORT = "abort"
    """Brake, ask nothing more, and do what is safest: land here where that is possible, else return and land."""
    LAND = "land"
    """Land here if the ground below is known to be free, else at the nearest place where it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """A query with the part of it that was said to hold."""

    query: Query
    part: int
    """0 to `Query.part_count` - 1; of a yes/no query `YES_PART` or `NO_PART`."""

    def __post_init__(self) -> None:
        if not 0 <= self.part < self.query.part_count:
            raise MissionError(f"part {self.part} of query '{self.query.id}', which has {self.query.part_count} parts")


class Standing(StrEnum):
    """How far an answer may be relied on where it takes caution away (method, section 12)."""

    PLAIN = "plain"
    """A key for that question, or a whole utterance of a closed list."""
    UNCONFIRMED = "unconfirmed"
    """It reads as such: where it takes caution away it is read back first."""
    CONFIRMED = "confirmed"
    """A plain yes to what was read back."""


PARTS = MappingProxyType({Reply.YES: YES_PART, Reply.NO: NO_PART})
"""The parts of a yes/no query by reply."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """An operator's reaction to one question [y]."""

    reply: Reply
    latency_s: float
    """From the question's appearance to the reply, seconds."""
    text: str = ""
    """Raw words, as given. Data, never an instruction to this program."""
    also: tuple[Evidence, ...] = ()
    """Extra evidence: what was said beyond the question (``not the red one, the blue one``). It teaches the belief, and
    never counts as the explicit yes that opens a region."""
    understood_by: str = ""
    """Who made a reply of the words: ``rules``, ``model``, or empty where nobody had to."""
    standing: Standing = Standing.PLAIN
    """How far it may be relied on where it takes caution away."""
    by: str = "key"
    """How it came: ``key``, ``typed`` or ``voice``."""
    option: int | None = None
    """The part of a choice that was chosen, 0 to `Query.part_count` - 1; None for every other reply."""

    def __post_init__(self) -> None:
        if (self.option is not None) is not (self.reply is Reply.OPTION):
            raise MissionError(f"reply '{self.reply}' with option {self.option}: an option goes with 'option' only")

    @property
    def part(self) -> int | None:
        """The part of the query that the reply names; None for UNSURE and TIMEOUT."""
        return PARTS.get(self.reply, self.option)


def answer_for(query: Query, part: int, *, latency_s: float = 0.0, text: str = "") -> Answer:
    """The answer that names that part of the query: yes or no, or one of the options."""
    if query.is_choice:
        return Answer(reply=Reply.OPTION, option=part, latency_s=latency_s, text=text)
    return Answer(reply=Reply.YES if part == YES_PART else Reply.NO, latency_s=latency_s, text=text)


__all__ = [
    "CHOICE_EFFORT",
    "MAX_PARTS",
    "NONE_OF_THESE",
    "NO_PART",
    "PARTS",
    "YES_PART",
    "Answer",
    "Combine",
    "Domain",
    "Evidence",
    "Literal",
    "Option",
    "Order",
    "Query",
    "Question",
    "Reply",
    "Saying",
    "SayingKind",
    "Standing",
    "answer_for",
    "choice",
    "is_refused",
    "topics",
]
