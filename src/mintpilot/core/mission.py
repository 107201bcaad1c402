"""A mission: what is to be done, by which vehicle, with which tolerances; and how it ended."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import Any

from mintpilot.core.errors import MissionError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.georeference import Georeference
from mintpilot.core.message import Message
from mintpilot.core.plan import LeftUndone, Look, VehicleLimits


class CriticalityRule(StrEnum):
    """Which differences make a gap critical (method, section 3)."""

    PAPER = "paper"
    """Cost or divergence above its threshold."""
    REGRET = "regret"
    """Cost above its threshold."""


class WhileWaiting(StrEnum):
    """What the drone does while a question is open (method, section 10)."""

    HOLD = "hold"
    """It hovers."""
    MOVE = "move"
    """It flies on through known free space, to where the answer will cost least."""


class QueryKinds(StrEnum):
    """Which kinds of query may be put (method, section 13)."""

    YES_NO = "yes-no"
    """Only what is answered by yes or no."""
    ANY = "any"
    """Choices among up to four named options, too."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Bounds:
    """What a setting is, and between which limits."""

    meaning: str
    """One sentence, with the unit; it stands in the mission file's schema."""
    least: float | None = None
    """Smallest value allowed."""
    below: float | None = None
    """The value must be below this."""
    why: str = ""
    """Why, where that is not plain."""

    def check(self, name: str, value: float) -> None:
        """Raises `MissionError` where the value of that setting is out of bounds."""
        if (self.least is None or value >= self.least) and (self.below is None or value < self.below):
            return
        if self.below is not None:
            rule = f"must be at least {self.least:g} and below {self.below:g}"
        else:
            rule = "must not be below 0" if self.least == 0 else f"must be at least {self.least:g}"
        raise MissionError(f"asking {name} = {value}: {rule}{f'; {self.why}' if self.why else ''}")


def setting(
    default: Any, meaning: str, *, least: float | None = None, below: float | None = None, why: str = ""
) -> Any:
    """A field of `AskingSettings`: the schema of mission files is made of these."""
    bounds = Bounds(meaning=meaning, least=least, below=below, why=why)
    return field(default=default, metadata={"bounds": bounds})


QUESTIONS = 20
"""Budget of questions where answers are never wrong."""
MOST_REPEATS = 10
"""However often answers are wrong, the budget is no more than this many times as large."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AskingSettings:
    """Thresholds and bounds of reasoning and asking, in the symbols of the method.

    The schema of mission files is made of these fields: names, types, defaults, bounds and sentences stand here only.

    Raises:
        MissionError: a value is out of its bounds.
    """

    rule: CriticalityRule = setting(  # noqa: RUF009  (a field, with its words)
        CriticalityRule.REGRET,
        "Which differences make a gap critical: cost or divergence (`paper`), or cost alone (`regret`).",
    )
    delta_c_s: float = setting(2.0, "Cost difference that is worth a question, seconds.", least=0)
    delta_d_m: float = setting(2.0, "Divergence that is worth a question under the paper's rule, metres.", least=0)
    goal_entropy_bits: float = setting(0.3, "A target gap with more entropy than this is critical, bits.", least=0)
    alpha: float = setting(0.05, "Stop asking when one plan class holds at least 1 - alpha.", least=0, below=1)
    alpha_safe: float = setting(
        0.01,
        "A region counts as passable from a posterior of 1 - alpha_safe on, after an explicit yes.",
        least=0,
        below=1,
    )
    answer_error: float = setting(
        0.0,
        "Probability that an answer is the opposite of the truth, as the drone believes.",
        least=0,
        below=0.5,
        why="answers that are wrong half the time tell nothing",
    )
    floor: float = setting(1e-6, "Joint hypotheses below this probability are not planned for.", least=0, below=1)
    question_price_s: float = setting(
        0.0,
        "What a question costs the person, in seconds of flight: asking stops where no policy of asking is worth it.",
        least=0,
    )
    failure_price_s: float = setting(
        600.0,
        "What a failed mission counts for, in seconds of flight, where expected losses are weighed. Unset: 600, or ten "
        "flights across the map where that is longer.",
        least=0,
    )
    max_questions: int | None = setting(
        None,
        f"Budget of questions. Unset: {QUESTIONS}, times how often a fact must be heard until it is sure where answers "
        "may be wrong (`answer_error`).",
        least=0,
    )
    patience_s: float = setting(
        30.0, "How long an answer is waited for at most, seconds; less where the battery needs it.", least=0
    )
    reply_s: float = setting(
        10.0, "Seconds that a yes or no is expected to take: what the battery may lose meanwhile is weighed.", least=0
    )
    kinds: QueryKinds = setting(  # noqa: RUF009  (a field, with its words)
        QueryKinds.YES_NO,
        "Which kinds of question are put: those answered by yes or no (`yes-no`), or choices among up to four named "
        "options as well (`any`), which count 1.6 times as long as a yes or no.",
    )
    while_waiting: WhileWaiting = setting(  # noqa: RUF009  (a field, with its words)
        WhileWaiting.MOVE,
        "What the drone does while a question is open: hover (`hold`), or fly on through known free space to where the "
        "answer will cost least (`move`).",
    )
    answer_valid_s: float = setting(
        600.0, "How long a yes for a region counts, seconds; then it is asked again.", least=0
    )
    objective: str = setting("information-gain", "Name of the query objective.")
    max_nodes: int = setting(4096, "Bound on the tree's nodes.", least=1)
    max_joint: int = setting(65536, "Bound on the joint hypotheses held.", least=1)
    impact_metric: str = setting("frechet", "Name of the metric between paths; `q-value:FILE`: by a policy.")

    def __post_init__(self) -> None:
        for one in fields(self):
            bounds: Bounds = one.metadata["bounds"]
            value = getattr(self, one.name)
            if bounds.least is not None and value is not None:
                bounds.check(one.name, value)

    @property
    def question_budget(self) -> int:
        """How many questions may be put in all.

        An answer that is wrong with probability e moves the log odds by (1 - 2e) ln((1 - e) / e) on average; a fact is
        sure from the odds (1 - alpha_safe) : alpha_safe on, starting from even ones.
        """
        if self.max_questions is not None:
            return self.max_questions
        if self.answer_error == 0:
            return QUESTIONS
        wrong, doubt = self.answer_error, max(self.alpha_safe, self.floor, 1e-6)
        gained = (1 - 2 * wrong) * math.log((1 - wrong) / wrong)
        return QUESTIONS * min(MOST_REPEATS, max(1, math.ceil(math.log((1 - doubt) / doubt) / gained)))


@dataclass(frozen=True, slots=True, kw_only=True)
class SurveySettings:
    """The flight that makes the map, before anything is decided."""

    spacing_m: float = 4.0
    """Between places to look around from, about, metres."""
    speed_mps: float = 2.0
    """Between those places."""
    longest_s: float = 240.0
    """No new place is flown to after this time, seconds."""


class ReturnRule(StrEnum):
    """Whether the drone flies back to the start once its task is done."""

    REQUIRED = "required"
    """Every plan leaves enough battery for the way back."""
    IF_POSSIBLE = "if-possible"
    """It does where the battery that is left suffices; no stop is left undone for it."""
    NONE = "none"
    """It stays where its last stop was."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mission:
    """Everything the loop needs to know of a mission, free of file formats."""

    name: str
    instruction: str
    """The words of the person who gave it."""
    start_m: Vec3
    """Where the drone takes off (its hover point above the pad)."""
    volume: Box
    """Where it may fly."""
    limits: VehicleLimits = field(default_factory=VehicleLimits)
    asking: AskingSettings = field(default_factory=AskingSettings)
    survey: SurveySettings | None = field(default_factory=SurveySettings)
    """None where the map is given."""
    prior_passable: float = 0.5
    """For regions that name none."""
    prior_occupied: float = 0.5
    """For rooms that name none."""
    resolution_m: float = 0.2
    """Edge of a voxel, metres."""
    georeference: Georeference | None = None
    """Where the map lies on the earth; None: not known."""
    people_price_s: float | None = None
    """What leaving somebody unseen costs, seconds of flight; None: ``asking.failure_price_s``."""
    looks: tuple[Look, ...] = ()
    """From where gaps can be settled by looking."""
    returns: ReturnRule = ReturnRule.NONE
    """Whether the drone flies back to the start once its task is done."""

    def __post_init__(self) -> None:
        if self.people_price_s is not None and not 0 <= self.people_price_s < math.inf:
            raise MissionError(f"people_price_s = {self.people_price_s}: must be finite and not below 0")


class Outcome(StrEnum):
    """How a mission ended. Expected endings are values, not errors."""

    SUCCESS = "success"
    """Every sub-goal reached, everybody present found, nothing touched, within endurance."""
    PARTIAL = "partial"
    """Some stops were done, others knowingly left: the reason names them, and what ran short."""
    COLLISION = "collision"
    """The drone touched something."""
    TOXIC_SMOKE = "toxic-smoke"
    """It entered smoke that is not safe."""
    ENDURANCE = "endurance"
    """It ran out of flight time."""
    LEFT_VOLUME = "left-volume"
    """It left the volume where it may fly."""
    WRONG_TARGET = "wrong-target"
    """It took or reached something other than what was meant."""
    PERSON_MISSED = "person-missed"
    """Somebody who was there was not found."""
    NO_SAFE_PLAN = "no-safe-plan"
    """Nothing that is known to be safe leads there: the drone stayed, returned or landed."""
    ABORTED = "aborted"
    """The operator ended it."""
    VEHICLE_FAILED = "vehicle-failed"
    """The vehicle or its link failed; it holds or lands by itself."""
    RULE_BROKEN = "rule-broken"
    """A rule of the mission was broken."""
    NOT_REACHED = "not-reached"
    """The flight ended before every sub-goal was reached."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Achieved:
    """A stop that was done."""

    n: int
    """Number of its step."""
    text: Message
    """What was done, as a short sentence without a full stop."""
    at_s: float
    """When, seconds since the task began."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Left:
    """A stop that was not done."""

    n: int
    """Number of its step."""
    text: Message
    """What was not done, as a short sentence without a full stop."""
    reason: Message
    """Why, with the figures, as a clause without a full stop."""
    resource: str
    """What ran short: a value of `mintpilot.core.plan.Shortage`, or ``ended`` where the mission ended before it."""
    needed_s: float | None = None
    """Seconds that it would have taken."""
    available_s: float | None = None
    """Seconds that there were."""


def left_of(undone: LeftUndone) -> Left:
    """What a plan leaves undone, as it is told."""
    return Left(
        n=undone.stop.step,
        text=undone.stop.said,
        reason=undone.reason,
        resource=undone.resource.value,
        needed_s=undone.needed_s,
        available_s=undone.available_s,
    )


class Sight(StrEnum):
    """What a look into a room came to."""

    FOUND = "found"
    EMPTY = "empty"
    """Seen, and nothing of what was asked for is there."""
    UNSEEN = "could-not-see"


@dataclass(frozen=True, slots=True, kw_only=True)
class Looked:
    """The result of a look into a room."""

    n: int
    """Number of its step."""
    text: Message
    """The step, as a short sentence without a full stop."""
    result: Sight
    what: str = ""
    """The class of what was asked for; empty: whatever is there."""
    count: int = 0
    """How many of it were found."""
    objects: tuple[str, ...] = ()
    """Ids of those of them that are on the map."""
    seen_share: float = 0.0
    """Share of the doorway through which the room was seen, 0 to 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Waiting:
    """What waiting for answers took."""

    delay_s: float = 0.0
    """From questions shown to their answers, or to the end of waiting, seconds."""
    hidden_s: float = 0.0
    """Of that, what the drone flew meanwhile towards what had to be flown anyway, by its plans, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What really happened, as the simulator saw it; on a real vehicle, as far as it is known."""

    outcome: Outcome
    reason: Message
    """One plain sentence."""
    achieved: tuple[Achieved, ...] = ()
    """What was done, in order."""
    left: tuple[Left, ...] = ()
    """What was to be done and was not."""
    looks: tuple[Looked, ...] = ()
    """What looks into rooms came to, in order."""
    waiting: Waiting = Waiting()
    rules_broken: tuple[str, ...] | None = None
    """Words of the rules that the flight broke; empty: it kept all; None: nobody judged that."""
