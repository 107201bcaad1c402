"""The measurement of how answers are read: what it counts, and that nothing is taken that was not said."""

from __future__ import annotations

from bench.answer_list import Said, read
from bench.answers import false_orders, false_plain, read_all, safety_table, settled_table, unsaid

from mintpilot.benchmark.intervals import clopper_pearson_upper
from mintpilot.core.reading import AnsweredBy


def said(text: str, says: str, kind: str = "obstacle") -> Said:
    return Said(text=text, kind=kind, lang="en", says=says, style="")


def test_a_false_acceptance_and_a_false_order_are_counted() -> None:
    reads = read_all(
        [said("yes", "none"), said("yes", "yes"), said("stop", "none"), said("the blue one", "none", "target")],
        AnsweredBy.TYPED,
    )
    assert [r.said.text for r in false_plain(reads)] == ["yes"]
    assert [r.said.text for r in false_orders(reads)] == ["stop"]
    assert len(unsaid(reads)) == 3
    assert safety_table(reads).rows[-1][1:3] == ("3", "1")


def test_what_is_settled_at_once_and_after_a_read_back() -> None:
    answers = [said("yes", "yes"), said("yes, harmless, thanks", "yes"), said("banana", "yes"), said("toxic", "no")]
    row = settled_table(read_all(answers, AnsweredBy.TYPED), AnsweredBy.TYPED).rows[0]
    assert row == ("yes or no", "4", "50.0 %", "75.0 %", "3.5 s")


def test_the_exact_bound() -> None:
    assert abs((1 - clopper_pearson_upper(0, 3000)) ** 3000 - 0.05) < 1e-9
    assert (clopper_pearson_upper(0, 0), clopper_pearson_upper(5, 5)) == (1.0, 1.0)
    assert clopper_pearson_upper(1, 100) > clopper_pearson_upper(0, 100)


def test_the_list_is_long_and_nothing_in_it_is_taken_that_was_not_said() -> None:
    answers = read()
    reads = read_all(answers[::7], AnsweredBy.TYPED)
    assert not false_plain(reads)
    assert not false_orders(reads)
    guarded = {"obstacle": {"yes"}, "presence": {"no"}, "target": {"yes", "no"}}
    assert sum(a.says not in guarded[a.kind] for a in answers) >= 3000
