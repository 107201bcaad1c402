"""Questions and answers: putting one, learning from what comes back, late and second answers (method, section 5)."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.decisions import AskQuestion, Reasoning
from mintpilot.core.inputs import Answered, MoreTimeWanted, QuestionReworded, QuestionShown
from mintpilot.core.message import message
from mintpilot.core.query import Answer, Query, Reply, Standing
from mintpilot.mission import meanwhile
from mintpilot.mission.belief_state import BeliefState, confirmed_by, update
from mintpilot.mission.deliberation import settle
from mintpilot.mission.directives import ShowQuestion
from mintpilot.mission.grants import granted, reopened
from mintpilot.mission.permissions import enlarges, permissions, revoke
from mintpilot.mission.state import Activity, Goal, OpenQuestion
from mintpilot.mission.transition import Transition

MAX_READ_BACKS = 2
"""An answer that was read back so often and never confirmed counts as "I don't know"."""


def take_over(t: Transition, reasoning: Reasoning) -> None:
    """Takes over what a deliberation has found: the belief over the gaps, what is settled, and the explanations."""
    beliefs = replace(t.beliefs, map=settle(t.beliefs.map, reasoning), belief=reasoning.belief)
    known = {explanation.gap_id for explanation in t.state.explanations}
    fresh = tuple(e for e in reasoning.explanations if e.gap_id not in known)
    t.set(
        beliefs=beliefs,
        explanations=(*t.state.explanations, *fresh),
        fallback=reasoning.cautious or t.state.fallback,
    )
    for bound in reasoning.left_out:
        if bound not in t.state.notes:
            t.set(notes=t.state.notes | {bound})
            t.note("bound", message("A bound on the work was reached: {bound}.", bound=bound))


def put(t: Transition, decision: AskQuestion, begun_s: float) -> None:
    """Puts the question; its deadline runs from when it is shown.

    Args:
        t: the step in the making.
        decision: the question.
        begun_s: when it began to be thought of: the battery has run since, mission clock.
    """
    question = replace(decision.question, id=f"q{t.next_id()}")
    patient_until_s = t.state.clock_s + t.state.setup.mission.asking.patience_s
    needed_s = begun_s + decision.waits_s
    patience_s = max(0.0, min(patient_until_s, needed_s) - t.state.clock_s)
    t.set(
        question=OpenQuestion(
            question=question,
            scored=decision.scored,
            asked_s=t.state.clock_s,
            shown_map=t.beliefs.map,
            patient_until_s=patient_until_s,
            needed_s=needed_s,
            prospects=decision.prospects,
            thought_s=begun_s,
        ),
        asked_gaps=t.state.asked_gaps | set(question.query.gap_ids),
        activity=Activity.NONE,
    )
    t.give(ShowQuestion(question=question, patience_s=patience_s))
    meanwhile.prepare(t)


def shown(t: Transition, event: QuestionShown) -> None:
    """Somebody has the question in front of them."""
    open_ = t.state.question
    if open_ is not None and open_.question.id == event.question and open_.shown_s is None:
        until_s = event.time_s + (open_.patient_until_s - open_.asked_s)
        t.set(question=replace(open_, shown_s=event.time_s, patient_until_s=until_s))


def reworded(t: Transition, event: QuestionReworded) -> None:
    """Shows better words for the open question; query, gaps and consequences stay."""
    open_ = t.state.question
    if open_ is None or open_.question.id != event.question or open_.question.text == event.text:
        return
    if t.state.grounded:
        return  # a briefing says what was understood, in the words of the steps
    question = replace(open_.question, text=event.text, worded_by=event.worded_by)
    first = open_.first_text or open_.question.text
    t.set(question=replace(open_, question=question, first_text=first, reworded_s=event.seconds))
    t.give(ShowQuestion(question=question, patience_s=max(0.0, open_.deadline_s - t.state.clock_s)))


def answered(t: Transition, event: Answered) -> None:
    """Learns from an answer to the open question; late ones count only where they add caution (method, section 8)."""
    open_ = t.state.question
    if open_ is None or open_.question.id != event.question:
        _late(t, event)
        return
    answer, pending = event.answer, open_.question.read_back
    if answer.standing is Standing.CONFIRMED and pending is not None and pending.part == answer.part:
        answer = replace(pending, standing=Standing.CONFIRMED, latency_s=answer.latency_s)
    elif _must_be_read_back(t, open_.question.query, answer):
        if open_.read_backs >= MAX_READ_BACKS:
            _learn(t, open_, replace(answer, reply=Reply.UNSURE, option=None))
            meanwhile.over(t, open_, Reply.UNSURE)
            t.withdraw(message("no answer was confirmed"))
            return
        read_back = replace(open_.question, read_back=replace(answer, standing=Standing.UNCONFIRMED))
        t.set(question=replace(open_, question=read_back, read_backs=open_.read_backs + 1))
        t.give(ShowQuestion(question=read_back, patience_s=max(0.0, open_.deadline_s - t.state.clock_s)))
        return
    _learn(t, open_, answer)
    meanwhile.over(t, open_, answer.reply)
    t.withdraw(message("it was answered"))


def more_time(t: Transition, event: MoreTimeWanted) -> None:
    """Waits for the answer once more as long, once for each question."""
    open_ = t.state.question
    if open_ is None or open_.question.id != event.question:
        return
    if open_.extended:
        t.tell(message("I cannot wait any longer than that."))
        return
    longer = replace(
        open_, extended=True, patient_until_s=open_.patient_until_s + t.state.setup.mission.asking.patience_s
    )
    more_s = longer.deadline_s - open_.deadline_s
    t.set(question=longer)
    if more_s > 0:
        t.tell(message("I wait {more_s:.0f} s more.", more_s=more_s))
    else:
        t.tell(message("I cannot wait longer: the battery does not allow it."))


def unanswered(t: Transition) -> None:
    """The deadline has passed: the way that is safe whatever holds."""
    open_ = t.state.question
    assert open_ is not None
    _learn(t, open_, Answer(reply=Reply.TIMEOUT, latency_s=_waited_s(t, open_)))
    meanwhile.over(t, open_, Reply.TIMEOUT)
    t.withdraw(message("no answer came in time"))
    t.note("silence", message("No answer came: the drone takes the way that is safe whatever holds."))


def somebody_spoke(t: Transition) -> None:
    """Silence is over."""
    if t.state.beliefs is not None and t.state.beliefs.silent:
        t.set(beliefs=replace(t.state.beliefs, silent=False))


def _must_be_read_back(t: Transition, query: Query, answer: Answer) -> bool:
    """Whether an answer takes caution away and is not plain enough for that (method, section 12)."""
    if answer.part is None:
        return False
    is_plain = answer.standing is Standing.PLAIN and answer.by != "voice" and answer.understood_by != "model"
    settings = t.state.setup.mission.asking
    if is_plain and not answer.also:
        return False
    return enlarges(t.beliefs, update(t.beliefs, query, answer, settings).state, settings)


def check_permissions(t: Transition) -> None:
    """Reopens what was permitted too long ago, or for something smaller; a flight that counts on it is broken off."""
    before, settings = t.beliefs, t.state.setup.mission.asking
    after = reopened(before, settings, t.state.clock_s, known=t.state.known_passable)
    if after is before:
        return
    t.set(beliefs=after, fallback=None)
    lost = permissions(before, settings).enter - permissions(after, settings).enter
    if lost:
        again = message("What was permitted is too long ago, or has changed since: it is asked about again.")
        t.note("permission", again)
        if t.state.goal is Goal.TASK:
            t.withdraw(message("what was permitted has changed"))
            t.set(request=None)
        t.brake()


def _waited_s(t: Transition, open_: OpenQuestion) -> float:
    begun_s = open_.asked_s if open_.shown_s is None else open_.shown_s
    return max(0.0, t.state.clock_s - begun_s)


def _learn(t: Transition, open_: OpenQuestion, answer: Answer) -> None:
    query, text, before = open_.question.query, open_.question.text, t.beliefs
    result = update(before, query, answer, t.state.setup.mission.asking)
    after = result.state
    if answer.part is not None and open_.shown_map is not None and not result.contradiction:
        yes = confirmed_by(query, answer.part, before.belief.gaps)
        after = granted(after, yes, open_.shown_map, t.state.clock_s)
    t.set(beliefs=after, learnt=answer)
    check_permissions(t)
    if result.contradiction:
        against = message(
            "The answer to '{question}' goes against an earlier one; it was not taken over.", question=text
        )
        t.note("contradiction", against)
    elif result.extra_refused:
        beyond = message(
            "What was said beyond '{question}' goes against what is known; the rest was taken over.", question=text
        )
        t.note("contradiction", beyond)


def _late(t: Transition, event: Answered) -> None:
    """An answer to a question that is no longer open: it counts where it adds caution, and is kept for the report."""
    query = dict(t.state.earlier).get(event.question)
    said = event.answer.text or event.answer.reply.value
    if query is None or t.state.beliefs is None or event.answer.part is None:
        t.note("late-answer", message("'{said}' came when nothing was asked; it changed nothing.", said=said))
        return
    before, settings = t.beliefs, t.state.setup.mission.asking
    after, against = _after_late(before, query, event.answer, event.answer.part, t)
    if enlarges(before, after, settings):
        freeing = message("'{said}' came too late; it would have taken caution away, and was ignored.", said=said)
        t.note("late-answer", freeing)
        return
    is_same = permissions(after, settings) == permissions(before, settings)
    if against and is_same:
        contrary = message("'{said}' came too late; it goes against what was said before, and was ignored.", said=said)
        t.note("late-answer", contrary)
        return
    t.set(beliefs=replace(after, silent=False))
    if is_same:
        t.note("late-answer", message("'{said}' came late and was taken over.", said=said))
        return
    careful = message("'{said}' came late; it adds caution: the drone stops and deliberates again.", said=said)
    t.note("late-answer", careful)
    t.tell(message("I take that back: I stop and think again."))
    t.withdraw(message("an earlier answer was taken back"))
    t.set(request=None)
    if t.state.goal is Goal.TASK:
        t.brake()


def _after_late(
    before: BeliefState, query: Query, answer: Answer, part: int, t: Transition
) -> tuple[BeliefState, bool]:
    """What a late answer would make of the beliefs, and whether it goes against them: then all it spoke of is open."""
    settings = t.state.setup.mission.asking
    result = update(before, query, answer, settings)
    held = {gap.id for gap in before.belief.gaps}
    if not result.contradiction and set(query.gap_ids) <= held:
        return result.state, False
    return revoke(before, query, part), result.contradiction
