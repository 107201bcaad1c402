"""Orders and links: what the drone does when somebody says so, and when nobody can be heard or nothing be seen."""

from __future__ import annotations

from mintpilot.core.inputs import Link, LinkChanged, Ordered
from mintpilot.core.message import Message, joined, message, verbatim
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Order
from mintpilot.mission.requests import Purpose
from mintpilot.mission.state import Activity, Ending, Goal
from mintpilot.mission.transition import Transition

RESERVE_S = 10.0
"""While it holds, the drone returns when no more flight time is left than the way back and this, seconds."""
LONGEST_HOLD_S = 1800.0
"""It holds no longer than this, whatever the battery says, seconds."""
BLIND_S = 5.0
"""Without a camera it returns after this time, without a position it lands, seconds."""
SEEN_FREE_S = 60.0
"""Space that was seen free counts as free for so long once the camera is gone, seconds."""

AWAITING_MAP = (Activity.FIRST_LOOK, Activity.SWEPT, Activity.ACTED, Activity.ACTED_MEANWHILE)
"""What waits for a new map, which does not come without a camera."""

LINKS = {
    Link.OPERATOR: message("link to the operator"),
    Link.CAMERA: message("camera picture"),
    Link.TELEMETRY: message("link to the vehicle"),
    Link.CONTROL: message("control of the vehicle"),
    Link.POSITION: message("position fix"),
    Link.MODEL: message("language model"),
}
"""What each link is called, without an article."""
_ANSWERS = {
    Order.HOLD: message("I brake and hold here. Say 'continue' to go on."),
    Order.CONTINUE: message("I go on: I think again from here."),
    Order.RETURN: message("I fly back to the start by the way that is known to be free."),
    Order.LAND: message("I land here, or at the nearest place where the ground is known to be free."),
    Order.ABORT: message("I brake and ask nothing more. I land here if the ground is free, else I fly back and land."),
}


def ordered(t: Transition, event: Ordered) -> None:
    """Obeys: the order decides the next motion."""
    match event.order:
        case Order.CONTINUE:
            _continue(t)
        case Order.HOLD:
            t.tell(_ANSWERS[Order.HOLD])
            _hold(t, None)
        case Order.RETURN:
            t.tell(_ANSWERS[Order.RETURN])
            _leave(t, Goal.RETURN, message("The operator called the drone back."))
        case Order.LAND:
            t.tell(_ANSWERS[Order.LAND])
            _leave(t, Goal.LAND, message("The operator ordered the drone to land."))
        case Order.ABORT:
            t.tell(_ANSWERS[Order.ABORT])
            _leave(t, Goal.LAND, message("The operator broke the mission off."))
            t.set(land_here=True, lands=True)


def link_changed(t: Transition, event: LinkChanged) -> None:
    """Does what is safe without the link, and goes on when it is back."""
    link, was_down = event.link, t.state.is_down(event.link)
    if event.up == (not was_down):
        return
    others = tuple(item for item in t.state.links_down if item[0] is not link)
    t.set(links_down=others if event.up else (*others, (link, t.state.clock_s)))
    back, lost = message("The {link} is back", link=LINKS[link]), message("The {link} is lost", link=LINKS[link])
    why = verbatim(f" ({event.reason})" if event.reason else "")
    t.note("link", message("{what}{why}.", what=back if event.up else lost, why=why))
    if event.up:
        if t.state.held_for is link and t.state.goal is Goal.HOLD:
            _resume(t)
        return
    match link:
        case Link.TELEMETRY:
            lost = message("The link to the vehicle is lost: it is in its fail-safe.")
            t.finish(Outcome.VEHICLE_FAILED, verbatim(event.reason) or lost)
        case Link.CONTROL:
            why = verbatim(event.reason) or message("somebody else has taken over")
            t.tell(message("I am not flying any more: {why}.", why=why))
            taken = message("Somebody else has taken the vehicle over.")
            t.finish(Outcome.ABORTED, verbatim(event.reason) or taken)
        case Link.CAMERA if t.state.activity in AWAITING_MAP and t.state.motion is None:
            t.set(activity=Activity.NONE)
            _blind(t, link)
        case Link.CAMERA | Link.POSITION if t.state.goal in (Goal.SURVEY, Goal.TASK) or link is Link.POSITION:
            _blind(t, link)
        case Link.MODEL:
            t.tell(message("The language model is gone: I go on with words of my own."))
        case _:
            pass


def wait_for_hand(t: Transition, what: Message) -> None:
    """A person has to do what the vehicle cannot: holds until they say that it is done."""
    t.tell(message("{what}, then say 'continue'.", what=what))
    _hold(t, None)


def pass_time(t: Transition) -> None:
    """What passing time alone decides: holding ends before the battery does, and blindness ends in the safe state."""
    state = t.state
    blind_s = max((state.clock_s - since for link, since in state.links_down if link is Link.CAMERA), default=0.0)
    if state.goal is Goal.RETURN and blind_s > SEEN_FREE_S:
        t.redirect(Goal.LAND)
        return
    if state.goal is not Goal.HOLD or state.held_since_s is None:
        return
    held_s = state.clock_s - state.held_since_s
    if state.held_for is Link.CAMERA and held_s >= BLIND_S:
        _end_hold(t, Goal.RETURN, Outcome.NO_SAFE_PLAN, message("The camera is gone."))
    elif state.held_for is Link.POSITION and held_s >= BLIND_S:
        _end_hold(t, Goal.LAND, Outcome.NO_SAFE_PLAN, message("The position is not known."))
    elif held_s >= LONGEST_HOLD_S:
        held = message("It held for {held_s:.0f} s and nobody said 'continue'.", held_s=held_s)
        _end_hold(t, Goal.RETURN, Outcome.ABORTED, held)
    elif state.endurance_s() <= (state.home_s or 0.0) + RESERVE_S:
        _end_hold(t, Goal.RETURN, Outcome.ABORTED, message("It held until the battery was needed for the way back."))


def begin_hold(t: Transition) -> None:
    """At rest, holding: has the way back worked out, to know until when the battery lasts."""
    if t.state.home_s is None and t.state.request is None and t.state.beliefs is not None:
        t.request(Purpose.RETURN)


def _blind(t: Transition, link: Link) -> None:
    if link is Link.CAMERA:
        t.tell(message("I see nothing: I brake and hold."))
    else:
        t.tell(message("I do not know where I am: I brake and hold."))
    _hold(t, link)


def _hold(t: Transition, link: Link | None) -> None:
    if t.state.goal in (Goal.SURVEY, Goal.TASK):
        t.set(resume=t.state.goal)
    t.redirect(Goal.HOLD)
    t.set(held_since_s=t.state.clock_s, held_for=link, home_s=None)


def _leave(t: Transition, goal: Goal, reason: Message) -> None:
    if t.state.goal in (Goal.SURVEY, Goal.TASK):
        t.set(resume=t.state.goal)
    t.set(ending=Ending(outcome=Outcome.ABORTED, reason=reason), lands=False, land_here=False)
    t.redirect(goal)


def _continue(t: Transition) -> None:
    if t.state.goal in (Goal.SURVEY, Goal.TASK):
        t.tell(message("I am going on already."))
        return
    blind = [link for link in (Link.CAMERA, Link.POSITION) if t.state.is_down(link)]
    ending = t.state.ending
    if blind or (ending is not None and ending.outcome is not Outcome.ABORTED and t.state.goal is not Goal.HOLD):
        why = message("The {link} is lost.", link=LINKS[blind[0]]) if blind or ending is None else ending.reason
        t.tell(message("I cannot go on: {why}", why=why))
        return
    t.tell(_ANSWERS[Order.CONTINUE])
    _resume(t)


def _resume(t: Transition) -> None:
    t.set(held_since_s=None, held_for=None, ending=None, lands=False, land_here=False)
    t.redirect(t.state.resume)


def _end_hold(t: Transition, goal: Goal, outcome: Outcome, reason: Message) -> None:
    t.set(ending=Ending(outcome=outcome, reason=reason), held_since_s=None, held_for=None)
    t.tell(joined([reason, message("I return.") if goal is Goal.RETURN else message("I land.")]))
    t.redirect(goal)
