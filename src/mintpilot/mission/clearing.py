"""Go or no-go: before take-off the mission as it was understood is shown, and flown only after an explicit yes."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from mintpilot.core.briefing import Briefing
from mintpilot.core.inputs import Answered, Link, LinkChanged, Ordered
from mintpilot.core.message import Message, joined, message, verbatim
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Order, Reply, Standing
from mintpilot.core.tree import ScoredQuery
from mintpilot.mission.directives import ShowQuestion
from mintpilot.mission.ordering import LINKS
from mintpilot.mission.state import OpenQuestion
from mintpilot.mission.transition import Transition

BRIEFING_S: Final = 180.0
"""A briefing is waited for so long, seconds: it is read in peace, on the ground."""
NEEDED: Final = (Link.CAMERA, Link.POSITION, Link.TELEMETRY)
"""Without these nothing takes off."""
MAX_READ_BACKS: Final = 2
"""A yes that was read back so often and never confirmed is no yes."""


def brief(t: Transition, briefing: Briefing) -> None:
    """Shows the briefing; nothing moves until it was answered with yes."""
    question = replace(briefing.question, id=f"q{t.next_id()}")
    for line in briefing.lines:
        t.tell(line)
    unscored = ScoredQuery(query=question.query, score=0.0, gain_bits=0.0, regret_saved_s=0.0, reply_probabilities=())
    t.set(
        grounded=True,
        question=OpenQuestion(
            question=question,
            scored=unscored,
            asked_s=t.state.clock_s,
            patient_until_s=t.state.clock_s + BRIEFING_S,
        ),
    )
    t.give(ShowQuestion(question=question, patience_s=BRIEFING_S))


def answered(t: Transition, event: Answered) -> None:
    """Takes off after an explicit yes; anything else that was said leaves the drone on the ground."""
    open_ = t.state.question
    if open_ is None or event.question != open_.question.id:
        return
    answer, pending = event.answer, open_.question.read_back
    if answer.reply is not Reply.YES:
        _stay(t, message("The operator did not say go."))
        return
    confirmed = answer.standing is Standing.CONFIRMED and pending is not None and pending.reply is Reply.YES
    plain = answer.standing is Standing.PLAIN and answer.by != "voice" and answer.understood_by != "model"
    if confirmed or plain:
        who = event.operator
        t.note("go", message("{who} said go.", who=who) if who else message("The operator said go."))
        t.withdraw(message("it was answered"))
        t.set(grounded=False)
        t.climb()
    elif open_.read_backs >= MAX_READ_BACKS:
        _stay(t, message("No go was confirmed."))
    else:
        read_back = replace(open_.question, read_back=replace(answer, standing=Standing.UNCONFIRMED))
        t.set(question=replace(open_, question=read_back, read_backs=open_.read_backs + 1))
        t.give(ShowQuestion(question=read_back, patience_s=max(0.0, open_.deadline_s - t.state.clock_s)))


def ordered(t: Transition, event: Ordered) -> None:
    """On the ground every order but to wait ends the mission there."""
    if event.order in (Order.HOLD, Order.CONTINUE):
        t.tell(message("I stand on the ground and wait for your yes."))
    else:
        _stay(t, message("The operator called the mission off."))


def link_lost(t: Transition, event: LinkChanged) -> None:
    """What is missing before take-off is no reason to fly."""
    lost = message("The {link} was lost before take-off.", link=LINKS[event.link])
    _stay(t, joined([lost, verbatim(f"({event.reason})" if event.reason else "")]))


def unanswered(t: Transition) -> None:
    """Silence is no go."""
    _stay(t, message("No go was given in time."))


def _stay(t: Transition, why: Message) -> None:
    t.tell(joined([why, message("I stay on the ground.")]))
    t.finish(Outcome.ABORTED, joined([why, message("The drone stayed on the ground.")]))
