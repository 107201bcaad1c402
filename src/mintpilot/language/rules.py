"""The clauses of an instruction: pattern and what it does. What none of them fits refuses the instruction."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from mintpilot.language import rule_phrases, steps
from mintpilot.language.clauses import Reading
from mintpilot.language.grammar import Found, matched
from mintpilot.language.slots import SLOTS

_Rule = tuple[str, Callable[[Reading, Found], None]]
_DOES: tuple[_Rule, ...] = (
    ("LAUNCH [<height>]", steps.take_off),
    ("(return [HOME] | GO HOME) AT_END", rule_phrases.back_at_the_end),
    ("AT_END [,] (return [HOME] | GO HOME)", rule_phrases.back_at_the_end),
    ("[SLOWLY] (rtl [to home] | return HOME | GO [straight | directly] HOME) [SLOWLY]", steps.home),
    ("(photograph | PICTURE of) <things> {HOW}", steps.photograph),
    ("PICTURE [there]", steps.photograph),
    ("(LOOKS | TELL SEEN) [<room> | AROUND <thing>] [there]", steps.report),
    ("describe <thing>", steps.report),
    ("(count [how many] | HOW_MANY) <thing> [ARE] {PLACE}", steps.count),
    ("HOLD [there | here] OVER <thing> [for <duration>]", steps.wait),
    ("hover [there | here] [<height>] [[for] <duration>]", steps.wait),
    ("HOLD [there | here] [for] <duration>", steps.wait),
    (
        "(CHECK (if | whether | for) SOMEBODY [is | are] | (is | are) [there] SOMEBODY) [STATES] <room>",
        steps.somebody_in,
    ),
    ("ENSURE NOBODY (is | are) [STATES] <room>", steps.somebody_in),
    ("FIND EVERYBODY HELP [HERE] [<venue>]", steps.seek),
    ("EVERYBODY HELP [HERE] [<venue>]", steps.seek_too),
    ("ENSURE NOBODY [HELP | (is | are) (STATES | missing)] [HERE] [<venue>]", steps.seek),
    ("CHECK (if | whether | for) SOMEBODY [HELP | (is | are) STATES] [HERE] [<venue>]", steps.seek),
    ("SCAN <hall> for <things>", steps.find),
    ("LOOK_INTO <rooms> [for <thing>]", steps.look),
    ("(look | check | have a look | search) <room>", steps.look),
    ("FIND <things> [<room>]", steps.find),
    ("[SLOWLY] [<height>] [,] GO [SLOWLY] [ADVERBS] [ADVERBS] [SLOWLY] TO <things> {HOW}", steps.go),
    ("(to | back to) <things> {HOW}", steps.go_too),
    ("RISE <height> [SLOWLY]", steps.rise),
    ("[SLOWLY] VISIT <things> {HOW}", steps.visit),
    ("BRING <thing> [<source>] <goal>", steps.bring),
    ("BRING <who> <thing> [<source>]", steps.bring),
    ("DROP <bare> [down | off] (there | AT <place> | UPON <place>)", steps.drop),
    ("PICK <thing> [up] [<source>]", steps.pick),
    ("<named> (needs | need) <thing> [<source>]", steps.needed),
    ("HOME", steps.home_too),
    ("[SLOWLY] return [SLOWLY]", steps.home),
    ("THERE_IS <named> [STATES] [BY <bare>] [<venue>]", steps.told),
    ("<named> is STATES [BY <bare>] [<venue>]", steps.told),
    ("[into | in] <things> {HOW}", steps.same),
)
"""The first that fits decides; a longer reading stands before a shorter one."""
_KEEPS_OUT: tuple[_Rule, ...] = (
    (
        "[WISH [,]] (AVOID | without ENTERING | NEVER ENTER | STAY [<distance>] OUT_OF) <outs> [[,] WISH]",
        steps.keep_out,
    ),
    ("[WISH [,]] STAY (<distance> | a distance | your distance) from <outs> [[,] WISH]", steps.keep_out),
    ("<named> OFF_LIMITS", steps.keep_out),
    ("(ALWAYS STAY WITHIN | STAY [ALWAYS] (within | inside) | NEVER leave) <outs> [ALWAYS]", rule_phrases.stay_within),
    ("STAY in <outs> ALWAYS", rule_phrases.stay_within),
)
_ENTERED_LATER: tuple[_Rule, ...] = (("(ENTER | ENTERING) <outs>", rule_phrases.enter_later),)
_NOT_BEFORE: tuple[_Rule, ...] = (("NEVER ENTER <outs> BEFORE", rule_phrases.enter_later),)


def read_clause(reading: Reading) -> bool:
    """Takes one clause; False, and nothing taken, where no rule fits. Raises `InputError` for what is impossible."""
    return _first(reading, _DOES)


def keeps_out(reading: Reading) -> bool:
    """Takes one clause that says what is to be stayed out of; False where there is none."""
    return _first(reading, _KEEPS_OUT)


def enters_later(reading: Reading) -> bool:
    """Takes what follows a ``before`` where it is no step but something that is entered; False where it is a step."""
    return _first(reading, _ENTERED_LATER)


def not_entered_before(reading: Reading) -> bool:
    """Takes ``never enter the smoke before``, which a step follows; False where there is none."""
    return _first(reading, _NOT_BEFORE)


def _first(reading: Reading, rules: tuple[_Rule, ...]) -> bool:
    reading.clause_at = reading.words.at
    return any(reading.attempt(partial(_apply, rule=rule)) for rule in rules)


def _apply(reading: Reading, rule: _Rule) -> None:
    pattern, does = rule
    does(reading, matched(pattern, reading, SLOTS))
