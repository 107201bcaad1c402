"""What a mission tells while it runs. The recorder turns these into the run folder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from mintpilot.core.briefing import Briefing
from mintpilot.core.gap import CorrelationGroup, KnowledgeGap
from mintpilot.core.inputs import Input
from mintpilot.core.message import Message
from mintpilot.core.mission import Mission, Verdict
from mintpilot.core.observation import Detection, Frame
from mintpilot.core.plan import Plan
from mintpilot.core.query import Answer, Order, Question
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Task
from mintpilot.core.told import ToldFact
from mintpilot.core.trajectory import FlightLog, Trajectory
from mintpilot.core.tree import Certificate, GapExplanation, Mint, ScoredQuery


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionStarted:
    """The first event."""

    mission: Mission
    task: Task
    seed: int | None
    strategy: str
    language: str = "en"
    """In which questions are asked."""
    names: tuple[tuple[str, str], ...] = ()
    """What the mission file calls things in that language: English words, and the same."""
    language_model: str = "template"
    """Who words them: a registered name; ``template``: no model."""
    groups: tuple[CorrelationGroup, ...] = ()
    """Gaps whose priors do not multiply."""
    planner: str = "grid"
    """Registered name of the planner."""
    simulated: bool = False
    """Whether it is flown in a simulator."""
    surveys: bool = False
    """Whether the first map is made by a survey flight."""
    lands: bool = False
    """Whether it ends on the ground, as a real vehicle's does."""
    briefing: Briefing | None = None
    """What must be answered with yes before take-off; None: nothing."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrameSeen:
    """A picture was taken and looked at."""

    index: int
    frame: Frame
    detections: tuple[Detection, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ViewTaken:
    """A picture for whoever watches: nothing is found in it, nothing is learnt from it, and it is not kept."""

    frame: Frame


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MapUpdated:
    """The semantic map was replaced."""

    map: SemanticMap
    why: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Deliberated:
    """Gaps were found and the tree was built; either a query was chosen or the asking stopped."""

    round: int
    gaps: tuple[KnowledgeGap, ...]
    mint: Mint | None
    """None for strategies that build no tree."""
    chosen: ScoredQuery | None
    alternatives: tuple[ScoredQuery, ...]
    """The best few of the other queries."""
    certificate: Certificate | None
    seconds: float
    proposed: tuple[ScoredQuery, ...] = ()
    """Queries that a language model proposed and that were sound, scored, best first."""
    bound_bits: float | None = None
    """No query of that kind could have a higher gain than this; None: not worked out."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Asked:
    """A question was put and answered (or not)."""

    question: Question
    """In the words that the person had when the answer came."""
    scored: ScoredQuery
    answer: Answer
    wording_s: float
    """From the choice of the query to the first words, seconds."""
    first_text: str = ""
    """The words that were there first, where better ones followed; else empty."""
    better_s: float | None = None
    """From the choice of the query to the better words, seconds; None: the person had the first words only."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlanChosen:
    """What will be flown, and the explanation of every gap."""

    plan: Plan | None
    certificate: Certificate
    explanations: tuple[GapExplanation, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LegFlown:
    """One trajectory was flown, to its end or not."""

    phase: str
    """``survey``, ``mission``, ``meanwhile`` (a question is open), ``retreat``, ``return`` or ``landing``."""
    stop_id: str
    trajectory: Trajectory
    log: FlightLog


@dataclass(frozen=True, slots=True, kw_only=True)
class OrderTaken:
    """An operator gave an order, and what the drone does then was said."""

    order: Order
    operator: str
    text: str
    """As it was given."""
    answer: Message
    """What the drone said that it does."""
    time_s: float
    """Mission clock."""


@dataclass(frozen=True, slots=True, kw_only=True)
class QuestionTimed:
    """Until when the open question is waited for: told when it is put, and whenever that changes."""

    question: str
    """Its id."""
    deadline_s: float
    """Mission clock."""
    extended: bool
    """Whether more time was granted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FactsChanged:
    """An operator told something, confirmed it or took it back; or it lapsed."""

    told: tuple[ToldFact, ...]
    """All that was told so far, oldest first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StopsDone:
    """The drone has done another stop."""

    stops: tuple[str, ...]
    """Ids of all that were done so far, sorted."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stepped:
    """One step of the mission: what happened, and a digest of what it made the mission do."""

    input: Input
    directives: tuple[str, ...]
    """Names of the directives, in order."""
    digest: str
    """Of the directives with all that they hold."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Noticed:
    """Something worth a line in the report: a contradiction, a silent operator, something new seen in flight."""

    kind: str
    """A short stable name, e.g. ``contradiction``."""
    text: Message


@dataclass(frozen=True, slots=True, kw_only=True)
class Timed:
    """How long a stage took."""

    stage: str
    """``survey``, ``perception``, ``mapping``, ``deliberation``, ``wording``, ``answer``, ``planning``, ``flight``."""
    seconds: float
    """Wall-clock time of this machine; for ``answer`` the operator's latency."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionEnded:
    """The last event."""

    verdict: Verdict


Event: TypeAlias = (
    MissionStarted
    | FrameSeen
    | ViewTaken
    | MapUpdated
    | Deliberated
    | Asked
    | PlanChosen
    | LegFlown
    | OrderTaken
    | QuestionTimed
    | FactsChanged
    | StopsDone
    | Stepped
    | Noticed
    | Timed
    | MissionEnded
)
