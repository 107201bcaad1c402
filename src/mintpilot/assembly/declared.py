"""What a mission file declares to be true of its map: for scripted operators and for the judge, never to plan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import PERSON
from mintpilot.core.plan import Stop
from mintpilot.core.ports import TruthOracle
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Action, Task
from mintpilot.uncertainty.findings import Findings, find_gaps


class DeclaredTruth(TruthOracle):
    """Knows what a mission file declares under ``truth``."""

    def __init__(self, truths: Mapping[str, str]) -> None:
        self._truths = dict(truths)

    def value_of(self, gap: KnowledgeGap) -> str | None:
        """The declared value of the gap's subject; for one of several areas of a mask, that of the mask."""
        for name in (gap.id, gap.subject, gap.subject.rpartition("-")[0]):
            value = self._truths.get(name)
            if value in gap.values:
                return value
        if gap.kind is GapKind.TARGET:
            meant = [v for v in self._truths.values() if v in gap.values]
            return meant[0] if len(meant) == 1 else None
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """What a mission on a given map has to come to, as far as its file tells."""

    objects: tuple[str, ...]
    """Ids of what is to be reached or taken, in order; empty where several may be meant and no truth is given."""
    places: Mapping[str, Vec3]
    """Those of them that are bare places, metres."""
    people: frozenset[str]
    """Ids of the objects that are people to be found."""


def wanted_of(map: SemanticMap, task: Task, truths: Mapping[str, str], start_m: Vec3) -> Wanted:
    """What the task means, resolved by the declared truth.

    Args:
        map: the map that was given.
        task: what is to be done on it.
        truths: subject of a gap → its declared value.
        start_m: where the drone takes off, metres.
    """
    findings = find_gaps(map, task, start_m=start_m)
    stops = [s for s in findings.stops if not s.optional and s.action is not Action.LOOK]
    named = {o.id for o in map.objects} | {room.id for room in map.rooms}
    places = {s.id: s.sites[0].position_m for s in stops if not s.gap and s.sites[0].label not in named}
    meant = [s.id if s.id in places else _meant(s, findings, DeclaredTruth(truths)) for s in stops]
    rooms = {room.id for room in map.rooms}
    people = {o.id for o in map.objects if o.label == PERSON and (task.seeks_people or o.id in meant)}
    return Wanted(objects=tuple(name for name in meant if name not in rooms), places=places, people=frozenset(people))


def _meant(stop: Stop, findings: Findings, truth: DeclaredTruth) -> str:
    """Id of the thing that the stop is really about; empty where that is not declared."""
    for gap in findings.gaps:
        if gap.id == stop.gap:
            return truth.value_of(gap) or ""
    return stop.sites[0].label
