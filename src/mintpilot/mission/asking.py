"""Putting questions: words, the operator's answer, what it teaches; and the account of every gap."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from mintpilot.core.events import Asked, Deliberated, Noticed, Timed
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Ask, Fly, Operator, Recorder
from mintpilot.core.query import Order, Query, Question
from mintpilot.core.tree import Mint, ScoredQuery
from mintpilot.elicitation.wording import word_question
from mintpilot.mission.mind import Mind, Thought, learn
from mintpilot.mission.rewording import Improve, Rewording


class Wording(Protocol):
    """Puts a cut into words. Words never decide meaning: the query goes with them."""

    def __call__(self, query: Query, gaps: Sequence[KnowledgeGap], mint: Mint | None, *, attempt: int = 1) -> Question:
        """The question for a cut; from the second attempt on in other words."""
        ...


@dataclass(slots=True)
class Interview:
    """The conversation of one mission, with what the report needs of it."""

    operator: Operator
    recorder: Recorder
    settings: AskingSettings
    word: Wording = word_question
    improve: Improve | None = None
    """Makes better words while the first ones are shown; None: nobody does."""
    remarks: Callable[[], Sequence[str]] = tuple
    """What went wrong with the words since it was last called, in sentences."""
    firsts: list[Thought] = field(default_factory=list, init=False)
    """Deliberations that knew of gaps nobody had known of before: the figures of the accounts come from them."""
    asked_gaps: list[str] = field(default_factory=list, init=False)
    rounds: int = field(default=0, init=False)
    bounds: list[str] = field(default_factory=list, init=False)
    """What bounds on the work left out, each told once."""

    def deliberated(self, thought: Thought, seconds: float) -> None:
        """Tells the recorder of one deliberation."""
        known = {gap.id for first in self.firsts for gap in first.findings.gaps}
        if {gap.id for gap in thought.findings.gaps} - known:
            self.firsts.append(thought)
        decision = thought.decision
        self.recorder.record(
            Deliberated(
                round=self.rounds,
                gaps=thought.findings.gaps,
                problem=thought.situation.problem,
                mint=decision.mint,
                chosen=decision.scored if isinstance(decision, Ask) else None,
                alternatives=decision.alternatives if isinstance(decision, Ask) else (),
                certificate=decision.certificate if isinstance(decision, Fly) else None,
                seconds=seconds,
                proposed=decision.proposed,
                bound_bits=decision.bound_bits if isinstance(decision, Ask) else None,
            )
        )
        self.rounds += 1
        for note in thought.left_out:
            if note not in self.bounds:
                self.bounds.append(note)
                self.recorder.record(Noticed(kind="bound", text=f"A bound on the work was reached: {note}."))
        self.pass_on_remarks()

    def pass_on_remarks(self) -> None:
        """Tells the recorder and the operator what went wrong with the words: they learn it in the mission's thread."""
        for remark in self.remarks():
            self.recorder.record(Noticed(kind="language", text=remark))
            self.operator.tell(remark)


def put_question(interview: Interview, mind: Mind, ask: Ask) -> tuple[Mind, Order | None]:
    """Asks one question and learns from the answer; a command comes back instead of being learnt from."""
    record = interview.recorder.record
    scored: ScoredQuery = ask.scored
    begun = time.perf_counter()
    attempt = mind.attempts.count(scored.query.id) + 1
    gaps = tuple(g for g in mind.belief.gaps if g.id in scored.query.gap_ids)
    question = interview.word(scored.query, gaps, ask.mint, attempt=attempt)
    wording_s = time.perf_counter() - begun
    record(Timed(stage="wording", seconds=wording_s))
    asked = _put(interview, scored, question, wording_s)
    record(asked)
    answer = asked.answer
    record(Timed(stage="answer", seconds=answer.latency_s))
    interview.pass_on_remarks()
    interview.asked_gaps.extend(scored.query.gap_ids)
    if answer.command is not None:
        return mind, answer.command
    lesson = learn(mind, scored.query, answer, interview.settings)
    if lesson.contradiction:
        record(
            Noticed(
                kind="contradiction",
                text=f"The answer to '{question.text}' goes against an earlier one; it was not taken over.",
            )
        )
    elif lesson.surplus_refused:
        record(
            Noticed(
                kind="contradiction",
                text=f"What was said beyond '{question.text}' goes against what is known; the rest was taken over.",
            )
        )
    return lesson.mind, None


def _put(interview: Interview, scored: ScoredQuery, question: Question, wording_s: float) -> Asked:
    """Shows the question at once; better words follow when they are ready, and only a first attempt gets them."""
    operator, patience_s = interview.operator, interview.settings.patience_s
    if interview.improve is None or question.attempt > 1:
        answer = operator.ask(question, patience_s)
        return Asked(question=question, scored=scored, answer=answer, wording_s=wording_s)
    better = Rewording(interview.improve, question)
    answer = operator.ask(question, patience_s, better)
    shown = better.wait(0.0) if answer.better_s is not None else None
    if shown is None or answer.better_s is None:
        return Asked(question=question, scored=scored, answer=answer, wording_s=wording_s)
    return Asked(
        question=shown,
        scored=scored,
        answer=answer,
        wording_s=wording_s,
        first_text=question.text,
        better_s=wording_s + answer.better_s,
    )
