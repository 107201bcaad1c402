"""What browser and server say to each other over the WebSocket: the only place where web data is read or written."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from mintpilot.core.query import Order
from mintpilot.core.told import MOST_CORNERS

LONGEST_BYTES = 4096
"""A message of a browser may be no longer than this, bytes."""
LONGEST_TEXT = 400
"""Free words may be no longer than this, characters."""


class Message(BaseModel):
    """Closed and immutable: an unknown field is an error."""

    model_config = ConfigDict(extra="forbid", frozen=True)


Name: TypeAlias = Annotated[str, Field(max_length=120)]


class Hello(Message):
    """The first message of a browser. It opens nothing but what its token stands for."""

    kind: Literal["hello"] = "hello"
    token: Annotated[str, Field(max_length=100)]
    browser: Annotated[str, Field(pattern=r"^[a-z0-9]{8,32}$")]
    """Drawn at random by the browser, and the same after a reload."""


class Command(Message):
    """Something that a browser wants done. Sent again after a broken link until it is acknowledged."""

    n: Annotated[int, Field(ge=1, le=10**9)]
    """Counts up in each browser; a number that was seen already is acknowledged and not done again."""


class QuestionSeen(Command):
    """The question is in front of the person."""

    kind: Literal["seen"] = "seen"
    question: Name


class Replied(Command):
    """A key or button for that question."""

    kind: Literal["reply"] = "reply"
    question: Name
    reply: Literal["yes", "no", "unsure", "option"]
    option: Annotated[int, Field(ge=0, le=3)] | None = None
    confirms: bool = False
    """Whether a read-back was on the screen, not the question itself."""


class Pointed(Command):
    """A thing that the open question may be about was chosen on the map or in the list: this one."""

    kind: Literal["this-one"] = "this-one"
    question: Name
    thing: Name


class Said(Command):
    """Free words: an answer to that question, or an order."""

    kind: Literal["say"] = "say"
    question: Annotated[str, Field(max_length=120)] = ""
    text: Annotated[str, Field(min_length=1, max_length=LONGEST_TEXT)]


class MoreTime(Command):
    """More time is needed for that question."""

    kind: Literal["more-time"] = "more-time"
    question: Name


class Ordering(Command):
    """An order; live at any time."""

    kind: Literal["order"] = "order"
    order: Order


Metres: TypeAlias = Annotated[float, Field(ge=-1e5, le=1e5, allow_inf_nan=False)]


class Drew(Command):
    """A region was drawn on the map: the drone stays out of it."""

    kind: Literal["keep-out"] = "keep-out"
    corners: Annotated[tuple[tuple[Metres, Metres], ...], Field(min_length=3, max_length=MOST_CORNERS)]
    """x, y of each corner in order, metres in the world."""


class ToldOf(Command):
    """Something that the person knows of a thing, region or room on the map."""

    kind: Literal["tell"] = "tell"
    fact: Literal["blocked", "passable", "searched", "this-one"]
    subject: Name


class Confirmed(Command):
    """What was read back is right: that it is so, or that it is taken back."""

    kind: Literal["confirm"] = "confirm"
    told: Name


class TookBack(Command):
    """What was told does not hold, or what is read back is not right."""

    kind: Literal["undo"] = "undo"
    told: Name


class Seek(Command):
    """Of a recorded mission: show another moment."""

    kind: Literal["seek"] = "seek"
    time_s: Annotated[float, Field(ge=0, le=1e7, allow_inf_nan=False)] = 0.0
    moment: Annotated[int, Field(ge=0, le=10**6)] | None = None
    """Index of one of `ReplayPane.moments`, which then counts instead of the time."""


class Playing(Command):
    """Of a recorded mission: let time pass, or stop it."""

    kind: Literal["play"] = "play"
    speed: Annotated[float, Field(ge=0, le=64, allow_inf_nan=False)]
    """Mission seconds per second; 0: stop."""


class Listen(Command):
    """The microphone of this browser was switched on or off. Its sound comes as binary messages."""

    kind: Literal["microphone"] = "microphone"
    on: bool
    aloud: bool = True
    """Whether what the drone says is played."""


class TakeSeat(Command):
    """This browser answers from now on."""

    kind: Literal["take-seat"] = "take-seat"


class LeaveSeat(Command):
    """This browser answers no longer: another one may take over."""

    kind: Literal["leave-seat"] = "leave-seat"


AnyCommand: TypeAlias = Annotated[
    QuestionSeen
    | Replied
    | Pointed
    | Said
    | MoreTime
    | Ordering
    | Drew
    | ToldOf
    | Confirmed
    | TookBack
    | Seek
    | Playing
    | Listen
    | TakeSeat
    | LeaveSeat,
    Field(discriminator="kind"),
]
COMMANDS: TypeAdapter[AnyCommand] = TypeAdapter(AnyCommand)

Point: TypeAlias = tuple[float, float, float]
Box: TypeAlias = tuple[float, float, float, float]
"""Left, bottom, right, top on the map, metres; of a picture left, top, right, bottom in pixels."""


class MissionPane(Message):
    """What is flown."""

    name: str
    instruction: str
    lang: str
    strategy: str
    start: Point
    volume: Box
    """Where it may fly: left, bottom, right, top."""
    briefing: tuple[str, ...] = ()
    verdict: str = ""
    """Empty while it goes on."""
    reason: str = ""
    waited_s: float = 0.0
    """What waiting for answers took in all; known once it is over."""
    hidden_s: float = 0.0
    """Of that, what was flown meanwhile and had to be flown anyway."""


class PosePane(Message):
    """Where the drone is, and what its battery gives."""

    time_s: float
    position: Point
    yaw_rad: float
    speed_mps: float
    battery_s: float | None
    """Flight time that is left; None: without limit."""
    need_s: float | None
    """What the rest of the plan takes; None: there is no plan."""


class PathPane(Message):
    """The plan as it stands."""

    points: tuple[Point, ...] = ()
    seconds: float = 0.0


class StepPane(Message):
    """One step of the mission."""

    text: str
    state: Literal["open", "now", "done", "left-out"]


class StepsPane(Message):
    """All steps, in order."""

    steps: tuple[StepPane, ...]


class Thing(Message):
    """An object of the map, or a closed room's door."""

    id: str
    label: str
    words: str
    box: Box
    state: str = ""
    """Of rooms: ``open``, ``searched``, ``yes`` (somebody inside) or ``no``."""


class RegionPane(Message):
    """A region; its cells are those of the map picture with its number."""

    id: str
    words: str
    passable: Literal["open", "yes", "no"]
    centre: tuple[float, float]


class MapPane(Message):
    """Goes in front of the map's picture: one grey value for each column of voxels, north up."""

    box: Box
    things: tuple[Thing, ...]
    regions: tuple[RegionPane, ...]
    """Region i has the grey value 3 + i; 0: unknown, 1: free, 2: occupied."""


class PictureBox(Message):
    """A thing in a picture."""

    id: str
    words: str
    box: Box


class PicturePane(Message):
    """Goes in front of a camera picture."""

    frame: int
    time_s: float
    boxes: tuple[PictureBox, ...] = ()
    question: str = ""
    """Of a picture that shows what a question is about: the question's id."""


class Consequence(Message):
    """What one reply leads to."""

    reply: Literal["yes", "no", "unsure", "option", "silence"]
    option: int | None = None
    words: str
    """Empty where the page's own words say it."""
    path: tuple[Point, ...] = ()
    seconds: float | None = None
    share: float | None = None
    """Probability of this plan, given the reply."""
    undone: tuple[str, ...] = ()
    frees: bool = False
    """Whether this reply takes caution away, and others do not."""


class Spot(Message):
    """A place that the question is about."""

    id: str
    words: str
    position: Point
    region: str = ""
    choosable: bool = False
    """Whether "this one" is an answer."""


class Worth(Message):
    """What the question is worth, in figures."""

    gain_bits: float
    saved_s: float
    queries: int
    """How many were compared, as far as is known."""
    gaps: int
    """How many things are not known."""


class Reason(Message):
    """What hangs on a gap."""

    words: str
    """In English; the page says it from the figures where both are known."""
    best_s: float | None = None
    worst_s: float | None = None
    """What the best plan takes if the gap turns out well, and if not."""
    apart_m: float | None = None
    """How far apart these two ways are."""


class QuestionPane(Message):
    """The open question; all fields empty while there is none."""

    id: str = ""
    text: str = ""
    lang: str = "en"
    attempt: int = 1
    deadline_s: float = 0.0
    """On the mission clock."""
    extended: bool = False
    consequences: tuple[Consequence, ...] = ()
    spots: tuple[Spot, ...] = ()
    why: tuple[Reason, ...] = ()
    """What hangs on each gap."""
    worth: Worth | None = None
    read_back: str = ""
    """What was understood and must be confirmed: ``yes``, ``no``, or the words of an option."""
    read_back_means: str = ""
    again: bool = False
    """Whether words were not understood."""
    closed: str = ""
    """Why the last question is no longer open."""


class TreeNode(Message):
    """One node of the tree."""

    words: str
    probability: float
    branch: str = ""
    leaf: str = ""
    cost_s: float | None = None
    divergence_m: float | None = None
    ruled_out_by: int | None = None
    """Number of the answer, from 1; None: still possible."""
    flown: bool = False
    left_out: int = 0
    children: tuple[TreeNode, ...] = ()


class AnswerLine(Message):
    """One answer that was taken over."""

    question: str
    reply: str


class GapLine(Message):
    """One gap with the reason for asking about it or not."""

    words: str
    asked: bool
    relevant: bool
    why: str
    figures: str
    entropy_bits: float
    gain_bits: float


class TreeRound(Message):
    """The tree of an earlier deliberation, with what the answers since then ruled out."""

    round: int
    root: TreeNode
    answers: tuple[AnswerLine, ...]


class TreePane(Message):
    """The tree of the latest deliberation."""

    round: int
    root: TreeNode | None
    nodes: int
    answers: tuple[AnswerLine, ...]
    gaps: tuple[GapLine, ...]
    certificate: str = ""
    earlier: tuple[TreeRound, ...] = ()


class LogLine(Message):
    """One line of the event log."""

    time_s: float
    kind: str
    text: str


class Moment(Message):
    """Something worth going to in a recorded mission."""

    time_s: float
    kind: str
    """As in the log."""


class ReplayPane(Message):
    """A recorded mission, and what is shown of it."""

    time_s: float
    to_s: float
    speed: float
    """0: it stands still."""
    moments: tuple[Moment, ...]
    passed: int = 0
    """How many of these are shown by now."""
    exact: bool = False
    """Whether the last of these is what is shown."""


class ToldLine(Message):
    """One fact that an operator told."""

    id: str
    fact: Literal["keep-out", "blocked", "passable", "searched", "this-one"]
    words: str
    """What it speaks of; empty for a drawn region."""
    who: str
    time_s: float
    standing: Literal["read-back", "counts", "undo-read-back", "undone", "lapsed", "refused"]
    why: str = ""
    corners: tuple[tuple[float, float], ...] = ()


class ToldPane(Message):
    """What operators told, oldest first."""

    told: tuple[ToldLine, ...] = ()


class SeatPane(Message):
    """To one browser: what it may do, and who answers."""

    may_answer: bool
    seated: bool
    taken: bool
    """Whether the browser that answers is connected."""
    viewers: int


class MicrophonePane(Message):
    """Captions beside the microphone."""

    problem: str = ""
    """Why nothing is heard; empty: it is."""
    said: str = ""
    """What the drone said last."""
    heard: str = ""
    """What was heard last."""


class SpokenPane(Message):
    """Goes in front of sound that is played at once, in the place of what is still played; without sound: silence."""

    n: int
    """Counts up."""


class FlownPoint(Message):
    """One place of the flown path."""

    at: Point


class AttentionPane(Message):
    """What was asked back in words: the page shows the place, the picture or the figures, or repeats the question."""

    n: int
    """Counts up."""
    to: str
    """``where``, ``show``, ``why``, ``repeat``; ``nothing-asked``: words came that were no order."""
