"""Objects fused over frames by place and kind."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from mintpilot.core.geometry import Box, Floats, Vec3
from mintpilot.core.observation import OBJECT, Attribute, Detection, NameGuess
from mintpilot.core.semantic_map import MapObject

SILENT = 0.3
"""Weight of a sighting in which nobody had a name for a thing: it may be cut off, or seen from behind."""


@dataclass(slots=True)
class Track:
    """One thing as seen so far."""

    label: str
    lo_m: Floats
    hi_m: Floats
    weight: float = 0.0
    doubt: float = 1.0
    """Probability that every sighting was a mistake."""
    frames: set[int] = field(default_factory=set)
    votes: dict[str, Counter[str]] = field(default_factory=dict)
    best_view: tuple[int, int, int, int, int] | None = None
    _best_pixels: float = 0.0
    eye_m: Floats = field(default_factory=lambda: np.zeros(3))
    """Where the largest view was taken from."""
    points_m: Floats | None = None
    """Surface points of the largest view."""
    is_segment: bool = False
    """Whether it was found as a body of whatever kind; its label then follows from what its names come to."""
    claims: Counter[str] = field(default_factory=Counter)
    """Weighted sums of the probabilities of its names."""
    claimed: float = 0.0
    """Sum of the weights."""

    @property
    def box_m(self) -> Box:
        """Mean extent."""
        return Box(lo_m=_vec(np.minimum(self.lo_m, self.hi_m)), hi_m=_vec(np.maximum(self.lo_m, self.hi_m)))

    @property
    def score(self) -> float:
        """Confidence from all sightings together, 0 to 1."""
        return 1.0 - self.doubt

    @property
    def attributes(self) -> tuple[Attribute, ...]:
        """For each attribute the value with most votes (ties: the first by alphabet)."""
        return tuple(
            Attribute(name=name, value=min(votes, key=lambda v: (-votes[v], v)))
            for name, votes in sorted(self.votes.items())
        )

    @property
    def names(self) -> tuple[NameGuess, ...]:
        """What it may be, likeliest first: the mean over its sightings, since those of one thing err alike."""
        chances = [(label, total / self.claimed) for label, total in self.claims.items() if self.claimed > 0]
        return tuple(NameGuess(label=n, probability=p) for n, p in sorted(chances, key=lambda c: (-c[1], c[0])))

    def add(self, detection: Detection, eye_m: Floats) -> None:
        """Takes one more sighting in: moving average of the extent, one weighted vote per attribute."""
        lo, hi = np.asarray(detection.box_m.lo_m), np.asarray(detection.box_m.hi_m)
        # A view cut off by the picture's edge or an occluder has a low score, and so hardly moves the extent.
        weight = max(1e-3, detection.score) ** 2
        share = weight / (self.weight + weight)
        self.lo_m = self.lo_m + share * (lo - self.lo_m)
        self.hi_m = self.hi_m + share * (hi - self.hi_m)
        self.weight += weight
        if detection.frame_index not in self.frames:
            self.doubt *= 1.0 - 0.9 * min(1.0, max(0.0, detection.score))
        self.frames.add(detection.frame_index)
        left, top, right, bottom = detection.pixels
        pixels = float(max(0, right - left) * max(0, bottom - top))
        for attribute in detection.attributes:
            votes = self.votes.setdefault(attribute.name, Counter())
            votes[attribute.value] += weight * (1.0 + min(pixels, 4000.0) / 1000.0)  # type: ignore[assignment]
        if self.is_segment:
            for guess in detection.names:
                self.claims[guess.label] += weight * guess.probability  # type: ignore[assignment]
            self.claimed += weight if detection.names else SILENT * weight
            best = self.names[0] if self.claims else None
            self.label = best.label if best is not None and best.probability >= NAMED else OBJECT
        if self.best_view is None or pixels * weight > self._best_pixels:
            self.best_view = (detection.frame_index, *detection.pixels)
            self._best_pixels, self.eye_m, self.points_m = pixels * weight, eye_m, detection.points_m

    def as_object(self, identity: str) -> MapObject:
        """The noun for the map."""
        return MapObject(
            id=identity,
            label=self.label,
            box_m=self.box_m,
            attributes=self.attributes,
            score=self.score,
            sightings=len(self.frames),
            best_view=self.best_view,
            names=self.names,
        )


class Tracks:
    """All things of all kinds."""

    def __init__(self) -> None:
        self.all: list[Track] = []

    def add(self, detection: Detection, eye_m: Floats) -> None:
        """Fuses one detection with the nearest track of its kind, or starts a new one."""
        best, best_closeness = None, 0.0
        is_segment = detection.label == OBJECT or bool(detection.names)
        for track in self.all:
            if track.is_segment != is_segment or (not is_segment and track.label != detection.label):
                continue
            c = same_body(track.box_m, detection.box_m) if is_segment else _alike(track, detection)
            if c > best_closeness:
                best, best_closeness = track, c
        if best is None:
            best = Track(
                label=detection.label,
                is_segment=is_segment,
                lo_m=np.asarray(detection.box_m.lo_m, float),
                hi_m=np.asarray(detection.box_m.hi_m, float),
            )
            self.all.append(best)
        best.add(detection, eye_m)


NAMED = 0.5
"""A body has the name that is at least so likely; others are an `object`."""
PLACE_M, INSIDE = 0.03, 0.6
"""Error of a place, metres; and the share of a body's extent within another's from which it is a part of it."""
PERSON_M = 1.3
"""Distance between parts of people up to which they belong to one person, metres."""


def _alike(track: Track, detection: Detection) -> float:
    """How likely a detection shows the thing of a track, 0 or less for not at all. People are often seen in part."""
    near = closeness(track.box_m, detection.box_m)
    if track.label != "person":
        return near
    a, b = track.box_m.centre_m, detection.box_m.centre_m
    return max(near, 1.0 - float(np.hypot(a[0] - b[0], a[1] - b[1])) / PERSON_M)


def closeness(a: Box, b: Box) -> float:
    """How likely two extents are the same thing: 1 for equal places, 0 or less when they are clearly apart.

    The distance of the centres on the ground is compared with half the mean horizontal size plus 0.15 m.
    """
    ca, cb = np.asarray(a.centre_m), np.asarray(b.centre_m)
    distance = float(np.hypot(*(ca - cb)[:2])) + 0.5 * max(0.0, abs(float(ca[2] - cb[2])) - 0.3)
    size = (a.size_m[0] + a.size_m[1] + b.size_m[0] + b.size_m[1]) / 4
    return 1.0 - distance / (0.5 * size + 0.15)


def same_body(a: Box, b: Box) -> float:
    """How likely the extents of two bodies of any kind are one: 1 for equal ones, 0 or less when clearly apart.

    The distance of the centres is compared with half the smaller one's size and the error of a place; one that lies
    within the other is a part of it.
    """
    ca, cb = np.asarray(a.centre_m), np.asarray(b.centre_m)
    sa, sb = np.maximum(a.size_m, 0.02), np.maximum(b.size_m, 0.02)
    shared = np.minimum(a.hi_m, b.hi_m) - np.maximum(a.lo_m, b.lo_m)
    inside = float(np.prod(np.maximum(shared, 0.0)) / min(np.prod(sa), np.prod(sb)))
    near = 1.0 - float(np.linalg.norm(ca - cb)) / (0.4 * float(min(np.linalg.norm(sa), np.linalg.norm(sb))) + PLACE_M)
    return max(near, inside - INSIDE)


def _vec(array: Floats) -> Vec3:
    return (float(array[0]), float(array[1]), float(array[2]))
