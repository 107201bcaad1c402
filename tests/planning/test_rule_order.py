"""Which states of rules are no harder than others, against the words that they accept (method, section 14)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracles import ltlf

from mintpilot.core.errors import LimitError
from mintpilot.planning import rule_order
from mintpilot.planning.rule_order import covers, hardest, no_harder
from mintpilot.rules.compiling import compile_formula
from mintpilot.rules.parsing import parse


def drawn(seed):
    try:
        return compile_formula(parse(ltlf.text(ltlf.drawn(np.random.default_rng(seed), "abc", 4))))
    except LimitError:
        return compile_formula(parse("F at(a)"))


def _loses(automaton, one, other):
    """Whether some word keeps the rules from the one state on and not from the other, by going through all pairs."""
    coming = seen = {(one, other)}
    while coming:
        if any(automaton.accepting[p] and not automaton.accepting[q] for p, q in coming):
            return True
        after = {(int(a), int(b)) for p, q in coming
                 for a, b in zip(automaton.following[p], automaton.following[q], strict=True)}  # fmt: skip
        coming = after - seen
        seen = seen | coming
    return False


@settings(deadline=None)
@given(st.integers(0, 10**6))
def test_a_state_is_no_harder_where_it_accepts_every_word_of_the_other(seed):
    automaton = drawn(seed)
    order = no_harder(automaton)
    for p in range(automaton.size):
        for q in range(automaton.size):
            assert order[p, q] == (not _loses(automaton, p, q))


@pytest.mark.long
@settings(deadline=None)
@given(st.integers(0, 10**6), st.data())
def test_the_hardest_states_stand_for_all_of_them_at_every_moment(seed, data):
    automaton = drawn(seed)
    order, names = no_harder(automaton), len(automaton.propositions)
    states = frozenset(data.draw(st.sets(st.integers(0, automaton.size - 1), min_size=1)))
    few = hardest(states, order)
    letters = st.integers(0, (1 << names) - 1)
    for yes, more in data.draw(st.lists(st.tuples(letters, letters), max_size=4)):
        assert few <= states
        assert covers(few, states, order)
        assert covers(states, few, order)
        assert all(automaton.accepting[list(few)]) == all(automaton.accepting[list(states)])
        assert all(automaton.alive[list(few)]) == all(automaton.alive[list(states)])
        states, few = (automaton.after(one, yes, yes | more) for one in (states, hardest(few, order)))
        few, states = hardest(few, order), frozenset(states)
        assert hardest(states, order) == few
        states = few


def test_an_automaton_too_large_to_compare_is_followed_as_it_is(monkeypatch):
    monkeypatch.setattr(rule_order, "MOST_COMPARED", 1)
    automaton = compile_formula(parse("F at(a) & F at(b) & F at(c)"))
    assert (no_harder(automaton) == np.eye(automaton.size, dtype=bool)).all()
