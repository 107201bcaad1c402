"""Whether rules can be kept at all, and which of them contradict each other."""

from __future__ import annotations

from collections.abc import Sequence

from mintpilot.core.rule import Automaton, Rule
from mintpilot.rules.compiling import compile_formula, together
from mintpilot.rules.formula import negated
from mintpilot.rules.parsing import parse


def can_be_kept(automaton: Automaton) -> bool:
    """Whether a mission of at least one moment exists that is accepted."""
    return bool(automaton.alive[automaton.following[0]].any())


def conflicting(rules: Sequence[Rule]) -> tuple[Rule, ...]:
    """Rules that no mission whatever can keep together, none of which can be left out; empty where all can be kept."""
    automata = [compile_formula(parse(rule.formula)) for rule in rules]
    kept = list(range(len(rules)))
    if can_be_kept(together(automata)):
        return ()
    for i in range(len(rules)):
        rest = [k for k in kept if k != i]
        if not can_be_kept(together([automata[k] for k in rest])):
            kept = rest
    return tuple(rules[k] for k in kept)


def is_trivial(rule: Rule) -> bool:
    """Whether every mission keeps the rule: it says nothing."""
    return not can_be_kept(compile_formula(negated(parse(rule.formula))))
