"""Putting questions: words, the operator's answer, what it teaches; and the account of every gap."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from mintpilot.core.events import Asked, Deliberated, Noticed, Timed
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Ask, Fly, Operator, Recorder
from mintpilot.core.query import Command, Query, Question
from mintpilot.core.tree import Mint, ScoredQuery
from mintpilot.elicitation.wording import word_question
from mintpilot.mission.mind import Mind, Thought, learn


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
            )
        )
        self.rounds += 1
        for note in thought.left_out:
            if note not in self.bounds:
                self.bounds.append(note)
                self.recorder.record(Noticed(kind="bound", text=f"A bound on the work was reached: {note}."))


def put_question(interview: Interview, mind: Mind, ask: Ask) -> tuple[Mind, Command | None]:
    """Asks one question and learns from the answer; a command comes back instead of being learnt from."""
    record = interview.recorder.record
    scored: ScoredQuery = ask.scored
    begun = time.perf_counter()
    attempt = mind.attempts.count(scored.query.id) + 1
    gaps = tuple(g for g in mind.belief.gaps if g.id in scored.query.gap_ids)
    question = interview.word(scored.query, gaps, ask.mint, attempt=attempt)
    wording_s = time.perf_counter() - begun
    record(Timed(stage="wording", seconds=wording_s))
    answer = interview.operator.ask(question, interview.settings.patience_s)
    record(Asked(question=question, scored=scored, answer=answer, wording_s=wording_s))
    record(Timed(stage="answer", seconds=answer.latency_s))
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
    return lesson.mind, None
