"""Patterns, formulas as text, conflicts: what is read, and what is said of mistakes (method, section 14)."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracles import ltlf

from mintpilot.core import rule_patterns as patterns
from mintpilot.core.errors import MissionError, UnknownNameError
from mintpilot.core.rule import About, Proposition, Rule
from mintpilot.rules.compiling import compile_rules
from mintpilot.rules.parsing import parse, proposition
from mintpilot.rules.satisfying import can_be_kept, conflicting, is_trivial

A, B = proposition("at(a)"), proposition("at(b)")
PATTERNS = {
    "never": (patterns.never(A), ("G", ("!", "a"))),
    "always": (patterns.always(A), ("G", "a")),
    "never before": (patterns.never_before(A, B), ("|", ("U", ("!", "a"), "b"), ("G", ("!", "a")))),
    "first then": (patterns.first_then(A, B), ("&", ("U", ("!", "b"), "a"), ("F", "b"))),
    "after eventually": (patterns.after_eventually(A, B), ("G", ("->", "a", ("F", "b")))),
    "end": (patterns.at_end(A), ("F", ("G", "a"))),
}


@pytest.mark.parametrize("name", PATTERNS)
def test_every_pattern_means_its_formula(name):
    rule, meant = PATTERNS[name]
    automaton = compile_rules((rule,))
    moments = [frozenset(x) for n in range(3) for x in itertools.combinations("ab", n)]
    for length in (1, 2, 3, 4):
        for trace in itertools.product(moments, repeat=length):
            state = 0
            for moment in trace:
                letter = sum(1 << i for i, p in enumerate(automaton.propositions) if p.subject in moment)
                state = int(automaton.following[state, letter])
            assert bool(automaton.accepting[state]) == ltlf.holds(meant, trace), (rule.formula, trace)


def test_always_in_a_region_means_with_the_whole_body():
    assert patterns.always(proposition("in(hall)")).formula == "G inside(hall)"
    assert patterns.never(proposition("in(hall)")).formula == "G !in(hall)"


def test_propositions_are_read():
    assert proposition("within(the barrels, 2.5)") == Proposition(about=About.WITHIN, subject="the barrels", metres=2.5)
    assert str(proposition(" touches( smoke-1 ) ")) == "touches(smoke-1)"
    with pytest.raises(MissionError, match="one proposition"):
        proposition("!at(a)")


@pytest.mark.parametrize(
    ("text", "error", "said"),
    [
        ("G X at(a)", MissionError, "column 3.*there is no X"),
        ("X(at(a))", MissionError, "column 1.*there is no X"),
        ("at(a) && at(b)", MissionError, "column 7.*write '&'"),
        ("at(a) and at(b)", MissionError, "column 7.*write '&'"),
        ("not at(a)", MissionError, "column 1.*write '!'"),
        ("always at(a)", MissionError, "column 1.*write 'G'"),
        ("at(a) until at(b)", MissionError, "column 7.*write 'U'"),
        ("touch(a)", UnknownNameError, "Did you mean 'touches'"),
        ("at(a) &", MissionError, "column 8: the end"),
        ("(at(a)", MissionError, r"the end where '\)'"),
        ("at", MissionError, r"write at\(NAME\)"),
        ("at()", MissionError, r"write at\(NAME\)"),
        ("within(a)", MissionError, r"within\(NAME, METRES\)"),
        ("within(a, -1)", MissionError, "above 0"),
        ("within(a, nan)", MissionError, "above 0"),
        ("", MissionError, "the end where"),
        ("!" * 100 + "at(a)", MissionError, "nested deeper"),
        ("(" * 100 + "at(a)" + ")" * 100, MissionError, "nested deeper"),
        ("at(a)" + " -> at(a)" * 100, MissionError, "nested deeper"),
        ("at(a) " * 500, MissionError, "characters"),
    ],
)
def test_a_mistake_is_told_with_its_place_and_what_was_meant(text, error, said):
    with pytest.raises(error, match=said):
        parse(text)


@settings(deadline=None)
@given(st.text(alphabet="at(b)GFUR!&|-> X,1", max_size=40))
def test_any_text_is_read_or_refused(text):
    try:
        parse(text)
    except MissionError:
        return
    except UnknownNameError:
        return


def _rules(seed, count):
    rng = np.random.default_rng(seed)
    return [Rule(text=f"{i}", formula=ltlf.text(ltlf.drawn(rng, "ab", 2))) for i in range(count)]


@pytest.mark.long
@settings(deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 5))
def test_conflicting_rules_cannot_be_kept_and_none_of_them_can_be_left_out(seed, count):
    rules = _rules(seed, count)
    found = conflicting(rules)
    assert bool(found) != can_be_kept(compile_rules(tuple(rules)))
    if found:
        assert not can_be_kept(compile_rules(found))
        for one in found:
            assert can_be_kept(compile_rules(tuple(r for r in found if r is not one)))


def test_a_conflict_names_the_rules_that_make_it():
    rules = [
        patterns.never(proposition("touches(smoke)")),
        patterns.first_then(A, B),
        patterns.at_end(proposition("in(hall)")),
        patterns.never(A),
    ]
    assert [str(r.text) for r in conflicting(rules)] == ["first at a, then at b", "never at a"]


def test_a_rule_that_says_nothing_is_known():
    assert is_trivial(Rule(text="", formula="G(at(a) -> F at(a))"))
    assert not is_trivial(patterns.never(A))


def test_a_sign_before_a_bracket_is_a_sign():
    assert parse("at(a) U (true)") == parse("at(a) U true")
    assert parse("at(a) R(false)") == parse("at(a) R false")
