"""Ordered values as regions: a passage, or the layers of a cloud, each free from a threshold on (method, section 13).

Every height at which a plan could change is the upper edge of a layer of voxels, so nothing is lost by cutting there.
Which of these thresholds any plan turns on is found by the joint search: the tree branches on no other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import BLOCKED, PASSABLE, CorrelationGroup, obstacle_id
from mintpilot.core.geometry import GridFrame, Ints
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Knowledge, Region
from mintpilot.core.threshold import Threshold, ValueKind
from mintpilot.core.tolerances import TOLERANCE

MAX_CUTS = 8
"""Most thresholds of one value; where there are more layers, neighbours count as one, free only if all of it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """An ordered value of one region, with what is believed of it: points with probabilities, or a normal distribution
    cut off at the ends of the range.
    """

    id: str
    kind: ValueKind
    least_m: float
    most_m: float
    points: tuple[tuple[float, float], ...] = ()
    """(value, probability); they sum to 1."""
    mean_m: float = 0.0
    sigma_m: float = 0.0
    """Of the normal distribution; not used where there are points."""

    def __post_init__(self) -> None:
        if not 0 <= self.least_m < self.most_m < math.inf:
            raise MissionError(f"value '{self.id}': range [{self.least_m:g}, {self.most_m:g}] must rise from 0 or more")
        if not self.points and not self.sigma_m > 0:
            raise MissionError(f"value '{self.id}': sigma = {self.sigma_m:g} must be above 0")

    def at_least(self, threshold_m: float) -> float:
        """Probability, 0 to 1, that the value is so large. It never rises with the threshold."""
        if threshold_m <= self.least_m:
            return 1.0
        if threshold_m > self.most_m:
            return 0.0
        if self.points:
            return min(1.0, sum(p for v, p in self.points if v >= threshold_m - TOLERANCE))
        low, high, here = (self._below(m) for m in (self.least_m, self.most_m, threshold_m))
        return 1.0 if high <= low else min(1.0, max(0.0, (high - here) / (high - low)))

    def _below(self, value_m: float) -> float:
        return 0.5 * (1 + math.erf((value_m - self.mean_m) / (self.sigma_m * math.sqrt(2))))


def cut_by(
    region: Region, value: Value, frame: GridFrame, limits: VehicleLimits
) -> tuple[tuple[Region, ...], CorrelationGroup | None]:
    """The region as one region for each threshold of its value, and how they hang together.

    Args:
        region: what is measured; its passability is open.
        value: what is believed of the measure.
        frame: the lattice of the region's cells.
        limits: of the vehicle: a passage must be as wide as its body with the clearance on both sides.

    Returns:
        The regions, the lowest threshold first, and their joint distribution; None for a single one. Parts of which
        the range already says that they are free, or that they are not, have that as a fact or prior.
    """
    parts = _layers(region, frame, value, limits)
    single = len(parts) == 1
    regions = tuple(
        replace(
            region,
            id=region.id if single else f"{region.id}-{number}",
            cells=cells,
            passable=Knowledge.NO if value.at_least(top_m) <= 0 else Knowledge.OPEN,
            prior_passable=value.at_least(top_m),
            description=_described(region.description, value, top_m),
            threshold=Threshold(of=value.id, subject=region.description, kind=value.kind, at_least_m=top_m),
        )
        for number, (top_m, cells) in enumerate(parts, 1)
    )
    open_ = [r for r in regions if r.passable is Knowledge.OPEN]
    return regions, None if len(open_) < 2 else _together(open_)


def _together(regions: Sequence[Region]) -> CorrelationGroup:
    """With one threshold reached so are all below it."""
    chances = [1.0, *(r.prior_passable or 0.0 for r in regions), 0.0]
    count = len(regions)
    return CorrelationGroup(
        gaps=tuple(obstacle_id(r.id) for r in regions),
        joint=tuple(
            ((PASSABLE,) * free + (BLOCKED,) * (count - free), chances[free] - chances[free + 1])
            for free in range(count + 1)
        ),
    )


def _layers(region: Region, frame: GridFrame, value: Value, limits: VehicleLimits) -> list[tuple[float, Ints]]:
    """(threshold, cells) of each part, lowest first."""
    if value.kind is ValueKind.CLEARANCE:
        return [(_rounded_up(2 * limits.clearance_m), region.cells)]
    if frame.is_flat:
        return [(_rounded_up(frame.box.centre_m[2] + limits.clearance_m), region.cells)]
    layer_of = np.unravel_index(region.cells, frame.shape)[0]
    tops_m = frame.origin_m[2] + (layer_of + 1) * frame.resolution_m
    unsure = np.unique(layer_of[(tops_m > value.least_m + TOLERANCE) & (tops_m <= value.most_m + TOLERANCE)])
    groups = [part for part in np.array_split(unsure, min(MAX_CUTS, max(1, len(unsure)))) if len(part)]
    made: list[tuple[float, Ints]] = []
    for part in groups:
        top_m = round(float(frame.origin_m[2] + (part[-1] + 1) * frame.resolution_m), 3)
        made.append((top_m, region.cells[np.isin(layer_of, part)]))
    above = region.cells[tops_m > value.most_m + TOLERANCE]
    if above.size:
        made.append((round(float(tops_m[np.isin(region.cells, above)].max()), 3), above))
    return made


def _rounded_up(value_m: float) -> float:
    """To whole centimetres, so that it can be said."""
    return math.ceil(value_m * 100 - TOLERANCE) / 100


def _described(description: str, value: Value, top_m: float) -> str:
    if value.kind is ValueKind.CLEARANCE:
        return description
    return f"{description} up to {top_m:g} m"
