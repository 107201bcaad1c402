"""What a simulated flight did, moment by moment, in the terms of rules: measured anew, for the judge alone.

No code of planning is used, nor of what binds rules for it: names are looked up here, distances are exact ones to the
surfaces of cells, and the way between two poses is looked at every `APART_M`.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.observation import PERSON, RegionKind
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.core.task import Action, SubGoal, Task

APART_M = 0.02
"""Moments of a flight are at most so far apart, metres."""
_CHUNK = 2_000_000
"""So many distances are worked out at once."""


@dataclass(slots=True, eq=False)
class FlownTrace:
    """The moments of one flight.

    Args:
        map: what the rules speak of.
        task: its steps.
        radius_m: of the body.
    """

    map: SemanticMap
    task: Task
    radius_m: float
    _ways: list[Floats] = field(default_factory=list)
    _there: list[tuple[int, str]] = field(default_factory=list)
    """(moment, stop id) of each stop that was done: it is done at the moment after."""

    @property
    def moments(self) -> int:
        """How many there are."""
        return sum(map(len, self._ways))

    def fly(self, way_m: Floats) -> None:
        """Adds a flown way (n, 3), metres."""
        steps = np.linalg.norm(np.diff(way_m, axis=0), axis=1)
        counts = np.maximum(1, np.ceil(steps / APART_M)).astype(int)
        pieces = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(way_m[:-1], way_m[1:], counts, strict=True)]
        self._ways.append(np.concatenate([*pieces, way_m[-1:]]))

    def do(self, stop_id: str) -> None:
        """Adds that a stop was done where the flight is."""
        self._there.append((self.moments, stop_id))
        self._ways.append(np.repeat(self._ways[-1][-1:], 2, axis=0))

    def of(self, about: str, subject: str, metres: float) -> Bools:
        """The truth (moments,) of a proposition."""
        points = np.concatenate(self._ways)
        if about in ("in", "inside", "touches", "within"):
            return self._spatial(about, self._region(subject), metres, points)
        found = np.zeros(len(points), bool)
        for moment, stop_id in self._there:
            begins, ends = self._does(about, subject, stop_id, points[moment])
            if about == "at":
                found[moment : moment + 2] |= begins
            elif begins or ends:
                found[moment + 1 :] = begins
        return found

    def _does(self, about: str, subject: str, stop_id: str, at_m: Floats) -> tuple[bool, bool]:
        """Whether a stop makes a proposition true, and whether it makes it false."""
        action, goal = self._step(stop_id)
        match about:
            case "at" | "did":
                return goal is not None and goal.id == subject, False
            case "looked":
                rooms = [subject]
                if goal is not None and goal.id == subject:  # by its step: whichever room that was
                    rooms = [room.id for room in self.map.rooms]
                looks = action in ("look", "count", "report")
                return looks and any(self._sees_into(room, stop_id, at_m) for room in rooms), False
            case _:
                taken = (goal.thing or goal.reference) if goal is not None else None
                words = {taken.label, taken.object_id, *taken.phrase.split()} if taken is not None else set()
                return action == Action.PICK and subject in words, action == Action.DELIVER

    def _step(self, stop_id: str) -> tuple[str, SubGoal | None]:
        """``pick:2:box-1`` is of the second sub-goal; ``look:room-1`` is of none."""
        action, _, rest = stop_id.partition(":")
        number = rest.partition(":")[0]
        known = number.isdigit() and 0 < int(number) <= len(self.task.subgoals)
        return action, self.task.subgoals[int(number) - 1] if known else None

    def _sees_into(self, room_id: str, stop_id: str, at_m: Floats) -> bool:
        """Whether that room's door is near and in sight, or is what the stop is named after."""
        room = next((r for r in self.map.rooms if r.id == room_id), None)
        if room is None:
            return False
        if stop_id != f"look:{room_id}" and float(np.linalg.norm(np.subtract(room.viewpoint_m, at_m))) > 1.0:
            return False
        frame, door = self.map.frame, np.array(room.door_m.centre_m)
        line = np.linspace(at_m, door, 2 + int(np.linalg.norm(door - at_m) / 0.05))
        cells = [tuple(np.clip(cell, 0, np.array(frame.shape) - 1)) for cell in frame.cells_of(line)]
        smoke = np.zeros(frame.size, bool)
        for region in self.map.regions:
            smoke[region.cells] |= region.kind is RegionKind.SMOKE
        if any(smoke.reshape(frame.shape)[cell] for cell in cells):
            return False
        free = [self.map.cells[cell] == Cell.FREE for cell in cells]
        return True not in free[free.index(False) :] if False in free else True

    def _region(self, subject: str) -> Bools:
        """Flags (nz, ny, nx) of what a name means: regions, or parts of one, or things."""
        frame = self.map.frame
        found = np.zeros(frame.size, bool)
        named = [r for r in self.map.regions if subject in (r.id, r.kind)]
        for region in named or [r for r in self.map.regions if r.id.rpartition("-")[0] == subject]:
            if named or region.id.rpartition("-")[2].isdigit():
                found[region.cells] = True
        found = found.reshape(frame.shape)
        if found.any():
            return found
        bare = subject.removeprefix("the ")
        labels = {bare, bare.removesuffix("s"), bare.removesuffix("es")}
        labels |= {PERSON} if bare in ("people", "persons") else set()
        edge_m, axes = frame.resolution_m, 2 if frame.is_flat else 3
        for thing in self.map.objects:
            if thing.id == subject or thing.label in labels:
                lo = np.floor((np.array(thing.box_m.lo_m) - frame.origin_m) / edge_m - 1e-6)
                hi = np.floor((np.array(thing.box_m.hi_m) - frame.origin_m) / edge_m + 1e-6) + 1
                spans = [slice(max(0, int(lo[i])), max(0, int(hi[i]))) for i in range(axes)]
                found[(*[slice(None)] * (3 - axes), *spans[::-1])] = True
        return found

    def _spatial(self, about: str, region: Bools, metres: float, points: Floats) -> Bools:
        frame = self.map.frame
        own = np.moveaxis(np.clip(frame.cells_of(points), 0, np.array(frame.shape) - 1), -1, 0)
        centre_in = region[tuple(own)]
        match about:
            case "in":
                return np.asarray(centre_in)
            case "inside":
                return np.asarray(centre_in & (self._away_m(~region, points) >= self.radius_m - 1e-9))
            case "within":
                return np.asarray(centre_in | (self._away_m(region, points) <= metres + self.radius_m))
            case _:
                return np.asarray(centre_in | (self._away_m(region, points) < self.radius_m))

    def _away_m(self, solid: Bools, points: Floats) -> Floats:
        """Metres (n,) from points outside to the nearest surface of these cells; on a flat map heights do not count."""
        frame = self.map.frame
        axes = 2 if frame.is_flat else 3
        rim = solid.copy()
        for axis in range(3 - axes, 3):
            for shift in (1, -1):
                beside = np.roll(solid, shift, axis)
                edge = [slice(None)] * 3
                edge[axis] = slice(0, 1) if shift == 1 else slice(-1, None)
                beside[tuple(edge)] = True
                rim &= beside
        surface = frame.centres_of(np.argwhere(solid & ~rim))[:, :axes]
        found = np.full(len(points), np.inf)
        if not len(surface):
            return found
        step = max(1, _CHUNK // len(surface))
        for i in range(0, len(points), step):
            apart = np.abs(points[i : i + step, None, :axes] - surface[None])
            gap = np.maximum(apart - frame.resolution_m / 2, 0)
            found[i : i + step] = np.sqrt((gap**2).sum(axis=2)).min(axis=1)
        return found
