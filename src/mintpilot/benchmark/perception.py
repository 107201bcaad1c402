"""How well perception sees: rooms in many styles, with the truth known, counted thing by thing."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from mintpilot.benchmark.intervals import student, wilson
from mintpilot.benchmark.perception_scenes import SeenRoom, seen_rooms
from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import OBJECT, PERSON
from mintpilot.core.ports import Perception
from mintpilot.simulation.furnished.shapes import Shown
from mintpilot.simulation.furnished.style import Style
from mintpilot.uncertainty.doubts import is_doubtful_person

NEAR_M: Final = 0.3
"""A thing is found by an object whose middle is nearer than this."""
BODY_M: Final = 0.6
"""A person is found by one whose middle is nearer on the ground: arms and legs may be missing."""
DOOR_M: Final = 0.4
"""A door is found by one whose middle is nearer on the ground."""
BINS: Final = 10
"""Of confidences, for the calibration error."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PerceptionRow:
    """One figure."""

    name: str
    value: float
    n: int
    """Out of how many."""
    low: float | None = None
    high: float | None = None
    """Ends of the 95 % interval; None where there is none."""
    wanted: str = ""
    """What is to be reached."""


@dataclass(slots=True)
class Tally:
    """Counts over rooms."""

    rooms: int = 0
    found: Counter[str] = field(default_factory=Counter)
    """By kind: what could be seen and was found."""
    could: Counter[str] = field(default_factory=Counter)
    """By kind: what could be seen."""
    off_m: list[float] = field(default_factory=list)
    """Distances of things from where they are."""
    named: list[tuple[float, bool]] = field(default_factory=list)
    """Probability of a likeliest name, and whether it was right, of everything that was seen."""
    claims: list[bool] = field(default_factory=list)
    """Whether a name that was claimed is right."""
    colours: list[bool] = field(default_factory=list)
    false: dict[str, list[int]] = field(default_factory=dict)
    """By kind: how many mistakes in each room."""
    missed: Counter[str] = field(default_factory=Counter)
    """By name: what was not found."""
    objects: int = 0
    """That were found at all."""

    def mistake(self, kind: str, count: int) -> None:
        """Takes down the mistakes of one kind in one room."""
        self.false.setdefault(kind, []).append(count)


def measure_perception(styles: Sequence[Style], scenes: int, seed: int, perception: Perception) -> Tally:
    """Counts over rooms of some styles.

    Args:
        styles: of the rooms.
        scenes: rooms of each style.
        seed: of the first one; the others follow.
        perception: what is measured.
    """
    tally = Tally()
    for style in styles:
        for room in seen_rooms(style, range(seed, seed + scenes), perception):
            count(room, tally)
    return tally


def count(seen: SeenRoom, tally: Tally) -> None:
    """Takes one room into the counts."""
    tally.rooms += 1
    objects = seen.map.objects
    everything = (*seen.visible, *seen.hidden)
    owner = {o.id: owner_of(o.position_m, everything) for o in objects}
    for one in seen.visible:
        if one.kind == "furniture":
            continue
        kind = f"person {one.name}" if one.kind == "person" else one.kind
        tally.could[kind] += 1
        if _is_found(one, seen):
            tally.found[kind] += 1
        else:
            tally.missed[one.name] += 1
    tally.objects += len(objects)
    for thing in objects:
        truth = owner[thing.id]
        if thing.names:
            best = thing.names[0]
            tally.named.append((best.probability, truth is not None and best.label in truth.labels))
        if thing.label != OBJECT:
            tally.claims.append(truth is not None and thing.label in truth.labels)
        if truth is not None and truth.kind == "thing":
            tally.off_m.append(math.dist(truth.box_m.centre_m, thing.position_m))
            said = thing.values("colour")
            if truth.colour and said:
                tally.colours.append(truth.colour in said)
    people = [one for one in everything if one.kind == "person"]
    strangers = [o for o in objects if not any(_flat_m(o.position_m, p.box_m.centre_m) < 2 * BODY_M for p in people)]
    tally.mistake("person", sum(o.label == PERSON for o in strangers))
    tally.mistake("question about a person", sum(is_doubtful_person(o) for o in strangers))
    doors = [one.box_m.centre_m for one in everything if one.kind == "door"]
    said_doors = _doors(seen)
    tally.mistake("door", sum(all(_flat_m(d, at) > 2 * DOOR_M for at in doors) for d in said_doors))
    tally.mistake("fire", sum(o.label in ("fire", "glow") for o in objects))
    tally.mistake("smoke", len(seen.map.regions))
    tally.mistake("thing", sum(owner[o.id] is None for o in objects))


def rows_of(tally: Tally) -> Iterator[PerceptionRow]:
    """The figures, with intervals and what is to be reached."""
    postures = sorted(k for k in tally.could if k.startswith("person "))
    yield share_row("people found, questions counted", *_sum(tally, postures), "0.95")
    for kind in postures:
        yield share_row(f"  {kind.removeprefix('person ')}", tally.found[kind], tally.could[kind], "")
    yield share_row("doors found", tally.found["door"], tally.could["door"], "0.95")
    yield share_row("things found within 0.3 m", tally.found["thing"], tally.could["thing"], "0.95")
    off = sorted(tally.off_m)
    if off:
        yield PerceptionRow(name="distance from a thing's middle, median, m", value=off[len(off) // 2], n=len(off))
    yield share_row("claimed names that are right", sum(tally.claims), len(tally.claims), "0.8")
    yield share_row("colours that are right", sum(tally.colours), len(tally.colours), "")
    error = calibration_error(tally.named)
    yield PerceptionRow(name="calibration error of the likeliest names", value=error, n=len(tally.named), wanted="0.1")
    wanted = {"person": "0.05", "question about a person": "", "door": "", "fire": "0", "smoke": "0", "thing": ""}
    for kind, counts in tally.false.items():
        ends = student(counts) or (None, None)
        mean = math.fsum(counts) / max(1, len(counts))
        yield PerceptionRow(
            name=f"false: {kind}, in a room", value=mean, n=len(counts), low=ends[0], high=ends[1], wanted=wanted[kind]
        )


def calibration_error(named: Sequence[tuple[float, bool]]) -> float:
    """Expected calibration error: how far the share of right names is from what was said of them, over `BINS` bins."""
    total = 0.0
    for i in range(BINS):
        inside = [(p, right) for p, right in named if i / BINS <= p < (i + 1) / BINS or (i == BINS - 1 and p >= 1)]
        if inside:
            said = math.fsum(p for p, _ in inside)
            total += abs(said - sum(right for _, right in inside))
    return total / max(1, len(named))


def share_row(name: str, count: int, n: int, wanted: str) -> PerceptionRow:
    """The row of a share, with Wilson's interval."""
    low, high = wilson(count, n)
    return PerceptionRow(name=name, value=count / max(1, n), n=n, low=low, high=high, wanted=wanted)


def _sum(tally: Tally, kinds: Sequence[str]) -> tuple[int, int]:
    return sum(tally.found[k] for k in kinds), sum(tally.could[k] for k in kinds)


def _is_found(one: Shown, seen: SeenRoom) -> bool:
    middle = one.box_m.centre_m
    if one.kind == "person":
        claimed = (o for o in seen.map.objects if o.label == PERSON or is_doubtful_person(o))
        return any(_flat_m(o.position_m, middle) < BODY_M for o in claimed)
    if one.kind == "door":
        return any(_flat_m(at, middle) < DOOR_M for at in _doors(seen))
    return any(math.dist(o.position_m, middle) < NEAR_M for o in seen.map.objects)


def _doors(seen: SeenRoom) -> list[Vec3]:
    shut = [r.door_m.centre_m for r in seen.map.rooms]
    return shut + [o.position_m for o in seen.map.objects if o.label == "door"]


def owner_of(position_m: Vec3, everything: Sequence[Shown]) -> Shown | None:
    """What an object at a place shows: that within whose extent, grown a little, that lies; the smallest of several."""
    inside = [one for one in everything if _holds(one, position_m)]
    return min(inside, key=lambda one: math.prod(max(e, 0.01) for e in one.box_m.size_m), default=None)


def _holds(one: Shown, at: Vec3) -> bool:
    lo, hi = one.box_m.lo_m, one.box_m.hi_m
    return all(a - 0.12 <= x <= b + 0.12 for a, x, b in zip(lo, at, hi, strict=True))


def _flat_m(a: Vec3, b: Vec3) -> float:
    return math.hypot(a[0] - b[0], a[1] - b[1])
