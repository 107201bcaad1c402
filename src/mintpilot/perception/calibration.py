"""Confidences made true: what share of names said with 0.6 is right was counted, and is what is said from then on."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from mintpilot.core.errors import InputError
from mintpilot.core.observation import Frame, NameGuess, Segment
from mintpilot.core.ports import Namer

LEAST_PAIRS = 20
"""With fewer examples of a label nothing is known of its confidences, and they stay as they are."""
RIDGE = 2.0
"""Weight of the confidences as they were, in examples."""
MOST_CERTAIN = 0.88
"""What is never seen to be wrong among some hundred examples is not certain: so likely it is at most."""
_EDGE = 1e-4


class LabelScale(BaseModel):
    """Of one label: the log odds of its probability are multiplied, then shifted."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    scale: float = Field(gt=0, le=20, allow_inf_nan=False)
    shift: float = Field(ge=-20, le=20, allow_inf_nan=False)
    examples: int = Field(ge=0)
    """It was found from so many."""


class Calibration(BaseModel):
    """Of each namer, by its registered name, and each label."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    schema_version: int = Field(default=1, ge=1, le=1)
    made_by: str = ""
    """The command that found it."""
    only_lowers: bool = False
    """Found in drawn rooms, not in pictures of real places: it takes certainty away, and never gives any."""
    namers: dict[str, dict[str, LabelScale]]


class CalibratedNamer(Namer):
    """A namer whose confidences were measured.

    Args:
        namer: who names.
        scales: of its labels; those of others stay as they are.
        only_lowers: no confidence is raised.
    """

    def __init__(self, namer: Namer, scales: Mapping[str, LabelScale], *, only_lowers: bool = False) -> None:
        self._namer, self._scales, self._only_lowers = namer, scales, only_lowers

    def names(self, frame: Frame, segments: Sequence[Segment]) -> tuple[tuple[NameGuess, ...], ...]:
        """The namer's names with their true confidences; together at most as likely as before there is room for."""
        return tuple(self._calibrated(guesses) for guesses in self._namer.names(frame, segments))

    def _calibrated(self, guesses: Sequence[NameGuess]) -> tuple[NameGuess, ...]:
        said = {g.label: self._chance(g) for g in guesses}
        total = math.fsum(said.values())
        share = min(1.0, 0.999 / total) if total > 0 else 1.0
        made = (NameGuess(label=label, probability=p * share) for label, p in said.items())
        return tuple(sorted(made, key=lambda g: (-g.probability, g.label)))

    def _chance(self, guess: NameGuess) -> float:
        scale = self._scales.get(guess.label)
        if scale is None:
            return guess.probability
        most = guess.probability if self._only_lowers else max(MOST_CERTAIN, guess.probability)
        return min(most, _logistic(scale.scale * _odds(guess.probability) + scale.shift))


def fit(said: Sequence[float], right: Sequence[bool]) -> LabelScale | None:
    """The scale that makes the probabilities of one label true, by logistic regression (Platt); None for few examples.

    Args:
        said: probabilities, 0 to 1.
        right: whether each of them was right.
    """
    if len(said) < LEAST_PAIRS:
        return None
    odds = np.array([_odds(p) for p in said])
    wins = np.array(right, float)
    many, few = wins.sum(), len(wins) - wins.sum()
    wanted = np.where(wins > 0, (many + 1) / (many + 2), 1 / (few + 2))
    at = np.array([1.0, 0.0])
    features = np.column_stack([odds, np.ones_like(odds)])
    for _ in range(50):  # Newton's steps, damped; the aim is convex
        p = 1 / (1 + np.exp(-np.clip(features @ at, -30, 30)))
        slope = features.T @ (p - wanted) + RIDGE * (at - (1.0, 0.0))
        curve = (features * (p * (1 - p))[:, None]).T @ features + RIDGE * np.eye(2)
        at = at - np.clip(np.linalg.solve(curve, slope), -1.0, 1.0)
    return LabelScale(
        scale=round(float(np.clip(at[0], 0.05, 20)), 4),
        shift=round(float(np.clip(at[1], -20, 20)), 4),
        examples=len(said),
    )


def read_calibration(path: Path) -> Calibration:
    """Reads what `mintpilot bench perception --calibrate` wrote.

    Raises:
        InputError: it cannot be read, or is no calibration.
    """
    try:
        return Calibration.model_validate_json(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, ValidationError) as error:
        what = str(error).split("\n", 1)[0]
        raise InputError(
            f"'{path}' is no calibration ({what}); make one: mintpilot bench perception --calibrate FILE"
        ) from None


def _odds(p: float) -> float:
    clipped = min(1 - _EDGE, max(_EDGE, p))
    return math.log(clipped / (1 - clipped))


def _logistic(x: float) -> float:
    return 1 / (1 + math.exp(-min(30.0, max(-30.0, x))))
