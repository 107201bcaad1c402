"""What words about people in a room claim in their place."""

from __future__ import annotations

from collections.abc import Callable

from mintpilot.core.gap import GapKind
from mintpilot.language.answer_kinds import Atom, Kind
from mintpilot.language.answer_scope import Claim, Scan, deny, deny_knowing


def _person(scan: Scan, _: Atom) -> None:
    part = scan.part
    if part.negated:
        part.negated = False
        part.subject = part.bare = Kind.NOBODY
        if part.perceived:
            scan.claim(Claim.UNSEEN)
        return
    part.strange += part.tells
    part.subject = part.bare = Kind.PERSON
    if part.exists or part.perceived:
        scan.claim(Claim.PRESENT)


def _number(scan: Scan, atom: Atom) -> None:
    if scan.part.subject is None:
        _person(scan, atom)


def _subject(scan: Scan, atom: Atom) -> None:
    scan.part.subject = atom.kind
    if scan.part.perceived:
        scan.claim(Claim.PRESENT)


def _nobody(scan: Scan, _: Atom) -> None:
    part = scan.part
    if scan.about is not GapKind.PRESENCE:
        deny(scan)
    elif part.negated:
        scan.claim(Claim.UNCLEAR)
    elif part.perceived:
        scan.claim(Claim.UNSEEN)
    else:
        part.subject = part.bare = Kind.NOBODY


def _some(scan: Scan, _: Atom) -> None:
    scan.part.some = True
    scan.part.subject = scan.part.subject or Kind.PERSON


def _inside(scan: Scan, _: Atom) -> None:
    part = scan.part
    if part.subject is Kind.NOBODY:
        scan.claim(Claim.UNCLEAR if part.negated else Claim.ABSENT)
    elif part.subject is None:
        if part.negated:
            scan.claim(Claim.UNSURE)
    elif part.negated and (part.some or part.subject is Kind.EVERYBODY):
        scan.claim(Claim.UNCLEAR)
    else:
        scan.claim(Claim.ABSENT if part.negated else Claim.PRESENT)


def _trapped(scan: Scan, atom: Atom) -> None:
    """``nobody is hurt`` does not say that nobody is there."""
    if scan.part.subject is Kind.NOBODY or (scan.part.subject is not None and scan.part.negated):
        scan.part.strange += 1
        scan.part.negated = False
    elif scan.part.subject is not None:
        _inside(scan, atom)


def _out(scan: Scan, _: Atom) -> None:
    part = scan.part
    scan.said.is_parting |= part.subject in (Kind.EVERYBODY, Kind.ONE) and not part.negated
    if part.some and not part.negated:
        scan.claim(Claim.UNCLEAR)
    elif part.subject is Kind.NOBODY:
        scan.claim(Claim.UNCLEAR if part.negated or part.strange else Claim.PRESENT)
    elif part.subject in (Kind.EVERYBODY, Kind.ONE):
        scan.claim(Claim.PRESENT if part.negated else Claim.ABSENT)
    elif part.subject is not None:
        scan.claim(Claim.PRESENT if part.negated else Claim.UNCLEAR)
    else:
        scan.claim(Claim.UNCLEAR if part.negated or part.strange or part.of_others else Claim.ABSENT)


def _left(scan: Scan, atom: Atom) -> None:
    """``nobody left``, without a place, may be said of a room that nobody left."""
    part = scan.part
    if part.subject is Kind.NOBODY:
        part.strange += not part.exists
    elif part.subject in (Kind.EVERYBODY, Kind.ONE):
        _out(scan, atom)


def _trace(scan: Scan, _: Atom) -> None:
    part = scan.part
    if part.negated or part.bare is Kind.NOBODY or (part.of_others and not part.perceived):
        part.bare = None
        scan.claim(Claim.UNSURE)
    else:
        scan.claim(Claim.PRESENT)


def _perceive(scan: Scan, _: Atom) -> None:
    if scan.part.negated or scan.part.bare is Kind.NOBODY:
        deny_knowing(scan)
    else:
        scan.part.perceived = True


def _exist(scan: Scan, _: Atom) -> None:
    scan.part.exists = True


def _verb(scan: Scan, _: Atom) -> None:
    scan.part.tells = scan.part.bare is Kind.PERSON


def _thing(scan: Scan, atom: Atom) -> None:
    """``only a dummy``: nobody; by itself a thing says nothing of people."""
    if scan.part.minimised and not scan.part.negated:
        scan.claim(Claim.ABSENT)
    else:
        scan.said.strange.append(atom.text)
        scan.part.strange += 1


def _occupied(scan: Scan, atom: Atom) -> None:
    scan.part.denied |= atom.text.startswith("not ")
    scan.claim(Claim.ABSENT if scan.part.negated else Claim.PRESENT)


PEOPLE: dict[Kind, Callable[[Scan, Atom], None]] = {
    Kind.PERSON: _person, Kind.NUMBER: _number, Kind.ONE: _subject, Kind.EVERYBODY: _subject, Kind.NOBODY:
    _nobody, Kind.SOME: _some, Kind.INSIDE: _inside, Kind.TRAPPED: _trapped, Kind.BYSTANDING: _out,
    Kind.OUT: _out, Kind.LEFT: _left,
    Kind.TRACE: _trace, Kind.PERCEIVE: _perceive, Kind.EXIST: _exist,
    Kind.EMPTY: lambda scan, _: scan.claim(Claim.PRESENT if scan.part.negated else Claim.ABSENT),
    Kind.THING: _thing, Kind.VERB: _verb,
    Kind.OCCUPIED: _occupied,
}  # fmt: skip
"""Class → what it does."""
