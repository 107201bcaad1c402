"""A mission: what is to be done, by which vehicle, with which tolerances; and how it ended."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

from mintpilot.core.errors import MissionError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.plan import VehicleLimits


class CriticalityRule(StrEnum):
    """Which differences make a gap critical (method, section 3)."""

    PAPER = "paper"
    """Cost or divergence above its threshold."""
    REGRET = "regret"
    """Cost above its threshold."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AskingSettings:
    """Thresholds and bounds of reasoning and asking, in the symbols of the method."""

    rule: CriticalityRule = CriticalityRule.REGRET
    delta_c_s: float = 2.0
    """Cost difference that is worth a question [delta_c], seconds."""
    delta_d_m: float = 2.0
    """Divergence that is worth a question under the paper's rule [delta_d], metres."""
    goal_entropy_bits: float = 0.3
    """A target gap with more entropy than this is critical."""
    alpha: float = 0.05
    """Stop asking when one plan class holds at least ``1 - alpha``."""
    alpha_safe: float = 0.01
    """A region counts as passable from a posterior of ``1 - alpha_safe`` on, after an explicit yes."""
    answer_error: float = 0.0
    """Probability that an answer is the opposite of the truth [e]."""
    floor: float = 1e-6
    """Joint hypotheses below this probability are not planned for."""
    question_price_s: float = 0.0
    """What a question costs the person, in seconds of flight; only objectives that weigh it use it."""
    failure_price_s: float = 600.0
    """What a failed mission counts for, in seconds of flight, where expected losses are weighed."""
    max_questions: int = 20
    """Budget of questions."""
    patience_s: float = 30.0
    """How long an answer is waited for, seconds."""
    objective: str = "information-gain"
    """Name of the query objective."""
    max_nodes: int = 4096
    """Bound on the tree's nodes; what lies beyond gets the cautious plan."""
    max_joint: int = 65536
    """Bound on joint hypotheses held in the belief; gaps beyond it count at their cautious value."""
    impact_metric: str = "frechet"
    """Name of the distance between paths."""

    def __post_init__(self) -> None:
        for name in ("alpha", "alpha_safe", "floor"):
            if not 0 <= getattr(self, name) < 1:
                raise MissionError(f"asking {name} = {getattr(self, name)}: must be at least 0 and below 1")
        if not 0 <= self.answer_error < 0.5:
            raise MissionError(
                f"asking answer_error = {self.answer_error}: must be at least 0 and below 0.5; "
                "answers that are wrong half the time tell nothing"
            )
        for name in (
            "delta_c_s",
            "delta_d_m",
            "goal_entropy_bits",
            "question_price_s",
            "failure_price_s",
            "patience_s",
            "max_questions",
        ):
            if not getattr(self, name) >= 0:
                raise MissionError(f"asking {name} = {getattr(self, name)}: must not be below 0")
        for name in ("max_nodes", "max_joint"):
            if getattr(self, name) < 1:
                raise MissionError(f"asking {name} = {getattr(self, name)}: must be at least 1")


@dataclass(frozen=True, slots=True, kw_only=True)
class SurveySettings:
    """The flight that makes the map, before anything is decided."""

    spacing_m: float = 4.0
    """Between places to look around from, about, metres."""
    speed_mps: float = 2.0
    """Between those places."""
    longest_s: float = 240.0
    """No new place is flown to after this time, seconds."""


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


class Outcome(StrEnum):
    """How a mission ended. Expected endings are values, not errors."""

    SUCCESS = "success"
    """Every sub-goal reached, everybody present found, nothing touched, within endurance."""
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
    NOT_REACHED = "not-reached"
    """The flight ended before every sub-goal was reached."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What really happened, as the simulator saw it; on a real vehicle, as far as it is known."""

    outcome: Outcome
    reason: str
    """One plain sentence."""
