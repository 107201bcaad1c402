"""What words of attitude and words about ways claim in their place."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from mintpilot.core.gap import GapKind
from mintpilot.language.answer_kinds import Atom, Kind
from mintpilot.language.answer_people import PEOPLE
from mintpilot.language.answer_scope import Claim, Said, Scan, deny, deny_knowing


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_DENIED_IS_SAFE = _words(
    "dangerous toxic poisonous unsafe hazardous risky deadly lethal harmful blocked obstructed closed shut "
    "hurt harm damage jammed impassable sealed barred restricted forbidden prohibited contaminated "
)
"""Of the dangers, those whose absence means that the way is free; without a fire there may still be gas."""

_OF_PEOPLE_TOO = _words("stuck hurt awful terrible bad horrible nasty lousy hot trapped")
"""Of the dangers, those that are none of the way where ``we`` or ``my brother`` is."""


_DONE = frozenset(("searched", "searched it", "checked", "looked", "been", "seen", "heard"))
_CONFIRMING = re.compile(r"confirm|\bsay yes\b|\baffirm\b")


def read_claims(atoms: Sequence[Atom], about: GapKind) -> Said:
    """What an answer claims about the kind of thing that was asked."""
    return Scan(about, _HANDLERS).read(atoms)


def _claims(plainly: Claim, denied: Claim) -> Callable[[Scan, Atom], None]:
    return lambda scan, _: scan.claim(denied if scan.part.negated else plainly)


def _strange(scan: Scan, atom: Atom) -> None:
    scan.said.strange.append(atom.text)
    scan.part.strange += 1


def _yes(scan: Scan, atom: Atom) -> None:
    """``I can not confirm it`` is no No."""
    denied = Claim.UNSURE if _CONFIRMING.search(atom.text) else Claim.NO
    scan.claim(denied if scan.part.negated else Claim.YES)


def _boost(scan: Scan, atom: Atom) -> None:
    if not scan.part.negated:
        scan.part.claims.add(Claim.BOOST)
        scan.said.claims.add(Claim.BOOST)
    elif "sure" in atom.text or "certain" in atom.text:
        scan.claim(Claim.UNSURE)


def _know(scan: Scan, atom: Atom) -> None:
    scan.part.exists &= atom.text not in _DONE  # ``we have searched it``: no ``we have people``
    if scan.part.negated or (scan.part.bare is Kind.NOBODY and atom.text != "been"):
        deny_knowing(scan)


def _doubt(scan: Scan, atom: Atom) -> None:
    scan.part.doubted = True
    scan.part.raised |= scan.part.negated and atom.kind is Kind.THINK


def _unlikely(scan: Scan, _: Atom) -> None:
    """A doubt that denies what follows it; by itself it is a No."""
    if scan.part.negated:
        scan.claim(Claim.UNCLEAR)
    scan.part.doubted = scan.part.negated = scan.part.raised = True


def _soft(scan: Scan, _: Atom) -> None:
    scan.part.soft = True


def _very(scan: Scan, _: Atom) -> None:
    """``not very dangerous`` is no ``not dangerous``."""
    scan.part.soft |= scan.part.negated


def _agree(scan: Scan, atom: Atom) -> None:
    """``we are fine`` is no consent."""
    denied, other = scan.part.negated, scan.part.of_others
    if atom.text in ("good", "fine") and scan.about is GapKind.OBSTACLE and Claim.YES not in scan.said.claims:
        other |= scan.part.strange > 0  # the weather is fine
    scan.claim(Claim.NO if denied else Claim.UNCLEAR if other else Claim.AGREE)


def _stall(scan: Scan, _: Atom) -> None:
    scan.said.waits = True


def _condition(scan: Scan, _: Atom) -> None:
    scan.said.is_condition = True


def _past(scan: Scan, atom: Atom) -> None:
    if atom.text in ("was", "were"):
        scan.said.was_then = True
    else:
        scan.said.is_past = True


def _mock(scan: Scan, _: Atom) -> None:
    scan.said.is_mockery = True


# Ways -----------------------------------------------------------------------------------------------------------------


def _good(scan: Scan, _: Atom) -> None:
    if scan.part.negated:
        scan.claim(Claim.BLOCKED)
    elif scan.part.of_others:
        scan.claim(Claim.UNCLEAR)
    else:
        scan.part.doubted |= scan.part.soft
        scan.claim(Claim.PASSABLE)


def _danger(scan: Scan, atom: Atom) -> None:
    part = scan.part
    if part.of_others and atom.text in _OF_PEOPLE_TOO:
        _strange(scan, atom)
    elif not part.negated:
        scan.claim(Claim.BLOCKED)
    elif part.soft:
        scan.claim(Claim.UNSURE)
    elif atom.kind is Kind.HAZARD or atom.text.split()[0] in _DENIED_IS_SAFE:
        scan.claim(Claim.PASSABLE)
    else:
        part.negated = False


def _benign(scan: Scan, _: Atom) -> None:
    if scan.part.negated:
        scan.claim(Claim.BLOCKED)
    elif scan.part.minimised:
        scan.said.is_benign = True
        scan.claim(Claim.PASSABLE)


def _rule_out(scan: Scan, _: Atom) -> None:
    scan.part.rules_out = True


def _minimise(scan: Scan, _: Atom) -> None:
    scan.part.minimised = True


def _clear(scan: Scan, atom: Atom) -> None:
    if scan.about is GapKind.PRESENCE:
        scan.claim(Claim.UNSURE if scan.part.negated else Claim.ABSENT)
    else:
        _good(scan, atom)


_HANDLERS: dict[Kind, Callable[[Scan, Atom], None]] = {
    **PEOPLE,
    Kind.YES: _yes, Kind.NO: _claims(Claim.NO, Claim.UNCLEAR), Kind.ELSEWHERE:
    _claims(Claim.UNCLEAR, Claim.UNCLEAR), Kind.UNSURE: _claims(Claim.UNSURE, Claim.UNSURE), Kind.RISK:
    _claims(Claim.UNSURE, Claim.NO), Kind.AROUND: _claims(Claim.AWAY, Claim.UNCLEAR), Kind.STRANGE: _strange,
    Kind.BOOST: _boost, Kind.NOT: lambda scan, _: deny(scan), Kind.KNOW: _know, Kind.THINK: _doubt, Kind.LIKELY: _doubt,
    Kind.UNLIKELY: _unlikely, Kind.SOFT: _soft, Kind.VERY: _very, Kind.AGREE: _agree, Kind.STALL: _stall,
    Kind.CONDITION: _condition, Kind.PAST: _past, Kind.MOCK: _mock, Kind.THROUGH: _good, Kind.SAFE: _good,
    Kind.DANGER: _danger, Kind.HAZARD: _danger, Kind.BENIGN: _benign, Kind.MINIMISE: _minimise, Kind.CLEAR:
    _clear, Kind.DENIED: _rule_out,
}  # fmt: skip
