"""The state of a mission: one immutable value without ports in it (method, section 8)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mintpilot.core.briefing import Briefing
from mintpilot.core.geometry import Floats
from mintpilot.core.inputs import Link
from mintpilot.core.message import Message
from mintpilot.core.mission import Achieved, Looked, Mission, Outcome, Verdict, Waiting
from mintpilot.core.plan import LeftUndone, Plan, Prospect, Stop
from mintpilot.core.query import Answer, Query, Question
from mintpilot.core.room_view import RoomView
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Task
from mintpilot.core.told import ToldFact
from mintpilot.core.trajectory import VehicleState
from mintpilot.core.tree import GapExplanation, ScoredQuery
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.facts import Memory
from mintpilot.mission.requests import Purpose, SurveyProgress

READ_BACK_S = 30.0
"""What was read back must be confirmed within this time, seconds."""


class Goal(StrEnum):
    """What the drone is up to. It decides what is done next whenever the vehicle is at rest."""

    SURVEY = "survey"
    """Make the first map."""
    TASK = "task"
    """Deliberate, ask, fly the plan."""
    HOLD = "hold"
    """Hover, and wait for an order or for a link to come back."""
    RETURN = "return"
    """Fly back to the start; the mission ends there."""
    LAND = "land"
    """Land; the mission ends on the ground."""
    ENDED = "ended"


class Activity(StrEnum):
    """What the present motion or look is for: what follows when it ends."""

    NONE = "none"
    TAKE_OFF = "take-off"
    FIRST_LOOK = "first-look"
    SWEEP = "sweep"
    """A turn on the spot, looking around."""
    SWEPT = "swept"
    """Drawing the map after a sweep."""
    EXPLORE = "explore"
    """To the next place to look around from."""
    SURVEY_BACK = "survey-back"
    """Towards the start, or back out of a place that is not known free."""
    LEG = "leg"
    ACT = "act"
    ACTED = "acted"
    """Looking from the stop."""
    MEANWHILE = "meanwhile"
    """A flight while a question is open."""
    ACT_MEANWHILE = "act-meanwhile"
    ACTED_MEANWHILE = "acted-meanwhile"
    """Looking from a stop that was done while a question is open."""
    RETREAT = "retreat"
    """Back out of a place that is not known free."""
    HOMEWARD = "homeward"
    TO_LANDING = "to-landing"
    DESCENT = "descent"


@dataclass(frozen=True, slots=True, kw_only=True)
class Setup:
    """What stays the same for a whole mission."""

    mission: Mission
    task: Task | None = None
    """What is to be done, for its rules; None: there are none."""
    surveys: bool = False
    """True where the first map is made by a survey flight."""
    simulated: bool = False
    """True in a simulator only: baselines may then fly what is not known to be passable."""
    lands: bool = False
    """True for a real vehicle: however the mission ends, it returns if it can, and lands."""
    briefing: Briefing | None = None
    """What is shown before take-off and must be answered with an explicit yes; None: it takes off at once."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OngoingMotion:
    """The motion that the vehicle makes."""

    id: int
    known: frozenset[str]
    """Regions and rooms that were known when it began."""
    monitored: bool = False
    braking: bool = False


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OpenQuestion:
    """The question that is put to the operators."""

    question: Question
    scored: ScoredQuery
    asked_s: float
    patient_until_s: float
    """When the person's time is over, mission clock."""
    needed_s: float = float("inf")
    """When the cautious plan must begin to fit the battery with its reserve, mission clock."""
    prospects: tuple[Prospect, ...] = ()
    """What the answer may come to; empty where the drone holds meanwhile."""
    thought_s: float = 0.0
    """When the prospects' spare times began to run, mission clock."""
    moves_s: float = float("inf")
    """When it is to be thought about next what to do meanwhile, mission clock."""
    shown_s: float | None = None
    shown_map: SemanticMap | None = None
    """What it speaks of: a yes for a region covers the outline that it has here. None: it speaks of no region."""
    first_text: str = ""
    """The words that were there first, where better ones followed; else empty."""
    read_backs: int = 0
    """How often an answer to it was read back."""
    extended: bool = False
    """Whether more time was granted."""
    reworded_s: float | None = None
    """How long the better words took to make, seconds; None: there are none."""

    @property
    def deadline_s(self) -> float:
        """When it counts as unanswered, mission clock."""
        return min(self.patient_until_s, self.needed_s)


@dataclass(frozen=True, slots=True, kw_only=True)
class PendingRequest:
    """A deliberation that was asked for and has not come back."""

    id: int
    purpose: Purpose
    deadline_s: float
    map: SemanticMap
    """What it looks at."""
    begun_s: float = 0.0
    """When it was asked for, mission clock."""


@dataclass(frozen=True, slots=True, kw_only=True)
class QuestionOver:
    """A question that is over, until it is known what was flown meanwhile."""

    expected_s: float
    """What the plans that are left would cost from where it was asked, on average, seconds."""
    undone_s: float
    """Prices of what they leave undone, seconds."""
    at_s: float
    """When it was over, mission clock."""
    delay_s: float
    """How long it was open, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Telling:
    """A fact that an operator told."""

    known: ToldFact
    memory: Memory | None = None
    """What was known of its gap before; None: it is about none, or does not count."""
    counts_s: float = 0.0
    """Since when it counts, mission clock."""
    shown: SemanticMap | None = None
    """The map that the operator saw, while it is read back."""
    read_back_s: float = 0.0
    """Since when it, or taking it back, is read back, mission clock."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ending:
    """How the mission ends once the drone is home or on the ground, or can go no further."""

    outcome: Outcome
    reason: Message
    """Why, in one sentence; where the drone is then is added."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MissionState:
    """Everything that the next step depends on."""

    setup: Setup
    clock_s: float
    vehicle: VehicleState
    goal: Goal
    activity: Activity = Activity.NONE
    beliefs: BeliefState | None = None
    """None until the first map is there."""
    known_passable: frozenset[str] = frozenset()
    """Obstacle gaps of regions that the first map calls passable: nobody needs to say so."""
    survey: SurveyProgress | None = None
    task_begun_s: float | None = None
    """When flight time began to count, mission clock."""
    ready: bool = False
    """True once the vehicle has reported the battery that the task is flown with."""
    plan: Plan | None = None
    wanted: tuple[Stop, ...] = ()
    """Stops of the plan that was set out on last, those among them that it leaves undone included."""
    undone: tuple[LeftUndone, ...] = ()
    """Stops of which nothing could be flown when it was thought about last."""
    achieved: tuple[Achieved, ...] = ()
    """What was done, in order."""
    looks: tuple[Looked, ...] = ()
    """What looks into rooms came to, in order."""
    view: RoomView | None = None
    """What the vehicle said of the look that it has just ended."""
    leg: int = 0
    """Index of the leg that is flown, or prepared."""
    assume_passable: frozenset[str] = frozenset()
    motion: OngoingMotion | None = None
    grounded: bool = False
    """True until the briefing was answered with yes: nothing moves."""
    question: OpenQuestion | None = None
    told: tuple[Telling, ...] = ()
    """What operators told of their own accord, oldest first."""
    outdated: bool = False
    """Whether something was told since the plan was made: it is thought of again at the next stop."""
    acting: Stop | None = None
    """The stop that is done while a question is open."""
    over: QuestionOver | None = None
    """What was asked last, until it is known what was flown meanwhile."""
    waiting: Waiting = Waiting()  # noqa: RUF009  (a value)
    learnt: Answer | None = None
    """The answer that was learnt from last, as it counted."""
    earlier: tuple[tuple[str, Query], ...] = ()
    """Questions that are no longer open: id and query, oldest first."""
    request: PendingRequest | None = None
    drops: int = 0
    """Decisions dropped in a row since things had changed."""
    fallback: Plan | None = None
    """The cautious plan that was checked last."""
    next_id: int = 1
    """Of motions, requests and questions."""
    resume: Goal = Goal.TASK
    """What an order to continue goes back to."""
    held_since_s: float | None = None
    held_for: Link | None = None
    """The link whose loss made the drone hold; None: an order did."""
    home_s: float | None = None
    """Flight time of the way to the start from where the drone holds, seconds; 0: there is none; None: not known."""
    land_here: bool = False
    """True: land only where it is, else return first (an abort)."""
    lands: bool = False
    """True: having returned, it lands."""
    ending: Ending | None = None
    track: tuple[Floats, ...] = ()
    """Where the vehicle has been, in pieces (n, 3), oldest first, metres."""
    replans: int = 0
    """How often news in flight made the drone deliberate again."""
    retreats: int = 0
    refusals: int = 0
    """Motions that the vehicle has refused."""
    hops: int = 0
    """Flights towards the start or the landing place so far."""
    explanations: tuple[GapExplanation, ...] = ()
    """Of every gap that was ever open, from the first deliberation that knew of it."""
    asked_gaps: frozenset[str] = frozenset()
    notes: frozenset[Message] = frozenset()
    """Bounds on the work that were told already."""
    links_down: tuple[tuple[Link, float], ...] = ()
    """Links that are down, and since when."""
    verdict: Verdict | None = None
    """How it ended; None while it goes on."""

    @property
    def ended(self) -> bool:
        """Whether the mission is over."""
        return self.goal is Goal.ENDED

    @property
    def at_rest(self) -> bool:
        """Whether the vehicle makes no motion."""
        return self.motion is None

    @property
    def track_m(self) -> Floats:
        """Where the vehicle has been (n, 3), oldest first, metres."""
        return np.vstack(self.track) if self.track else np.zeros((0, 3))

    def endurance_s(self) -> float:
        """Flight time that a plan may use now, seconds: that of the battery, and what the mission allows."""
        left = self.vehicle.endurance_left_s
        if self.task_begun_s is None:
            return left
        return min(left, self.setup.mission.limits.endurance_s - (self.clock_s - self.task_begun_s))

    def is_down(self, link: Link) -> bool:
        """Whether that link is down."""
        return any(name is link for name, _ in self.links_down)

    @property
    def lacks_wanted(self) -> bool:
        """Whether a place or thing that was asked for is not done; rooms that somebody may be in do not count."""
        finished = self.beliefs.finished if self.beliefs is not None else frozenset[str]()
        return any(not stop.optional and stop.id not in finished for stop in self.wanted)

    def next_deadline_s(self) -> float:
        """The next moment at which passing time alone changes something, mission clock; infinity: none."""
        times = [self.question.deadline_s] if self.question is not None else []
        if self.question is not None and self.motion is None and self.request is None:
            times.append(self.question.moves_s)
        if self.beliefs is not None:
            times += [g.given_s + self.setup.mission.asking.answer_valid_s for g in self.beliefs.grants]
        times += [one.read_back_s + READ_BACK_S for one in self.told if one.known.read_back]
        if self.request is not None:
            times.append(self.request.deadline_s)
        return min(times, default=float("inf"))


def uncertain_things(map: SemanticMap) -> dict[str, str]:
    """Regions and rooms of a map: id → what they are called."""
    regions = {region.id: region.description or region.id for region in map.regions}
    return regions | {room.id: room.description or room.id for room in map.rooms}
