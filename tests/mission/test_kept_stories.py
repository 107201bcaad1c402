"""What the mission does next, in every phase and after every kind of disturbance, is what it did before.

`stories.txt` keeps a line for each: the directives of the steps that follow, how it stands then, and a digest of all
that was said, kept for the record and changed (`kept`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import pytest

from kept import same_as_kept
from mintpilot.core.inputs import (
    Answered,
    FactConfirmed,
    FactTold,
    FactUndone,
    Link,
    LinkChanged,
    MoreTimeWanted,
    Ordered,
    QuestionReworded,
    QuestionShown,
)
from mintpilot.core.message import NOTHING, Message, verbatim
from mintpilot.core.mission import AskingSettings, WhileWaiting
from mintpilot.core.motion import MotionEnd
from mintpilot.core.query import Answer, Order, Reply, Standing
from mintpilot.core.told import KeepOut, RegionBlocked, RegionPassable, RoomSearched, ThisOne
from mintpilot.mission.state import Activity

from .story import BATTERY_S, Kind, Story, begun

KEPT = Path(__file__).parent / "stories.txt"
PLAIN = Kind()
REAL = Kind(lands=True)
SURVEYED = Kind(surveys=True, lands=True)
BRIEFED = Kind(briefed=True)
MOVING = Kind(asking=AskingSettings(delta_c_s=0.5, answer_valid_s=60.0, while_waiting=WhileWaiting.MOVE))
GOES_ON = 9
"""Steps that a story goes on for, undisturbed, after what disturbed it."""

PHASES: dict[str, Callable[[], Story]] = {
    "climb": lambda: begun(PLAIN),
    "first look": lambda: _after(begun(PLAIN), 1),
    "thinking": lambda: _thinking(begun(REAL)),
    "question": lambda: begun(PLAIN).until(),
    "second question": lambda: begun(PLAIN).until(times=2),
    "question, moving": lambda: begun(MOVING).until(),
    "leg": lambda: begun(PLAIN).until(Activity.LEG),
    "second leg, real": lambda: begun(REAL).until(Activity.LEG, times=2),
    "act": lambda: begun(PLAIN).until(Activity.ACT),
    "homeward": lambda: begun(REAL).until(Activity.HOMEWARD),
    "descent": lambda: begun(REAL).until(Activity.DESCENT),
    "sweep": lambda: begun(SURVEYED).until(Activity.SWEEP),
    "briefing": lambda: begun(BRIEFED),
}


def _after(story: Story, steps: int) -> Story:
    for _ in range(steps):
        story.go_well()
    return story


def _thinking(story: Story) -> Story:
    while not story.requests:
        story.go_well()
    return story


@cache
def at(phase: str) -> Story:
    return PHASES[phase]()


# --- what may happen ------------------------------------------------------------------------------------------------


def order(story: Story, *orders: Order) -> None:
    for one in orders:
        story.feed(Ordered(time_s=story.time_s, order=one, operator="ann"))


def link(story: Story, which: Link, *, waits: tuple[float, ...] = (), back: bool = False) -> None:
    story.feed(LinkChanged(time_s=story.time_s, link=which, up=False, reason="a fault"))
    if story.moving is not None and story.braking:
        story.end_motion()
    for seconds in waits:
        story.tick(seconds)
    if back:
        story.feed(LinkChanged(time_s=story.time_s, link=which, up=True))
        story.feed(LinkChanged(time_s=story.time_s, link=which, up=True))


def answers(story: Story, *answers: Answer) -> None:
    """To whatever was asked last; late where it is over."""
    for answer in answers:
        name = story.state.question.question.id if story.state.question is not None else last(story)
        story.feed(Answered(time_s=story.time_s, question=name, answer=answer, operator="ann"))


def last(story: Story) -> str:
    return story.state.earlier[-1][0] if story.state.earlier else "q99"


def said(reply: Reply, **more: object) -> Answer:
    return Answer(reply=reply, latency_s=1.0, text=reply.value, **more)  # type: ignore[arg-type]


def late(story: Story, reply: Reply) -> None:
    """Nobody answers in time; then somebody does."""
    open_ = story.state.question
    if open_ is not None:
        story.tick(open_.deadline_s - story.time_s)
    _after(story, 2)
    story.feed(Answered(time_s=story.time_s, question=last(story), answer=said(reply)))


def more_time(story: Story) -> None:
    name = story.state.question.question.id if story.state.question is not None else "q99"
    story.feed(QuestionShown(time_s=story.time_s + 1.0, question=name))
    story.feed(QuestionShown(time_s=story.time_s + 2.0, question=name))
    story.feed(QuestionReworded(time_s=story.time_s, question=name, text="Is it?", worded_by="a model", seconds=0.5))
    story.feed(QuestionReworded(time_s=story.time_s, question=name, text="Is it so?", worded_by="a model"))
    story.feed(MoreTimeWanted(time_s=story.time_s, question="q99"))
    for _ in range(2):
        story.feed(MoreTimeWanted(time_s=story.time_s, question=name))


def tell(story: Story, fact: object, *then: str) -> None:
    story.feed(FactTold(time_s=story.time_s, fact=fact, operator="ann"))  # type: ignore[arg-type]
    name = story.state.told[-1].known.id if story.state.told else "t0"
    for word in then:
        match word:
            case "yes":
                story.feed(FactConfirmed(time_s=story.time_s, told=name, operator="ann"))
            case "undo":
                story.feed(FactUndone(time_s=story.time_s, told=name, operator="bob"))
            case "wait":
                story.tick(29.0)
                story.tick(1.0)
            case "age":
                story.tick(59.0)
                story.tick(1.0)


def thought(story: Story, *what: str) -> None:
    """Deliberations that fail, are overdue, or come too late for what has been seen meanwhile."""
    for word in what:
        while not story.requests and not story.state.ended and len(story.lines) < 60:
            story.go_well()
        if not story.requests:
            return
        match word:
            case "fails":
                story.fail()
            case "overdue":
                story.tick(9.9)
                story.tick(0.1)
            case "late":
                story.cloud(f"new-{len(story.lines)}")
                story.look()
                story.deliver()


def motion(story: Story, *ends: MotionEnd, by_hand: str = "") -> None:
    for end in ends:
        while story.moving is None and not story.state.ended and len(story.lines) < 60:
            story.go_well()
        if story.moving is not None:
            story.end_motion(end, by_hand=by_hand)


def seen(story: Story, obstruction: Message) -> None:
    story.cloud()
    story.look(obstruction=obstruction)


def grown(story: Story) -> None:
    """What was allowed is allowed no longer."""
    _after(story, 2)
    story.tick(60.0)


SQUARE = KeepOut(corners_m=((3.0, 1.0), (5.0, 1.0), (5.0, 3.5), (3.0, 3.5)))
EVENTS: dict[str, Callable[[Story], object]] = {
    "nothing": lambda s: None,
    "hold, continue": lambda s: (order(s, Order.HOLD), _after(s, 2), order(s, Order.CONTINUE)),
    "hold twice, long": lambda s: (order(s, Order.HOLD, Order.HOLD), _after(s, 2), s.tick(200.0), s.tick(60.0)),
    "hold with much battery": lambda s: (order(s, Order.HOLD), _after(s, 1), s.tick(1799.0), s.tick(1.0)),
    "return": lambda s: order(s, Order.RETURN),
    "return, then continue": lambda s: (order(s, Order.RETURN), _after(s, 1), order(s, Order.CONTINUE)),
    "land": lambda s: order(s, Order.LAND),
    "abort": lambda s: order(s, Order.ABORT),
    "camera lost": partial(link, which=Link.CAMERA, waits=(4.9, 0.1, 60.0, 1.0)),
    "camera lost and back": partial(link, which=Link.CAMERA, waits=(2.0,), back=True),
    "position lost": partial(link, which=Link.POSITION, waits=(4.9, 0.1)),
    "position lost and back": partial(link, which=Link.POSITION, waits=(2.0,), back=True),
    "operator lost": partial(link, which=Link.OPERATOR, waits=(1.0,)),
    "operator lost and back": partial(link, which=Link.OPERATOR, waits=(1.0,), back=True),
    "model lost": partial(link, which=Link.MODEL, back=True),
    "telemetry lost": partial(link, which=Link.TELEMETRY),
    "control lost": partial(link, which=Link.CONTROL),
    "yes": lambda s: answers(s, said(Reply.YES)),
    "no": lambda s: answers(s, said(Reply.NO)),
    "unsure": lambda s: answers(s, said(Reply.UNSURE)),
    "yes by voice, confirmed": lambda s: answers(
        s, said(Reply.YES, by="voice"), said(Reply.YES, standing=Standing.CONFIRMED)
    ),
    "yes by voice, then no": lambda s: answers(
        s, said(Reply.YES, by="voice"), said(Reply.NO, standing=Standing.CONFIRMED)
    ),
    "yes by a model, never confirmed": lambda s: answers(s, *[said(Reply.YES, understood_by="model")] * 4),
    "no by voice": lambda s: answers(s, *[said(Reply.NO, by="voice")] * 2),
    "late yes": partial(late, reply=Reply.YES),
    "late no": partial(late, reply=Reply.NO),
    "late unsure": partial(late, reply=Reply.UNSURE),
    "more time": more_time,
    "drawn": partial(tell, fact=SQUARE),
    "drawn and undone": lambda s: tell(s, SQUARE, "undo", "undo"),
    "blocked": partial(tell, fact=RegionBlocked(region="cloud")),
    "blocked and undone": lambda s: tell(s, RegionBlocked(region="cloud"), "undo"),
    "passable, confirmed, aged": lambda s: tell(s, RegionPassable(region="cloud"), "yes", "age"),
    "passable, not confirmed": lambda s: tell(s, RegionPassable(region="cloud"), "wait", "yes"),
    "passable, undone": lambda s: tell(s, RegionPassable(region="cloud"), "yes", "undo"),
    "searched": lambda s: tell(s, RoomSearched(room="room"), "yes", "undo"),
    "this one": lambda s: tell(s, ThisOne(thing="red"), "yes", "undo"),
    "unknown": lambda s: tell(s, RegionPassable(region="nothing"), "yes"),
    "thought fails": lambda s: thought(s, "fails"),
    "thought overdue": lambda s: thought(s, "overdue"),
    "thought late twice": lambda s: thought(s, "late", "late"),
    "something new in the way": partial(seen, obstruction=verbatim("a cloud")),
    "something new": partial(seen, obstruction=NOTHING),
    "motion stopped": lambda s: motion(s, MotionEnd.STOPPED),
    "motion refused": lambda s: motion(s, MotionEnd.REFUSED),
    "motion refused often": lambda s: motion(s, *[MotionEnd.REFUSED] * 3),
    "motion fails": lambda s: motion(s, MotionEnd.FAILED),
    "done by hand": lambda s: (motion(s, MotionEnd.ARRIVED, by_hand="Take it off"), order(s, Order.CONTINUE)),
    "time passes": grown,
    "battery empty": lambda s: s.tick(BATTERY_S - 40.0),
}


def story_of(phase: str, event: str) -> str:
    story = at(phase).copy()
    since = len(story.lines)
    EVENTS[event](story)
    for _ in range(GOES_ON):
        if not story.state.ended:
            story.go_well()
    return story.told(since)


@pytest.mark.long
@pytest.mark.parametrize("event", EVENTS)
def test_the_mission_does_what_it_did(event: str) -> None:
    same_as_kept(KEPT, {f"{phase} + {event}": story_of(phase, event) for phase in PHASES})
