"""The patterns of mission files as rules: ``{never: P, before: Q}`` → words and formula."""

from __future__ import annotations

from mintpilot.core.rule import About, Proposition, Rule
from mintpilot.rules.formula import And, Atom, Formula, Or, Release, Until, always, eventually, negated
from mintpilot.rules.parsing import parse


def never(what: Proposition) -> Rule:
    """``what`` at no moment."""
    return _rule(f"never {said(what)}", always(Atom(what, False)))


def always_(what: Proposition) -> Rule:
    """``what`` at every moment; to be always in a region means with the whole body."""
    if what.about is About.IN:
        what = Proposition(about=About.INSIDE, subject=what.subject)
    return _rule(f"always {said(what)}", always(Atom(what)))


def never_before(what: Proposition, before: Proposition) -> Rule:
    """``what`` at no moment before ``before``; where ``before`` never comes, never."""
    return _rule(
        f"never {said(what)} before it {done(before)}", Release(Atom(before), Or(Atom(what, False), Atom(before)))
    )


def first_then(first: Proposition, then: Proposition) -> Rule:
    """Both, ``then`` not before ``first``."""
    formula: Formula = And(Until(Atom(then, False), Atom(first)), eventually(Atom(then)))
    return _rule(f"first {said(first)}, then {said(then)}", formula)


def after_eventually(after: Proposition, then: Proposition) -> Rule:
    """Whenever ``after`` holds, ``then`` at that moment or later."""
    return _rule(
        f"once it {done(after)}, {said(then)} at some time after it",
        always(Or(negated(Atom(after)), eventually(Atom(then)))),
    )


def at_end(what: Proposition) -> Rule:
    """``what`` at the last moment."""
    return _rule(f"at the end {said(what)}", eventually(always(Atom(what))))


def written(text: str) -> Rule:
    """A rule as somebody wrote it in LTLf. Raises as `mintpilot.rules.parsing.parse`."""
    parse(text)
    return Rule(text=text.strip(), formula=text.strip())


def _rule(text: str, formula: Formula) -> Rule:
    return Rule(text=text, formula=str(formula))


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
