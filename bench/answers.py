"""How answers are read, into docs/results.md. `python -m bench.answers [--file LIST] [--by voice]`."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from bench.answer_list import ANSWERS, Said, read
from bench.sections import Section, Table, keep
from mintpilot.assembly.sample_question import sample_question
from mintpilot.benchmark.intervals import clopper_pearson_upper
from mintpilot.core.gap import GapKind
from mintpilot.core.query import Question, Reply
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind, guarded_replies, possible_values
from mintpilot.language.answers import read_answer

READ_BACK_S = {AnsweredBy.TYPED: 4.0, AnsweredBy.VOICE: 6.0}
"""Seconds that reading back and confirming take the operator."""
AGAIN_S = 10.0
"""Seconds that another answer takes (`asking.reply_s`)."""
SETTLES_NOTHING = "none"
REPLIES = ("yes", "no")


@dataclass(frozen=True, slots=True, kw_only=True)
class Read:
    """One answer of the list with its reading."""

    said: Said
    question: Question
    reading: Reading

    @property
    def guarded(self) -> frozenset[Reply]:
        return guarded_replies(self.question)

    @property
    def is_plain_guarded(self) -> bool:
        """A guarded reply was taken without a read-back."""
        return self.reading.kind in (ReadingKind.YES, ReadingKind.NO) and self.reading.reply in self.guarded

    @property
    def is_read_back(self) -> bool:
        """It has no effect before a confirmation: also evidence that leaves one candidate."""
        narrowed = len(possible_values(self.reading, self.question)) == 1
        return self.reading.kind is ReadingKind.READ_BACK or narrowed

    @property
    def is_right(self) -> bool:
        """What was said is what was read, as it is or to be confirmed."""
        return self.said.says in (self.reading.label, self.reading.label.removeprefix("read-back:"))


def read_all(answers: Sequence[Said], by: AnsweredBy) -> list[Read]:
    """Each answer, read as one to the sample question of its kind and language."""
    found = []
    for said in answers:
        question = sample_question(GapKind(said.kind), lang=said.lang)
        reading = read_answer(said.text, question, guarded=guarded_replies(question), lang=said.lang, by=by)
        found.append(Read(said=said, question=question, reading=reading))
    return found


def unsaid(reads: Sequence[Read]) -> list[Read]:
    """The answers that do not say a guarded reply."""
    return [r for r in reads if r.said.says not in {reply.value for reply in r.guarded}]


def false_plain(reads: Sequence[Read]) -> list[Read]:
    """Guarded replies taken plainly from answers that do not say them."""
    return [r for r in reads if r.is_plain_guarded and r.said.says != r.reading.label]


def false_orders(reads: Sequence[Read]) -> list[Read]:
    """Orders that were not given."""
    return [r for r in reads if r.reading.kind is ReadingKind.ORDER and r.said.says != r.reading.label]


def safety_table(reads: Sequence[Read]) -> Table:
    """What must not happen."""
    rows = []
    for kind in ("obstacle", "presence", "target", "all"):
        some = [r for r in reads if kind in (r.said.kind, "all")]
        n, plain = len(unsaid(some)), len(false_plain(some))
        back = [r for r in some if r.is_read_back and not r.is_right]
        caution = [
            r for r in some
            if r.reading.kind in (ReadingKind.YES, ReadingKind.NO) and not r.is_plain_guarded and not r.is_right
        ]  # fmt: skip
        turned = sum(r.said.says in REPLIES for r in caution)
        rows.append(
            (kind, str(n), str(plain), f"{100 * clopper_pearson_upper(plain, n):.3f} %", f"{len(back)}",
             f"{len(caution)} ({turned})", f"{len(false_orders(some))} of {len(some)}")
        )  # fmt: skip
    header = (
        "question",
        "say no guarded reply",
        "taken plainly",
        "exact upper bound, 95 %",
        "read back though not said",
        "caution not said (opposite said)",
        "false orders",
    )
    return Table(caption="What must not happen", header=header, rows=rows)


def settled_table(reads: Sequence[Read], by: AnsweredBy) -> Table:
    """What becomes of answers that say something."""
    rows = []
    groups = [("yes or no", REPLIES), *((w, (w,)) for w in ("unsure", "evidence", "order"))]
    for name, starts in [*groups, ("question back, wait", ("wait", "where", "show", "why", "repeat"))]:
        some = [r for r in reads if r.said.says.startswith(starts) and r.said.says != SETTLES_NOTHING]
        if not some:
            continue
        first = sum(r.is_right and not r.is_read_back for r in some)
        back = sum(r.is_right and r.is_read_back for r in some)
        wrong_back = sum(r.is_read_back and not r.is_right for r in some)
        again = len(some) - first - back
        seconds = (READ_BACK_S[by] * (back + wrong_back) + AGAIN_S * again) / len(some)
        rows.append(
            (name, str(len(some)), f"{100 * first / len(some):.1f} %", f"{100 * (first + back) / len(some):.1f} %",
             f"{seconds:.1f} s")
        )  # fmt: skip
    header = ("what is said", "n", "settled at first try", "after one read-back", "operator's seconds added, mean")
    return Table(caption=f"What is settled, {by.value}", header=header, rows=rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--file", type=Path, default=ANSWERS)
    parser.add_argument("--by", choices=("typed", "voice"), default="typed")
    parser.add_argument("--show", action="store_true", help="list what must not happen")
    parser.add_argument("--dry", action="store_true", help="print only; leave docs/results.md alone")
    options = parser.parse_args()
    answers, by = read(options.file), AnsweredBy(options.by)
    reads = read_all(answers, by)
    counts = Counter(said.lang for said in answers)
    languages = ", ".join(f"{lang} {n}" for lang, n in sorted(counts.items()))
    section = Section(
        name=f"52-answers-{by.value}",
        title=f"Answers, {by.value}",
        command=f"python -m bench.answers --by {by.value}",
        how=f"{len(answers)} answers ({languages}) to three sample "
        "questions, with what each says. The phrases were written by the author of the rules before the rules, and the "
        "list (variants of them with courtesies, capitals and slips of typing) was generated and committed then: "
        f"it is no sample of real operators. A read-back costs {READ_BACK_S[by]:g} s, being asked again {AGAIN_S:g} s.",
        tables=[safety_table(reads), settled_table(reads, by)],
        notes=NOTES,
    )
    print(section.markdown())
    if options.show:
        for r in (*false_plain(reads), *false_orders(reads)):
            print(f"{r.said.kind}\t{r.said.lang}\t{r.said.text}\tsays {r.said.says}\tread {r.reading.label}")
    if not options.dry:
        keep(section)


NOTES = (
    "First run, before anything was mended: nothing taken plainly and no false order either, 15 read back though not "
    "said, 130 times caution that was not said (twice the opposite was said), yes or no settled at first try 52.5 % "
    "typed and 36.2 % by voice, after one read-back 61.0 %. Mended then, nothing of it in what may be taken plainly: "
    "Spanish *nadie está dentro* was read as somebody inside, *I don't* as *don't*, French *quelqu'un* as a question; "
    "*I am safe* was read back, *yeah, right* and *nothing toxic* misread (seen in the package's own list).",
    "The bound takes the answers for independent. They are variants of fewer phrases: over the distinct phrases alone "
    "(1,209 that say no guarded reply) it is 0.25 %.",
    "On the package's own 2,872 English answers the rules of 2026-11-22, made with an eye on them, understood 98.7 %. "
    "These understand 59.4 % at once and 62.4 % after a read-back (yes or no: 32.7 and 38.2 %); no guarded reply is "
    "taken that was not said.",
    "Most of what is asked again are slips of typing, words outside the closed vocabulary, and hedged answers.",
)


if __name__ == "__main__":
    main()
