"""What is done while a question is open, and how much of the person's delay it hides (method, section 10)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.decisions import AskQuestion, FlyPlan, Meanwhile
from mintpilot.core.gap import Assumptions, Belief
from mintpilot.core.mission import Waiting, WhileWaiting
from mintpilot.core.plan import Plan
from mintpilot.core.query import Reply
from mintpilot.mission.flying import mark_done
from mintpilot.mission.requests import Purpose
from mintpilot.mission.state import Activity, Goal, OpenQuestion, QuestionOver
from mintpilot.mission.transition import Transition
from mintpilot.planning.meanwhile import Wait
from mintpilot.reasoning.tables import box

BEGINS_S = 0.05
"""The drone sets out so long after a question was put, seconds: who answers at once is not flown away from."""


def prepare(t: Transition) -> None:
    """A question was put: what to do meanwhile is thought about in a moment."""
    open_ = t.state.question
    moves = t.state.setup.mission.asking.while_waiting is WhileWaiting.MOVE and t.state.goal is Goal.TASK
    if open_ is not None and moves and any(p.probability > 0 for p in open_.prospects):
        t.set(question=replace(open_, moves_s=t.state.clock_s + BEGINS_S))


def consider(t: Transition) -> None:
    """At rest, with a question open: has it worked out what to do, when it is time to."""
    state, open_ = t.state, t.state.question
    busy = state.motion is not None or state.request is not None or state.activity is not Activity.NONE
    if open_ is None or busy or state.clock_s < open_.moves_s or state.goal is not Goal.TASK:
        return
    wait = Wait(
        prospects=open_.prospects,
        asked_s=open_.thought_s,
        until_s=open_.patient_until_s,
        now_s=state.clock_s,
        finished=t.beliefs.finished,
    )
    t.request(Purpose.MEANWHILE, wait=wait)


def decided(t: Transition, decision: Meanwhile | None) -> None:
    """Sets out, or holds until holding would lose the next plan."""
    open_ = t.state.question
    assert open_ is not None, "the request ends with the question"
    if decision is not None and decision.stop is not None:
        t.set(acting=decision.stop)
        t.act(decision.stop, Activity.ACT_MEANWHILE)
    elif decision is not None and decision.trajectory is not None:
        needed_s = open_.needed_s if decision.needed_s is None else decision.needed_s
        t.set(question=replace(open_, needed_s=needed_s))
        t.follow(decision.trajectory, Activity.MEANWHILE, decision.trajectory.position_m[::10])
    else:
        lost_s = [open_.thought_s + p.spare_s for p in open_.prospects if p.probability > 0]
        later = [s + BEGINS_S for s in lost_s if s > t.state.clock_s] if decision is not None else []
        t.set(question=replace(open_, moves_s=min(later, default=float("inf"))))


def arrived(t: Transition, *, held: bool) -> None:
    """At the end of a flight: what is next is thought about at once; nothing where something was in the way."""
    open_ = t.state.question
    assert open_ is not None, "a flight that was broken off with its question ends elsewhere"
    t.set(question=replace(open_, moves_s=float("inf") if held else t.state.clock_s))


def looked(t: Transition) -> None:
    """The stop is done and looked around from."""
    assert t.state.acting is not None, "it was begun"
    mark_done(t, t.state.acting)
    t.set(acting=None)
    if t.state.question is not None:
        arrived(t, held=False)


def over(t: Transition, open_: OpenQuestion, reply: Reply) -> None:
    """A question is over: keeps what the rest would have cost from where it was asked."""
    begun_s = open_.asked_s if open_.shown_s is None else open_.shown_s
    silent = [p for p in open_.prospects if p.probability == 0]
    delay_s = max(0.0, t.state.clock_s - begun_s)
    t.set(waiting=replace(t.state.waiting, delay_s=t.state.waiting.delay_s + delay_s), over=None)
    if reply is Reply.TIMEOUT:
        weights = {id(p): 1.0 for p in silent}
    else:
        weights = {id(p): mass_of(p.given, t.beliefs.belief) for p in open_.prospects if p.probability > 0}
    total = sum(weights.values())
    if total > 0:
        average = [sum(weights.get(id(p), 0.0) * s for p, s in zip(open_.prospects, kind, strict=True)) / total
                   for kind in ([p.plan.cost_s for p in open_.prospects],
                                [p.plan.undone_s for p in open_.prospects])]  # fmt: skip
        kept = QuestionOver(expected_s=average[0], undone_s=average[1], at_s=t.state.clock_s, delay_s=delay_s)
        t.set(over=kept)


def count(t: Transition, decision: AskQuestion | FlyPlan) -> None:
    """After the next deliberation: by so much less than from where it was asked the rest costs now."""
    was = t.state.over
    t.set(over=None)
    plans: list[tuple[float, Plan | None]]
    plans = [(1.0, decision.plan)] if isinstance(decision, FlyPlan) else _classes(decision)
    if was is None or not plans or any(plan is None for _, plan in plans):
        return
    total = sum(weight for weight, _ in plans)
    cost_s = sum(weight * plan.cost_s for weight, plan in plans if plan is not None) / total
    undone_s = sum(weight * plan.undone_s for weight, plan in plans if plan is not None) / total
    if abs(undone_s - was.undone_s) > 1e-6:
        return  # not the same is done any more: the costs do not compare
    hidden_s = was.expected_s - cost_s - (t.state.clock_s - was.at_s)
    hidden_s = min(was.delay_s, hidden_s)
    t.set(waiting=Waiting(delay_s=t.state.waiting.delay_s, hidden_s=t.state.waiting.hidden_s + hidden_s))


def mass_of(given: tuple[Assumptions, ...], belief: Belief) -> float:
    """Probability that one of these assumptions, which exclude each other, holds."""
    total = 0.0
    for one in given:
        parts = [float(f.probability[np.ix_(*box(f, one))].sum()) for f in belief.factors]
        total += float(np.prod(parts))
    return total


def _classes(decision: AskQuestion) -> list[tuple[float, Plan | None]]:
    mint = decision.reasoning.mint
    return [] if mint is None else [(one.probability, one.plan) for one in mint.classes]
