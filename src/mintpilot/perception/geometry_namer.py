"""The namer that needs nothing but shape and size."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from mintpilot.core.observation import Frame, NameGuess, Segment
from mintpilot.core.ports import Namer
from mintpilot.perception.lumps import somebody_probability
from mintpilot.perception.solid_shapes import SolidShape, solid_shape

BOXLIKE = 0.8
"""This share of a box's surface lies in its faces."""
BOX_M = (0.04, 1.3)
"""Boxes are no thinner and no longer."""
ROUND = 0.75
"""This share of a cylinder's sides lies on it."""
LEAST_PERSON = 0.05
"""What is somebody less probably is nobody."""
PANEL = 0.9
"""This share of a panel lies in one face."""


class GeometryNamer(Namer):
    """Names boxes, things that are round like cans and cups, leaves of doors and people, where their shape says so."""

    def names(self, frame: Frame, segments: Sequence[Segment]) -> tuple[tuple[NameGuess, ...], ...]:
        """Names by shape and size; most segments get none."""
        del frame
        return tuple(_named(segment) for segment in segments)


def _named(segment: Segment) -> tuple[NameGuess, ...]:
    person = somebody_probability(segment)
    shape = solid_shape(segment)
    others = _by_shape(segment, shape)
    left = 1.0 - person if person >= LEAST_PERSON else 1.0
    guesses = [NameGuess(label=g.label, probability=g.probability * left) for g in others]
    if person >= LEAST_PERSON:
        guesses.append(NameGuess(label="person", probability=person))
    return tuple(sorted(guesses, key=lambda g: (-g.probability, g.label)))


def _by_shape(segment: Segment, shape: SolidShape) -> tuple[NameGuess, ...]:
    size = segment.box_m.size_m
    longest, height = max(size), size[2]
    sure = 0.6 if segment.cut else 1.0
    if shape.round >= ROUND and shape.radius_m > 0:
        return _round(2 * shape.radius_m, height, sure)
    least = min(size[2], math.hypot(size[0], size[1]))
    if shape.boxlike >= BOXLIKE and shape.faces >= 2 and longest <= BOX_M[1] and least >= BOX_M[0]:
        three = 0.1 if shape.faces == 3 else 0.0
        return (NameGuess(label="box", probability=sure * min(0.9, shape.boxlike - 0.15 + three)),)
    if shape.flat >= PANEL and segment.on_floor and 1.7 <= height <= 2.3 and 0.55 <= math.hypot(*size[:2]) <= 1.35:
        return (NameGuess(label="door", probability=0.55 * sure),)
    return ()


def _round(diameter_m: float, height_m: float, sure: float) -> tuple[NameGuess, ...]:
    """Names for an upright cylinder by its size: many things are round, so none of them is sure."""
    chances: dict[str, float] = {}
    slender = height_m / max(diameter_m, 1e-6)
    if 0.05 <= diameter_m <= 0.09 and 0.07 <= height_m <= 0.18 and slender > 1.25:
        chances = {"can": 0.45, "cup": 0.2, "bottle": 0.1}
    elif 0.06 <= diameter_m <= 0.11 and 0.06 <= height_m <= 0.14:
        chances = {"cup": 0.45, "can": 0.2}
    elif 0.05 <= diameter_m <= 0.12 and 0.18 < height_m <= 0.36:
        chances = {"bottle": 0.4, "can": 0.3}
    elif 0.09 < diameter_m <= 0.32 and 0.04 <= height_m <= 0.2:
        chances = {"bowl": 0.35, "can": 0.2}
    elif 0.35 <= diameter_m <= 0.75 and 0.6 <= height_m <= 1.1:
        chances = {"barrel": 0.65}
    return tuple(NameGuess(label=n, probability=sure * p) for n, p in chances.items())


def fused(claims: Sequence[tuple[NameGuess, ...]], *, prior: float = 0.02) -> tuple[NameGuess, ...]:
    """What several namers together say of one segment: their evidence multiplied, none of them louder than it is sure.

    Each namer's probability for a name is compared with the prior; a namer that names other things speaks against a
    name only as far as it is sure of those, one that names nothing does not speak. Who says ``box`` speaks for
    ``medicine box`` as well: it is one.

    Args:
        claims: of each namer, its names for the segment.
        prior: probability of any one name before anybody has spoken.
    """
    labels = sorted({g.label for guesses in claims for g in guesses})
    if not labels:
        return ()
    none = max(1e-6, 1.0 - prior * len(labels))
    logs = np.log(np.array([*([prior] * len(labels)), none]))
    base = logs.copy()
    for guesses in claims:
        if not guesses:
            continue
        said = {g.label: g.probability for g in guesses}
        rest = max(1e-6, 1.0 - sum(said.values()))
        unsaid = rest * prior / (prior * (len(labels) - len(said)) + none)
        chances = [max(said.get(label, _as_kind(label, said, unsaid)), 1e-9) for label in labels]
        logs += np.log(np.array([*chances, max(rest * none / (none + prior * (len(labels) - len(said))), 1e-9)])) - base
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    found = [NameGuess(label=n, probability=float(w)) for n, w in zip(labels, weights[:-1], strict=True) if w > 0.01]
    return tuple(sorted(found, key=lambda g: (-g.probability, g.label)))


def _as_kind(label: str, said: Mapping[str, float], otherwise: float) -> float:
    """Probability that a namer gives to the kind that a compound name is one of: ``box`` for ``medicine box``."""
    kinds = [probability for name, probability in said.items() if label.endswith(f" {name}")]
    return max(kinds, default=otherwise)
