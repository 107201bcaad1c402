"""Automata of rules against LTLf's own definition, and against MONA (method, section 14)."""

import itertools
import re
import shutil

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracles import ltlf

from mintpilot.core.errors import LimitError
from mintpilot.core.rule import Rule
from mintpilot.rules.compiling import MAX_STATES, compile_formula, compile_rules
from mintpilot.rules.formula import negated
from mintpilot.rules.monitor import is_kept, truth
from mintpilot.rules.parsing import parse

NAMES = "abc"
seeds = st.integers(0, 10**6)


def _formula(seed, depth=3):
    return ltlf.drawn(np.random.default_rng(seed), NAMES, depth)


def _accepts(automaton, trace):
    state = 0
    for moment in trace:
        letter = sum(1 << i for i, p in enumerate(automaton.propositions) if p.subject in moment)
        state = int(automaton.following[state, letter])
    return bool(automaton.accepting[state])


def _moments(names):
    return [frozenset(x) for n in range(len(names) + 1) for x in itertools.combinations(names, n)]


@pytest.mark.long
@settings(deadline=None)
@given(seeds)
def test_every_short_trace_is_judged_by_the_definition(seed):
    formula = _formula(seed)
    automaton = compile_formula(parse(ltlf.text(formula)))
    names = [p.subject for p in automaton.propositions]
    for length in (1, 2, 3) if len(names) > 2 else (1, 2, 3, 4):
        for trace in itertools.product(_moments(names), repeat=length):
            assert _accepts(automaton, trace) == ltlf.holds(formula, trace), (formula, trace)


@settings(deadline=None)
@given(seeds, st.lists(st.sets(st.sampled_from(NAMES)).map(frozenset), min_size=1, max_size=9))
def test_the_monitor_tells_what_the_definition_says_at_every_moment(seed, trace):
    formula = _formula(seed, depth=4)
    said = ltlf.text(formula)

    def of(about, subject, metres):
        assert (about, metres) == ("at", 0.0)
        return np.array([subject in moment for moment in trace])

    found = truth(said, of, len(trace))
    assert found.tolist() == [ltlf.holds(formula, trace, i) for i in range(len(trace))]


@settings(deadline=None)
@given(
    st.recursive(
        st.sampled_from(("at(a)", "at(b)", "at(c)", "true", "false")),
        lambda inner: st.one_of(
            st.builds("{} {} {}".format, inner, st.sampled_from(("->", "|", "&", "U", "R")), inner),
            st.builds("{}{}".format, st.sampled_from(("!", "G ", "F ")), inner),
            st.builds("({})".format, inner),
        ),
        max_leaves=6,
    ),
    st.lists(st.sets(st.sampled_from(NAMES)).map(frozenset), min_size=1, max_size=5),
)
def test_the_monitor_reads_without_brackets_what_the_automaton_does(said, trace):
    automaton = compile_formula(parse(said))
    kept = is_kept(said, lambda _, name, __: np.array([name in moment for moment in trace]), len(trace))
    assert _accepts(automaton, trace) == kept, said


@pytest.mark.parametrize("said", ["at(a) at(b)", "(at(a)", "at", "X at(a)", "at(a) &", "", "%"])
def test_the_monitor_refuses_what_is_no_formula(said):
    with pytest.raises(ValueError, match="'"):
        is_kept(said, lambda *_: np.ones(2, bool), 2)


@settings(deadline=None)
@given(seeds)
def test_no_two_states_are_alike_and_all_are_reached(seed):
    automaton = compile_formula(parse(ltlf.text(_formula(seed))))
    reached, coming = set(), {0}
    while coming:
        reached |= coming
        coming = set(automaton.following[sorted(coming)].ravel().tolist()) - reached
    assert reached == set(range(automaton.size))
    apart = automaton.accepting[:, None] != automaton.accepting[None]
    while True:
        wider = apart | apart[automaton.following[:, None], automaton.following[None]].any(axis=2)
        if (wider == apart).all():
            break
        apart = wider
    assert (apart | np.eye(automaton.size, dtype=bool)).all()


@settings(deadline=None)
@given(seeds, st.lists(st.sets(st.sampled_from(NAMES)).map(frozenset), min_size=1, max_size=6), seeds)
def test_standing_still_changes_nothing(seed, trace, stay):
    formula = _formula(seed)
    automaton = compile_formula(parse(ltlf.text(formula)))
    i = stay % len(trace)
    assert _accepts(automaton, trace) == _accepts(automaton, [*trace[: i + 1], *trace[i:]])


@pytest.mark.long
@settings(deadline=None)
@given(seeds, seeds, st.lists(st.sets(st.sampled_from(NAMES)).map(frozenset), min_size=1, max_size=5))
def test_rules_together_are_all_of_them(one, other, trace):
    formulas = _formula(one), _formula(other)
    both = compile_rules(tuple(Rule(text="", formula=ltlf.text(f)) for f in formulas))
    assert _accepts(both, trace) == all(ltlf.holds(f, trace) for f in formulas)


@pytest.mark.long
@settings(deadline=None)
@given(seeds, st.lists(st.sets(st.sampled_from(NAMES)).map(frozenset), min_size=1, max_size=5))
def test_a_formula_or_its_negation_holds(seed, trace):
    formula = parse(ltlf.text(_formula(seed)))
    assert _accepts(compile_formula(formula), trace) != _accepts(compile_formula(negated(formula)), trace)


@settings(deadline=None)
@given(seeds)
def test_a_formula_written_and_read_again_is_the_same(seed):
    formula = parse(ltlf.text(_formula(seed, depth=4)))
    assert parse(str(formula)) == formula


@settings(deadline=None)
@given(seeds, st.sets(st.sampled_from(NAMES)), st.sets(st.sampled_from(NAMES)), st.integers(0, 3))
def test_what_is_not_known_may_change_at_any_moment(seed, sure, doubtful, length):
    automaton = compile_formula(parse(ltlf.text(_formula(seed))))
    bits = {p.subject: 1 << i for i, p in enumerate(automaton.propositions)}
    yes = sum(bits.get(x, 0) for x in sure)
    may = yes | sum(bits.get(x, 0) for x in doubtful)
    reached = automaton.after(frozenset({0}), yes, may)
    letters = [x for x in range(automaton.following.shape[1]) if x & yes == yes and x & ~may == 0]
    for word in itertools.product(letters, repeat=length + 1) if len(letters) <= 4 else ():
        state = 0
        for letter in word:
            state = int(automaton.following[state, letter])
        assert state in reached


@pytest.mark.long
def test_an_automaton_of_thirty_states_is_made_and_one_beyond_the_bound_refused():
    names = [f"s{i}" for i in range(5)]
    five = compile_formula(parse(" & ".join(f"F at({n})" for n in names)))
    assert five.size == 2**5
    eight = " & ".join(f"F at(s{i})" for i in range(8))
    assert compile_formula(parse(eight)).size == 256 == MAX_STATES
    with pytest.raises(LimitError, match="more than 256 states"):
        compile_formula(parse(f"{eight} & F at(s8)"))
    with pytest.raises(LimitError, match="13 different things"):
        compile_formula(parse(" & ".join(f"G at(s{i})" for i in range(13))))


def _mona(formula):
    """(states, accepting, guards) of MONA's automaton; state 1 is the first."""
    from ltlf2dfa.parser.ltlf import LTLfParser

    def said(f):
        if isinstance(f, str):
            return f
        sign, *parts = f
        return f"({sign}({said(parts[0])}))" if len(parts) == 1 else f"(({said(parts[0])}) {sign} ({said(parts[1])}))"

    dot = LTLfParser()(said(formula)).to_dfa()
    accepting = {int(x) for x in re.search(r"doublecircle\];([^\n]*)", dot)[1].replace(";", " ").split()}
    edges = [(int(a), int(b), g) for a, b, g in re.findall(r"(\d+) -> (\d+) \[label=\"([^\"]*)\"\]", dot)]
    return accepting, edges


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("mona") is None, reason="MONA is not installed")
def test_mona_makes_the_same_automata_of_200_random_formulas():
    pytest.importorskip("ltlf2dfa")
    rng = np.random.default_rng(14)
    for _ in range(200):
        formula = ltlf.drawn(rng, NAMES, 3)
        automaton = compile_formula(parse(ltlf.text(formula)))
        accepting, edges = _mona(formula)
        guards = [(a, b, g.replace("~", " not ").replace("&", " and ").replace("|", " or ")) for a, b, g in edges]
        seen, coming = {(0, 1)}, [(0, 1)]
        while coming:
            ours, theirs = coming.pop()
            for letter in range(automaton.following.shape[1]):
                truths = {p.subject: bool(letter >> i & 1) for i, p in enumerate(automaton.propositions)}
                world = {"true": True, "false": False} | dict.fromkeys(NAMES, False) | truths
                there = next(b for a, b, g in guards if a == theirs and eval(g, {}, world))
                pair = (int(automaton.following[ours, letter]), there)
                assert bool(automaton.accepting[pair[0]]) == (there in accepting), formula
                if pair not in seen:
                    seen.add(pair)
                    coming.append(pair)
        # MONA's may need one state more: it fixes whether the empty trace counts, which no mission is.
        alike = bool(automaton.accepting[0]) == (1 in accepting)
        assert len({a for a, _, _ in edges}) - automaton.size in ((0,) if alike else (0, 1)), formula
