"""Calibration of the conformal asker, on worlds of its own (seeds that no experiment flies in)."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from functools import lru_cache
from importlib.resources import files

import numpy as np

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import World
from mintpilot.benchmark.experiment import Cell, Part
from mintpilot.benchmark.methods import Method
from mintpilot.core.errors import InfeasibleError
from mintpilot.mission.rehearsal import begin

FIRST_SEED = 1_000_000
"""Experiments count from small seeds; calibration worlds lie far off."""
WORLDS = 200
"""For each number of gaps."""
COVERAGE = 0.95
"""The prediction set holds the true plan class with this probability: 1 - alpha of `AskingSettings`."""


class Calibration(Part):
    """What the committed file says."""

    command: str
    coverage: float
    worlds: int
    first_seed: int
    quantiles: dict[str, float]
    """Number of gaps → q."""


@lru_cache(maxsize=1)
def committed() -> Calibration:
    """The calibration that experiments use; made by the command that it names."""
    return Calibration.model_validate(json.loads(files("mintpilot.benchmark").joinpath("knowno.json").read_text()))


def calibrated(method: Method, k: int) -> Method:
    """The method, with the quantile for k gaps if it is the conformal asker."""
    if method.strategy != "knowno":
        return method
    return method.model_copy(update={"arguments": {"quantile": committed().quantiles[str(k)]}})


def quantile(scores: Sequence[float], coverage: float) -> float:
    """The conformal quantile: the ceil((n + 1) coverage)-th smallest score; 1 where there are too few scores for it."""
    rank = math.ceil((len(scores) + 1) * coverage)
    return 1.0 if rank > len(scores) else float(sorted(scores)[rank - 1])


def nonconformity(world: World) -> float | None:
    """One minus the probability of the true plan class at the first deliberation.

    None where nothing can be flown, or the truth is not a hypothesis of the tree.
    """
    parts = deliberation_parts(world, Choices())
    try:
        mint = begin(parts, world.map).deliberated().decision.mint
    except InfeasibleError:
        return None
    if mint is None:
        return None
    truths = [world.truth.value_of(gap) for gap in mint.belief.gaps]
    if any(value is None for value in truths):
        return None
    index = tuple(gap.values.index(str(value)) for gap, value in zip(mint.belief.gaps, truths, strict=True))
    number = int(np.asarray(mint.class_of)[index])
    return None if number < 0 else 1.0 - mint.classes[number].probability


def calibrate(cell: Cell, worlds: int = WORLDS, coverage: float = COVERAGE) -> float:
    """The quantile for worlds of that kind."""
    from mintpilot.benchmark.conditions import true_world

    scores = [nonconformity(true_world(cell, seed)) for seed in range(FIRST_SEED, FIRST_SEED + worlds)]
    return quantile([score for score in scores if score is not None], coverage)
