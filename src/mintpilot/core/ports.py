"""The ports: what the method needs of the outside. Each says what, never how.

All are synchronous; an adapter that needs a thread or an event loop hides it and owns its time-outs.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeAlias, runtime_checkable

from mintpilot.core.events import Event
from mintpilot.core.gap import Assumptions, Belief, KnowledgeGap
from mintpilot.core.geometry import Floats, Ints, SmallInts
from mintpilot.core.inputs import OperatorInput, VehicleInput
from mintpilot.core.message import Message
from mintpilot.core.mission import AskingSettings, Verdict
from mintpilot.core.motion import Motion
from mintpilot.core.observation import Detection, Frame, NameGuess, RawFrame, Segment
from mintpilot.core.plan import Look, Plan, PlanningProblem
from mintpilot.core.policy import PolicyState
from mintpilot.core.query import Evidence, Query, Question, Reply
from mintpilot.core.reading import AnsweredBy, Reading
from mintpilot.core.trajectory import VehicleState
from mintpilot.core.tree import Certificate, Mint, ScoredQuery


class Perception(Protocol):
    """Finds things in one picture. Called by the loop for every frame, in order."""

    def detect(self, frame: Frame, index: int) -> tuple[Detection, ...]:
        """What the frame shows; ``index`` goes into `Detection.frame_index`.

        Frames without any usable depth give no detections. Raises `DeviceError` when a model or its server fails.
        """
        ...


class Namer(Protocol):
    """Says what segments may be. Several are asked about the same segments, and their evidence is put together."""

    def names(self, frame: Frame, segments: Sequence[Segment]) -> tuple[tuple[NameGuess, ...], ...]:
        """For each segment the names that it may have, with calibrated probabilities that sum to at most 1.

        What is missing to 1 is for none of them. A namer that knows nothing of a segment gives no name for it. Raises
        `DeviceError` when a model or its server fails.
        """
        ...


class VisionModel(Protocol):
    """Answers in words what a picture shows. What it says is a suggestion: geometry comes from depth alone."""

    def look(self, prompt: str, picture_png: bytes, *, schema: type, timeout_s: float) -> str:
        """The model's answer, JSON of that pydantic schema where it keeps to it; the caller checks it.

        Raises `DeviceError` when there is no answer in time.
        """
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceOptions:
    """What the command line or a caller knows about the pictures. None: found out, or assumed and said."""

    color: Path | None = None
    """Colour picture of a single view."""
    depth: Path | None = None
    """Depth picture of a single view."""
    intrinsics: Path | None = None
    """File with the lens, JSON or YAML."""
    depth_unit_m: float | None = None
    """Metres in one step of a depth picture of whole numbers: 0.001 for millimetres, 0.0002 for TUM's recordings."""
    every: int = 1
    """Each n-th frame is used."""
    longest: int = 200
    """No more frames than this are used."""
    seed: int = 0
    """For simulated sources."""
    live: bool = False
    """Pictures are taken one by one in flight, as many as are asked for."""


class FrameSource(Protocol):
    """Gives RGB-D pictures: a recording, a bag, a camera, a simulator."""

    @property
    def z_is_up(self) -> bool:
        """Whether the source's own world has z up by convention (ROS, TUM); False where that is not known."""
        ...

    def frames(self) -> Iterator[RawFrame]:
        """The pictures in the order in which they were taken. Called once.

        Raises:
            MapError: the recording, or a picture of it, cannot be used; the message says which and why.
            DeviceError: a live camera is gone.
            MissingPartError: the package that reads this kind of source is not installed.
        """
        ...

    def remarks(self) -> tuple[str, ...]:
        """What the person should know of how it was read (assumed lens, frames left out), a sentence each.

        Complete once `frames` is exhausted.
        """
        ...


class PlanSpace(Protocol):
    """The plans of one problem, made when asked for and remembered (method, section 2)."""

    def optimistic(self, given: Assumptions) -> Plan | None:
        """The cheapest plan with every open gap at its most favourable value; None where there is none.

        `Plan.relies_on` names the open gaps that it would break on or lose by.
        """
        ...

    def cautious(self, given: Assumptions) -> Plan | None:
        """The cheapest plan that succeeds whatever the open gaps turn out to be; None where there is none."""
        ...

    @property
    def searches(self) -> int:
        """How many searches of the map were made so far."""
        ...

    @property
    def notes(self) -> tuple[Message, ...]:
        """What a bound on the work left out so far, in plain sentences; empty when every plan is the best one."""
        ...


class Planner(Protocol):
    """Plans through a map. Called whenever the map, the task or the drone's place has changed."""

    def open(self, problem: PlanningProblem) -> PlanSpace:
        """The plans of that problem. Equal problems give equal plans.

        Raises:
            InfeasibleError: the start is not in flyable space, or a stop can be reached under no hypothesis.
        """
        ...


class ImpactMetric(Protocol):
    """How far two paths differ."""

    def divergence(self, a_m: Floats, b_m: Floats) -> float:
        """Distance in metres between two paths (n, 3) and (m, 3); 0 for equal ones, symmetric."""
        ...


@runtime_checkable
class PlanMetric(ImpactMetric, Protocol):
    """An impact metric that also judges plans: it then says what a gap costs, in place of the plans' own costs."""

    def on(self, problem: PlanningProblem) -> PlanMetric:
        """The same metric for the plans of that problem. Called before `loss_s`, whenever the problem has changed."""
        ...

    def loss_s(self, best: Plan, sure: Plan, given: Assumptions) -> float:
        """Seconds of flight lost by following ``sure`` where all that ``given`` leaves open turns out well.

        Args:
            best: the best plan if it does; the loss is measured against it.
            sure: the plan that is followed, to its end.
            given: what is assumed besides.

        Returns:
            The loss; infinite where ``sure`` is not known to arrive. Exact values give the difference of the costs.

        Raises:
            InputError: what it judges by cannot be used for this problem.
        """
        ...


class Policy(Protocol):
    """Values the actions of a drone on a grid, learned or computed (method, section 15)."""

    def q_values(self, state: PolicyState) -> Floats:
        """Value of each action of `mintpilot.core.policy.steps`, shape (actions,): the best is taken.

        The unit is the edge of a cell: an exact value is minus the length of the move and of the shortest way on from
        where it ends, 0 at the goal; minus infinity where there is none. Values of actions that `PolicyTask.allowed`
        rules out do not count. Equal states give equal values.

        Raises:
            InputError: the policy was made for another grid, or its numbers are no values.
        """
        ...


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class QuerySituation:
    """What a query objective may look at. Joint hypotheses are flattened; those with no probability are left out."""

    probability: Floats
    """(n,) sums to one."""
    class_of: Ints
    """(n,) plan class of each joint hypothesis, 0 to m - 1."""
    regret_s: Floats
    """(p, n) seconds lost by flying plan i under hypothesis j instead of the best; the price of failure where it would
    fail. First the plans of the classes, then other safe plans; of very large trees only the likeliest classes'."""
    parts: SmallInts
    """(q, n) the part of each candidate query that holds each joint hypothesis: the true answer."""
    part_count: Ints
    """(q,) the number of parts of each query, 2 to `mintpilot.core.query.MAX_PARTS`."""
    effort: Floats
    """(q,) how many times as long as a yes or no the answer to each query takes (`mintpilot.core.query.Query.effort`);
    the worth of a query counts for the operator's time."""
    settings: AskingSettings


class QueryObjective(Protocol):
    """The worth of candidate queries (method, section 4). Called once per question."""

    def scores(self, situation: QuerySituation) -> Floats:
        """Worth of each candidate (q,); higher is better; 0 or less: not worth asking.

        Raises:
            LimitError: the situation is larger than the objective can handle.
        """
        ...


class Proposer(Protocol):
    """Proposes queries, e.g. a language model. What it proposes is checked, and scored like any query."""

    @property
    def name(self) -> str:
        """For the record: who proposed a query."""
        ...

    def propose(self, mint: Mint) -> tuple[Query, ...]:
        """Queries over gaps that the tree branches on, in bounded time; none where it fails. Never raises."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LookOption:
    """A look that may be taken from here."""

    look: Look
    seconds: float
    """What it costs beside the plan: the flight there, the stay, and what the rest is dearer from there."""
    plan: Plan
    """The flight there and the stay."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Situation:
    """What a strategy decides on."""

    problem: PlanningProblem
    space: PlanSpace
    belief: Belief
    """Over all open gaps."""
    confirmed: frozenset[str]
    """Ids of obstacle gaps that got an explicit yes."""
    withdrawn: frozenset[str]
    """What is not to be asked again: see `mintpilot.core.query.is_refused`."""
    asked: tuple[Evidence, ...]
    """Queries that were answered, with the answer, oldest first."""
    silent: bool
    """True after a time-out: no more questions."""
    settings: AskingSettings
    """Its ``max_questions`` is what is left of the budget."""
    metric: ImpactMetric
    objective: QueryObjective
    proposer: Proposer | None = None
    """Whom a strategy may ask for queries that it does not find by itself; None: nobody."""
    looks: tuple[LookOption, ...] = ()
    """Looks that compete with queries (method, section 11)."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ask:
    """Put this query to the operator."""

    scored: ScoredQuery
    alternatives: tuple[ScoredQuery, ...] = ()
    mint: Mint | None = None
    proposed: tuple[ScoredQuery, ...] = ()
    """Queries that a `Proposer` proposed and that were sound, scored, best first."""
    bound_bits: float | None = None
    """No query of its kind could have a higher gain than this; None: not worked out."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Fly:
    """Ask no more; fly this plan (None: stay safe where you are)."""

    plan: Plan | None
    certificate: Certificate
    mint: Mint | None = None
    unsafe: bool = False
    """True only for baselines that fly through what is not known passable; refused outside a simulator."""
    proposed: tuple[ScoredQuery, ...] = ()
    """As in `Ask`, where proposals were looked at and none was worth asking."""
    notices: tuple[Message, ...] = ()
    """What the person should know of how this was decided, e.g. which bound on the work was met, in plain sentences."""


Decision: TypeAlias = Ask | Fly


class Strategy(Protocol):
    """A method of asking. One file each in ``strategies/``; compared by the benchmark."""

    def decide(self, situation: Situation) -> Decision:
        """Ask, or fly. Called again after every answer, with the new belief."""
        ...


class Operator(Protocol):
    """The person who knows: a terminal, a web page, a voice, or a script. No method blocks; several may be attached."""

    @property
    def attended(self) -> bool:
        """True where a person sits: simulators then run at the speed of the clock on the wall."""
        ...

    @property
    def hears_once(self) -> bool:
        """True where a question is heard, not seen: better words are waited for shortly before it is put."""
        ...

    def show(self, question: Question, patience_s: float) -> None:
        """Shows or says the question, with the consequences of each reply. The same id again: in better words.

        Args:
            question: its id is given back with the answer.
            patience_s: how long an answer is waited for from when it is shown, seconds.
        """
        ...

    def withdraw(self, question: str, why: str) -> None:
        """The question with that id is no longer open; ``why`` is a plain sentence. Unknown ids are nothing to do."""
        ...

    def tell(self, text: str) -> None:
        """Shows or says something that needs no answer, in the mission's language."""
        ...

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """What came since the last call: questions shown, answers, orders; oldest first.

        Args:
            time_s: the mission clock. What is brought carries times up to this one.

        Raises:
            DeviceError: nobody can be reached through it any more.
        """
        ...


class Understand(Protocol):
    """Reads free words as an answer."""

    def __call__(
        self,
        text: str,
        question: Question,
        timeout_s: float,
        *,
        by: AnsweredBy = AnsweredBy.TYPED,
        guarded: Collection[Reply] | None = None,
        pending: Reply | None = None,
    ) -> Reading:
        """What the words were read as, within about ``timeout_s`` seconds. Never raises for any text.

        Args:
            text: raw, as typed or heard; a key's name.
            question: what they answer.
            timeout_s: how long it may take, seconds.
            by: how they came.
            guarded: replies that would enlarge what the drone may do; None: judged from the query.
            pending: the reply that was just read back, if any.
        """
        ...


class TruthOracle(Protocol):
    """Knows the world, for scripted operators and for scoring; never used to plan."""

    def value_of(self, gap: KnowledgeGap) -> str | None:
        """The true value of the gap; None where it has none (its subject does not exist)."""
        ...


class Vehicle(Protocol):
    """Flies. A simulator or a link to an autopilot. It makes one motion at a time and hovers where it has none."""

    def state(self) -> VehicleState:
        """Where it is now."""
        ...

    def command(self, motion: Motion) -> None:
        """Begins a motion. The vehicle must be at rest; the end of the motion is told by `advance`, always."""
        ...

    def brake(self) -> None:
        """Brakes along the checked path and hovers; the motion then ends as stopped. Without a motion: nothing."""
        ...

    def advance(self, until_s: float) -> tuple[VehicleInput, ...]:
        """Lets time pass, at most up to that moment of its clock; less when something happens before.

        A simulator computes so far, a real vehicle waits. Nobody is called back meanwhile.

        Returns:
            What ended, and which of its links (position, control) went down or came up, oldest first.

        Raises:
            DeviceError: the link is gone. The vehicle is then in its own fail-safe.
        """
        ...

    def hold(self) -> None:
        """Comes to rest and hovers where it is. Safe to call at any time, also after a failure."""
        ...


class Camera(Protocol):
    """Takes pictures from the vehicle."""

    def capture(self) -> Frame:
        """The present view. Raises `DeviceError` when the camera is gone."""
        ...


class Judge(Protocol):
    """Says how a mission really went."""

    def verdict(self) -> Verdict | None:
        """A failure that has happened, as soon as it has; None while nothing went wrong."""
        ...

    def final(self) -> Verdict:
        """The verdict at the end, success included."""
        ...

    def people(self) -> tuple[int, int]:
        """(how many of the people who must be found were found so far, how many there are)."""
        ...


class Recorder(Protocol):
    """Keeps what happened."""

    def record(self, event: Event) -> None:
        """Keeps one event. Never raises for lack of disk in mid-flight: it notes the loss and goes on."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Completion:
    """What a language model returned."""

    text: str
    model: str
    seconds: float
    tokens: int = 0


class LanguageModel(Protocol):
    """Completes text. Never decides meaning (method, section 4). A method ``close``, if any, is called in the end."""

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:
        """One completion; with ``schema`` (a pydantic model) the text should be JSON of that form, but is not trusted.

        Raises:
            DeviceError: no answer within ``timeout_s``, or the model is gone.
        """
        ...


__all__ = [
    "Ask",
    "Camera",
    "Completion",
    "Decision",
    "Fly",
    "FrameSource",
    "ImpactMetric",
    "Judge",
    "LanguageModel",
    "Namer",
    "Operator",
    "Perception",
    "PlanMetric",
    "PlanSpace",
    "Planner",
    "Policy",
    "Proposer",
    "QueryObjective",
    "QuerySituation",
    "Recorder",
    "Situation",
    "SourceOptions",
    "Strategy",
    "TruthOracle",
    "Understand",
    "Vehicle",
]
