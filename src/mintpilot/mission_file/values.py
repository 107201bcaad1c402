"""The ordered values of a mission file: their checks, and the regions that they make (method, section 13)."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

from mintpilot.core.gap import BLOCKED, PASSABLE, CorrelationGroup, obstacle_id
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Region, SemanticMap
from mintpilot.core.threshold import ValueKind
from mintpilot.core.tolerances import SUM_TOLERANCE
from mintpilot.mapping.values import Value, cut_by
from mintpilot.mission_file.form_checks import nearest
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_world import MapWorld, NormalSpec, ValueSpec
from mintpilot.mission_file.yaml_places import Fault, Path_


@dataclass(frozen=True, slots=True, kw_only=True)
class Valued:
    """A map whose regions are cut where values decide, with what that brings."""

    map: SemanticMap
    groups: tuple[CorrelationGroup, ...]
    truths: dict[str, str]
    """Id of a region to its true value, where the value's truth is given."""


def with_values(map: SemanticMap, specs: tuple[ValueSpec, ...], limits: VehicleLimits) -> Valued:
    """The map with each region that a value decides as one region for each threshold."""
    by_region = {spec.of: spec for spec in specs}
    regions: list[Region] = []
    groups: list[CorrelationGroup] = []
    truths: dict[str, str] = {}
    for region in map.regions:
        spec = by_region.get(region.id)
        if spec is None:
            regions.append(region)
            continue
        parts, group = cut_by(region, value_of(spec), map.frame, limits)
        regions += parts
        groups += [group] if group is not None else []
        for part in parts if spec.truth is not None else ():
            free = part.threshold is not None and spec.truth is not None and spec.truth >= part.threshold.at_least_m
            truths[part.id] = PASSABLE if free else BLOCKED
    return Valued(map=replace(map, regions=tuple(regions)), groups=tuple(groups), truths=truths)


def value_of(spec: ValueSpec) -> Value:
    """The value, free of file formats."""
    normal = spec.prior if isinstance(spec.prior, NormalSpec) else None
    return Value(
        id=spec.id,
        kind=ValueKind(spec.what),
        least_m=spec.range[0],
        most_m=spec.range[1],
        points=() if isinstance(spec.prior, NormalSpec) else spec.prior,
        mean_m=normal.mean if normal else 0.0,
        sigma_m=normal.sigma if normal else 0.0,
    )


def value_faults(mission: MissionFile) -> Iterator[Fault]:
    """Every contradiction in the values of a mission file."""
    if mission.values and not isinstance(mission.world, MapWorld):
        yield _fault(
            ("values",), "values are of regions of a given map; here the drone sees for itself: remove 'values'"
        )
        return
    regions = {r.id: r for r in mission.world.regions} if isinstance(mission.world, MapWorld) else {}
    ids, measured = (Counter(getattr(v, key) for v in mission.values) for key in ("id", "of"))
    for index, value in enumerate(mission.values):
        path: Path_ = ("values", index)
        if ids[value.id] > 1:
            yield _fault((*path, "id"), f"'{value.id}' is the name of {ids[value.id]} values; give each its own")
        region = regions.get(value.of)
        if region is None:
            yield _fault((*path, "of"), f"there is no region '{value.of}'; {nearest(value.of, list(regions))}")
        elif measured[value.of] > 1:
            yield _fault((*path, "of"), f"region '{value.of}' has {measured[value.of]} values; give it one")
        else:
            for key in ("passable", "prior_passable", "truth", "mask"):
                if getattr(region, key) is not None:
                    message = f"region '{value.of}' has '{key}' besides the value '{value.id}'; keep one of them"
                    yield _fault((*path, "of"), message)
        if any(obstacle_id(value.of) in group.gaps for group in mission.correlations):
            message = f"region '{value.of}' is in a correlation; what its value '{value.id}' says of it would be lost"
            yield _fault((*path, "of"), message)
        yield from _range_faults(value, path)


def _range_faults(value: ValueSpec, path: Path_) -> Iterator[Fault]:
    least, most = value.range
    if not 0 <= least < most:
        yield _fault((*path, "range"), f"[{least:g}, {most:g}]: must rise, from 0 or more; metres")
        return
    if value.truth is not None and not least <= value.truth <= most:
        yield _fault((*path, "truth"), f"{value.truth:g} is not within the range [{least:g}, {most:g}]; metres")
    if isinstance(value.prior, NormalSpec):
        if not least <= value.prior.mean <= most:
            message = f"mean {value.prior.mean:g} is not within the range [{least:g}, {most:g}]; metres"
            yield _fault((*path, "prior", "mean"), message)
        return
    for number, (point, chance) in enumerate(value.prior):
        if not least <= point <= most:
            yield _fault((*path, "prior", number), f"{point:g} is not within the range [{least:g}, {most:g}]; metres")
        if not 0 <= chance <= 1:
            yield _fault((*path, "prior", number), f"{chance:g} is no probability from 0 to 1")
    total = sum(chance for _, chance in value.prior)
    if not math.isclose(total, 1, abs_tol=SUM_TOLERANCE):
        yield _fault((*path, "prior"), f"the probabilities sum to {total:g}; they must sum to 1")


def _fault(path: Path_, message: str) -> Fault:
    return Fault(path=path, line=None, message=message)
