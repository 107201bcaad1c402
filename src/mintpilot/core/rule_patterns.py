"""The patterns of rules in time → words and formula, for mission files and instructions (method, section 14)."""

from __future__ import annotations

from mintpilot.core.message import verbatim
from mintpilot.core.rule import About, Proposition, Rule


def never(what: Proposition) -> Rule:
    """``what`` at no moment."""
    return Rule(text=verbatim(f"never {said(what)}"), formula=f"G !{what}")


def always(what: Proposition) -> Rule:
    """``what`` at every moment; to be always in a region means with the whole body."""
    if what.about is About.IN:
        what = Proposition(about=About.INSIDE, subject=what.subject)
    return Rule(text=verbatim(f"always {said(what)}"), formula=f"G {what}")


def never_before(what: Proposition, before: Proposition) -> Rule:
    """``what`` at no moment before ``before``; where ``before`` never comes, never."""
    return Rule(
        text=verbatim(f"never {said(what)} before it {done(before)}"), formula=f"({before} R (!{what} | {before}))"
    )


def first_then(first: Proposition, then: Proposition) -> Rule:
    """Both, ``then`` not before ``first``."""
    return Rule(text=verbatim(f"first {said(first)}, then {said(then)}"), formula=f"((!{then} U {first}) & F {then})")


def after_eventually(after: Proposition, then: Proposition) -> Rule:
    """Whenever ``after`` holds, ``then`` at that moment or later."""
    text = f"once it {done(after)}, {said(then)} at some time after it"
    return Rule(text=verbatim(text), formula=f"G (!{after} | F {then})")


def at_end(what: Proposition) -> Rule:
    """``what`` at the last moment."""
    return Rule(text=verbatim(f"at the end {said(what)}"), formula=f"F G {what}")


def said(what: Proposition) -> str:
    """The proposition after *always*, *never* or *first*."""
    return _SAID[what.about][0].format(what.subject, what.metres)


def done(what: Proposition) -> str:
    """The proposition after *it*."""
    return _SAID[what.about][1].format(what.subject, what.metres)


_SAID = {
    About.IN: ("in {0}", "was in {0}"),
    About.INSIDE: ("inside {0} with the whole body", "was inside {0}"),
    About.TOUCHES: ("touch {0}", "touched {0}"),
    About.WITHIN: ("within {1:g} m of {0}", "was within {1:g} m of {0}"),
    About.AT: ("at {0}", "was at {0}"),
    About.DID: ("do {0}", "did {0}"),
    About.LOOKED: ("look into {0}", "looked into {0}"),
    About.CARRYING: ("carry {0}", "carried {0}"),
}
