"""What the classes of words do to each other: negation and doubt, and the subject that a statement is about.

An answer is read from left to right, part by part. A negation waits for what it denies; one that finds nothing is a No.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from mintpilot.core.gap import GapKind
from mintpilot.language.answer_kinds import Atom, Kind


class Claim(StrEnum):
    """What an answer says, taken together."""

    YES = "yes"
    NO = "no"
    BOOST = "boost"
    AGREE = "agree"
    PASSABLE = "passable"
    BLOCKED = "blocked"
    AWAY = "away"
    """An order to keep out."""
    PRESENT = "present"
    ABSENT = "absent"
    UNSURE = "unsure"
    UNSEEN = "unseen"
    """Nobody was seen or heard, which alone does not say that nobody is there."""
    UNCLEAR = "unclear"
    """It says something that cannot be relied on: doubly negated, or about something else."""
    EITHER = "either"
    """``no toxic fumes``: a denial, or a No and its reason."""


_WORLD = frozenset((Claim.PRESENT, Claim.ABSENT, Claim.BLOCKED, Claim.PASSABLE))
_OPENING = frozenset((Claim.PASSABLE, Claim.YES, Claim.AGREE))
_PLAIN = frozenset((Claim.YES, Claim.NO, Claim.AGREE))


@dataclass(slots=True)
class Said:
    """The claims of an answer and what weakens them."""

    claims: set[Claim] = field(default_factory=set)
    plain: set[Claim] = field(default_factory=set)
    """Yes, No and consent, said without a doubt in their part of the answer."""
    is_hedged: bool = False
    is_condition: bool = False
    is_past: bool = False
    was_then: bool = False
    """True for ``was``: of the past, but perhaps still so."""
    is_parting: bool = False
    """True when people are said to have gone out, which the past makes no less true."""
    is_mockery: bool = False
    is_benign: bool = False
    waits: bool = False
    """True when it ends with a request for time."""
    strange: list[str] = field(default_factory=list)
    """Unknown words."""
    is_clean: bool = False
    """True when a part of its own says something of the world without an unknown word: the rest explains it."""
    breaks_after_plain: bool = False
    """True when a Yes or No is a part of its own: what is said besides explains it."""


@dataclass(slots=True)
class Part:
    """What is open in the part of an answer that is being read."""

    negated: bool = False
    raised: bool = False
    """True for ``I do not think``: the negation passes on to what is thought."""
    soft: bool = False
    doubted: bool = False
    exists: bool = False
    perceived: bool = False
    minimised: bool = False
    of_others: bool = False
    """True when it is about ``we``, ``he``: not about the way that was asked about."""
    some: bool = False
    subject: Kind | None = None
    bare: Kind | None = None
    """People of whom nothing was said yet."""
    tells: bool = False
    """True when a verb says something of the people just named: ``my brother is …``."""
    passes_over: bool = False
    denied: bool = False
    """True once a negation was said in it."""
    rules_out: bool = False
    claims: set[Claim] = field(default_factory=set)
    strange: int = 0


class Scan:
    """Reads atoms in order."""

    def __init__(self, about: GapKind, handlers: Mapping[Kind, Callable[[Scan, Atom], None]]) -> None:
        self.about = about
        self.said = Said()
        self.part = Part()
        self.any_doubt = False
        self._doubt_alone = False
        self._denied_before = False
        self._handlers = handlers

    def read(self, atoms: Sequence[Atom]) -> Said:
        """The claims that the atoms make."""
        end = Atom(Kind.BREAK, "")
        for atom, following in zip(atoms, (*atoms[1:], end), strict=False):
            self._step(atom, following)
        self._close()
        doubted = self.any_doubt and (self.about is GapKind.OBSTACLE or not self.said.plain)
        self.said.is_hedged = doubted or self._doubt_alone
        return self.said

    def claim(self, claim: Claim) -> None:
        """Notes a claim; it uses up the negation before it."""
        self.said.claims.add(claim)
        self.part.claims.add(claim)
        self.said.waits = False
        self.part.negated = self.part.soft = False

    def _step(self, atom: Atom, following: Atom) -> None:
        if atom.kind is Kind.BREAK:
            self._close()
        elif self.part.passes_over:
            self.part.passes_over = False
        elif atom.text == "no":
            self._no(following)
        elif atom.kind in (Kind.SUBJECT, Kind.PLACE, Kind.PRONOUN):
            self._subject(atom.kind, following.kind)
        elif atom.kind in self._handlers:
            before = set(self.said.claims)
            self._handlers[atom.kind](self, atom)
            if atom.is_mended and self.about is GapKind.OBSTACLE and (opened := (self.said.claims - before) & _OPENING):
                self._leave_out(opened, atom)

    def _leave_out(self, opened: set[Claim], atom: Atom) -> None:
        """A mended word opens no way: after a Yes it is one more unknown word, else it leaves the answer unclear."""
        if Claim.YES not in self.said.claims - opened:
            self.claim(Claim.UNCLEAR)
            return
        self.said.claims -= opened
        self.part.claims -= opened
        self.said.strange.append(atom.text)
        self.part.strange += 1

    def _subject(self, kind: Kind, following: Kind) -> None:
        """A new subject with its verb ends the reach of a negation, but for one that is passed on."""
        self.part.strange += kind is Kind.PLACE and self.about is GapKind.PRESENCE
        has_verb = following in (Kind.VERB, Kind.LIKELY, Kind.PAST)
        if has_verb and self.part.negated and not self.part.raised:
            self.claim(Claim.NO)
        if has_verb or (kind is Kind.PRONOUN and following not in (Kind.NOISE, Kind.THINK, Kind.KNOW)):
            self.part.of_others = kind is Kind.PRONOUN

    def _no(self, next_atom: Atom) -> None:
        """``no`` by itself, or before what it denies."""
        following = Kind.NOISE if next_atom.text.startswith("some") else next_atom.kind
        if following in (Kind.HAZARD, Kind.SAFE, Kind.CLEAR, Kind.TRACE, Kind.PERSON):
            self.part.negated = True
        elif following is Kind.DANGER:
            self.claim(Claim.EITHER)
            self.part.passes_over = True
        elif following is Kind.PLACE or (following is Kind.STRANGE and self.about is not GapKind.OBSTACLE):
            self.claim(Claim.UNCLEAR)
        elif following is not Kind.BREAK or not self._denied_before:
            self.claim(Claim.NO)

    def _close(self) -> None:
        """Ends the part; ``not the red ones, no``, ``not empty, no`` say one thing twice."""
        part = self.part
        self._denied_before = part.rules_out or (part.denied and Claim.PRESENT in part.claims)
        if not part.claims - {Claim.BOOST}:
            self._settle_bare(part)
        if part.negated:  # ``not all of them`` says nothing of the rest
            is_told = part.of_others and part.strange and self.about is GapKind.PRESENCE  # I can not breathe
            is_part = part.subject is Kind.EVERYBODY
            unclear = is_part or (is_told and Claim.NO not in self.said.plain)
            self.claim(Claim.UNCLEAR if unclear else Claim.NO)
        if part.soft and self.about is GapKind.OBSTACLE:  # yes, slightly
            self.any_doubt = True
        self.said.is_clean |= bool(part.claims & _WORLD) and not (part.strange or part.doubted)
        if part.doubted:
            self.any_doubt = True
            self._doubt_alone |= not part.claims
        else:
            self.said.plain |= part.claims & _PLAIN
            self.said.breaks_after_plain |= bool(part.claims & _PLAIN) and not part.strange
        self.part = Part()

    def _settle_bare(self, part: Part) -> None:
        """``nobody``, ``two people``, ``my brother``, with nothing said of them."""
        if part.bare is Kind.NOBODY:
            self.claim(Claim.UNCLEAR if part.strange or part.negated else Claim.ABSENT)
        elif (part.bare is not None or (part.exists and not part.negated)) and not part.strange:
            self.claim(Claim.ABSENT if part.negated else Claim.PRESENT)


def deny(scan: Scan) -> None:
    """Opens a negation; a second one before the first found anything makes the answer unclear."""
    if scan.part.negated:
        scan.claim(Claim.UNCLEAR)
    scan.part.negated = scan.part.denied = True


def deny_knowing(scan: Scan) -> None:
    """``I can not tell``, ``nobody knows``."""
    scan.part.bare = None
    scan.claim(Claim.UNSURE)
