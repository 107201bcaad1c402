"""Perception by bodies: everything that stands on anything is found by its geometry, and named by whoever knows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Bools, Box, Floats
from mintpilot.core.observation import OBJECT, Attribute, Detection, Frame, NameGuess, Segment
from mintpilot.core.ports import Namer, Perception
from mintpilot.perception.bodies import Body, BodyKind, Scene, bodies_of
from mintpilot.perception.boxes import box_around, pixel_box, touches_border
from mintpilot.perception.calibration import CalibratedNamer, shipped_calibration
from mintpilot.perception.colours import colour_words, size_word
from mintpilot.perception.geometry_namer import GeometryNamer, fused
from mintpilot.perception.hazards import find_hazards
from mintpilot.perception.holding import height_below
from mintpilot.perception.leaves import find_leaves
from mintpilot.perception.patches import Patch
from mintpilot.perception.people import with_people
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import View, as_floats, look_at

LEAST_SIDE = 16
"""Smaller pictures show nothing."""
NAMED = 0.5
"""A thing has the name that is at least so likely; others are an `object`."""
SMALLEST_M = 0.025
"""Smaller things are noise."""
HAZY = 0.3
"""A body of which more than this share is smoke or flames is a scrap of them."""
TINTED = 0.3
"""A colour that so much of a thing has is its colour, whatever is white, grey or black besides: print and gloss are."""
SETTLES_M = 0.06
"""A thing whose foot is hidden, no higher than this above what is below it, stands on that."""


class SegmentPerception(Perception):
    """Finds bodies on floors, tables and shelves, and leaves in walls, whatever their colour.

    Args:
        settings: sensor model and height of the floor; None for the defaults.
        namers: who names what was found; None: by geometry.
    """

    def __init__(self, settings: PerceptionSettings | None = None, *, namers: Sequence[Namer] | None = None) -> None:
        self._settings = settings or PerceptionSettings()
        self._namers = tuple(namers) if namers is not None else (_by_geometry(),)
        self._remarks: list[str] = []

    def take_remarks(self) -> tuple[str, ...]:
        """What went wrong with namers since it was last called, in sentences; each is told once."""
        told, self._remarks = tuple(dict.fromkeys(self._remarks)), []
        return told

    def detect(self, frame: Frame, index: int) -> tuple[Detection, ...]:
        """What the frame shows. A picture without usable depth, or a very small one, shows nothing."""
        if min(frame.depth_m.shape) < LEAST_SIDE:
            return ()
        view = look_at(frame, self._settings)
        if not view.valid.any():
            return ()
        scene = bodies_of(view, self._settings.floor_m)
        hazards, covered = find_hazards(view, scene, index, self._settings)
        bodies = [body for body in scene.things if float(covered[body.mask].mean()) < HAZY]
        parts = [segment_of(view, scene, body, self._settings) for body in bodies]
        segments = with_people([part for part in parts if part is not None])
        claims = [self._claims(namer, frame, segments) for namer in self._namers]
        found = []
        for number, segment in enumerate(segments):
            names = fused([claim[number] for claim in claims])
            found.append(_detection(view, segment, names, index, self._settings))
        return (*found, *hazards, *find_leaves(view, scene, index, self._settings))

    def _claims(self, namer: Namer, frame: Frame, segments: Sequence[Segment]) -> tuple[tuple[NameGuess, ...], ...]:
        """What one namer says; one that fails says nothing, and the picture is seen without it."""
        try:
            return namer.names(frame, segments)
        except DeviceError as error:
            self._remarks.append(str(error))
            return ((),) * len(segments)


def _by_geometry() -> Namer:
    ours = shipped_calibration()
    return CalibratedNamer(GeometryNamer(), ours.namers.get("geometry", {}), only_lowers=ours.only_lowers)


def segment_of(view: View, scene: Scene, body: Body, settings: PerceptionSettings) -> Segment | None:
    """The body as a segment; None where it is too small, or too far away, to be told."""
    points = as_floats(scene.surfaces.points_m[body.mask])
    if len(points) < settings.least_pixels or float(np.median(view.depth_m[body.mask])) > settings.reach_m:
        return None
    box = box_around(_thinned(points, 3000), stray=1.0)
    if max(box.size_m) < SMALLEST_M or box.hi_m[2] - settings.floor_m < SMALLEST_M:
        return None
    below, surface = height_below(np.asarray(box.lo_m), np.asarray(box.hi_m), _supports(scene), settings.floor_m)
    lo = box.lo_m
    if 0 < lo[2] - below < SETTLES_M or lo[2] < below:
        box = Box(lo_m=(lo[0], lo[1], min(below, box.hi_m[2])), hi_m=box.hi_m)
    return Segment(
        mask=body.mask,
        points_m=points,
        normals=as_floats(scene.surfaces.normals[body.mask]),
        box_m=box,
        stands_on_m=below,
        on_floor=surface < 0,
        cut=touches_border(pixel_box(body.mask), body.mask.shape) or _at_hole(view, body),
    )


def _supports(scene: Scene) -> list[Patch]:
    return [b.patch for b in scene.bodies if b.kind is BodyKind.SURFACE]


def _at_hole(view: View, body: Body) -> bool:
    """Whether a body ends where the sensor's own picture ends, inside of the colour picture."""
    rows, columns = np.flatnonzero(view.valid.any(axis=1)), np.flatnonzero(view.valid.any(axis=0))
    left, top, right, bottom = pixel_box(body.mask)
    return bool(left <= columns[0] or top <= rows[0] or right > columns[-1] or bottom > rows[-1])


def _detection(
    view: View, segment: Segment, names: tuple[NameGuess, ...], index: int, settings: PerceptionSettings
) -> Detection:
    best = names[0] if names and names[0].probability >= NAMED else None
    return Detection(
        label=best.label if best is not None else OBJECT,
        score=_score(view, segment),
        box_m=segment.box_m,
        attributes=_attributes(view, segment, settings),
        pixels=pixel_box(segment.mask),
        points_m=_thinned(segment.points_m),
        frame_index=index,
        names=names,
    )


def _score(view: View, segment: Segment) -> float:
    """That there is one thing there, whatever it is: less for what is cut off, small, or far away."""
    pixels = float(segment.mask.sum())
    distance = float(np.median(view.depth_m[segment.mask]))
    chance = 0.95 * min(1.0, 0.55 + pixels / 1500) * float(np.clip(1.15 - 0.05 * distance, 0.4, 1.0))
    floats = segment.box_m.lo_m[2] - segment.stands_on_m > 0.3
    return chance * (0.6 if segment.cut else 1.0) * (0.6 if floats else 1.0)


def _attributes(view: View, segment: Segment, settings: PerceptionSettings) -> tuple[Attribute, ...]:
    """Colour, size, height against a person's, and what it is on, in plain words."""
    mask = segment.mask
    words = [("colour", _colour(view, mask)), ("size", size_word(max(segment.box_m.size_m)))]
    height = segment.box_m.hi_m[2] - settings.floor_m
    if segment.on_floor:
        words += [("height", height_word(height)), ("place", "on the floor")]
    else:
        words.append(("place", "on the table" if segment.stands_on_m - settings.floor_m < 1.15 else "on the shelf"))
    return tuple(Attribute(name=name, value=value) for name, value in words)


def _colour(view: View, mask: Bools) -> str:
    words, counts = np.unique(colour_words(view.hue[mask], view.saturation[mask], view.value[mask]), return_counts=True)
    tinted = ~np.isin(words, ("white", "grey", "black"))
    if tinted.any() and counts[tinted].max() >= TINTED * counts.sum():
        return str(words[tinted][int(np.argmax(counts[tinted]))])
    return str(words[int(np.argmax(counts))])


def height_word(height_m: float) -> str:
    """A height above the floor by a person's body: ``ankle-high`` to ``taller than a person``."""
    for below, word in ((0.2, "ankle-high"), (0.6, "knee-high"), (1.0, "waist-high"), (1.5, "chest-high")):
        if height_m < below:
            return word
    return "as tall as a person" if height_m < 2.0 else "taller than a person"


def _thinned(points: Floats, about: int = 400) -> Floats:
    thin: Floats = points[:: max(1, len(points) // about)]
    return thin
