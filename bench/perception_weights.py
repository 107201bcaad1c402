"""Finds the weights of evidence for doors and for lumps: ``python -m bench.perception_weights [--rooms N] [--seed N]``.

Draws rooms of the tuned styles only, measures every door frame and every segment of eight views each, and prints what
logistic regression makes of them, in the form of perception/door_weights.py and lump_weights.py. It changes no file.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence

import numpy as np

from mintpilot.benchmark.perception_scenes import looks_at
from mintpilot.core.geometry import Floats
from mintpilot.perception.bodies import bodies_of
from mintpilot.perception.door_frames import EVIDENCE, DoorFrames, door_frames
from mintpilot.perception.leaves import apart, door_probabilities
from mintpilot.perception.lumps import FEATURES, LEAST_PIXELS, lump_features
from mintpilot.perception.people import person_probability, with_people
from mintpilot.perception.segments import segment_of
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import look_at
from mintpilot.perception.wall_pictures import CELL_M, WallPicture, wall_pictures
from mintpilot.simulation.furnished.doors import before
from mintpilot.simulation.furnished.room import FurnishedRoom, furnished_room
from mintpilot.simulation.furnished.styles import TUNED

IS_DOOR, PERHAPS = 0.72, 0.45
"""A frame that shares more than this of both widths with a door is that door; down to the second it is left out."""
LOSERS = 0.1
"""Weight of frames that others beat at their place, by the weights that there are: found in two rounds."""
Example = tuple[Floats, bool, float]
"""Evidence, whether it is one, and weight."""


def fitted(examples: Sequence[Example], ridge: float) -> tuple[Floats, float]:
    """Weights and bias of logistic regression on standardised evidence (Newton's method)."""
    x, y, w = (np.array([e[i] for e in examples], float) for i in range(3))
    mean, spread = x.mean(axis=0), x.std(axis=0) + 1e-6
    z = np.column_stack([(x - mean) / spread, np.ones(len(x))])
    at, keep = np.zeros(z.shape[1]), np.diag([ridge] * x.shape[1] + [1e-3])
    for _ in range(40):
        p = 1 / (1 + np.exp(-np.clip(z @ at, -30, 30)))
        curve = (z * (w * p * (1 - p) + 1e-9)[:, None]).T @ z + keep
        at = at - np.clip(np.linalg.solve(curve, z.T @ (w * (p - y)) + keep @ at), -2, 2)
    weights = at[:-1] / spread
    return weights, float(at[-1] - (weights * mean).sum())


def door_examples(wall: WallPicture, frames: DoorFrames, room: FurnishedRoom) -> Iterator[Example]:
    """Each frame of a wall, held against the doors in it."""
    left, right = (wall.begin_m + side * CELL_M for side in (frames.left, frames.right))
    best = np.zeros(len(left))
    for door in room.doors:
        middle = np.array([*before(door, room.size_m, 0.0), 0.0])
        inwards = np.array([*before(door, room.size_m, 1.0), 0.0]) - middle
        if abs(float(middle @ wall.normal) - wall.offset_m) < 0.3 and float(inwards @ wall.normal) > 0.9:
            a, b = (float(middle @ wall.along) + side * door.width_m / 2 for side in (-1, 1))
            shared = np.maximum(0.0, np.minimum(right, b) - np.maximum(left, a))
            best = np.maximum(best, shared / (np.maximum(right, b) - np.minimum(left, a)))
    winners = set(apart(frames, door_probabilities(frames)))
    for number, (evidence, share) in enumerate(zip(frames.evidence, best, strict=True)):
        if not PERHAPS < share < IS_DOOR:
            yield evidence, bool(share >= IS_DOOR), 1.0 if number in winners else LOSERS


def examples_of(seed: int, rooms: int) -> tuple[list[Example], list[Example]]:
    """Those of doors and those of lumps."""
    settings, doors, lumps = PerceptionSettings(), list[Example](), list[Example]()
    for style in TUNED.values():
        for number in range(seed, seed + rooms):
            room = furnished_room(style, number)
            people = [k for k, one in enumerate(room.shown) if one.kind == "person"]
            for frame, owner in looks_at(room, number):
                view = look_at(frame, settings)
                scene = bodies_of(view, settings.floor_m)
                for wall in wall_pictures(view, scene, settings.floor_m):
                    frames = door_frames(wall)
                    doors += door_examples(wall, frames, room) if frames is not None else ()
                parts = [segment_of(view, scene, body, settings) for body in scene.things]
                for part in with_people([one for one in parts if one is not None]):
                    own = owner[part.mask]
                    share = float(np.isin(own, people).mean())
                    cover = max((float((own == k).sum() / max(1, (owner == k).sum())) for k in people), default=0.0)
                    somebody = (share >= 0.3 and cover >= 0.4) or (share >= 0.12 and cover >= 0.6)
                    if len(part.points_m) >= LEAST_PIXELS and (somebody or share < 0.03):
                        lumps.append((lump_features(part, person_probability(part)), somebody, 1.0))
    return doors, lumps


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rooms", type=int, default=24, help="of each tuned style")
    parser.add_argument("--seed", type=int, default=6000, help="of the first one")
    flags = parser.parse_args()
    for names, examples in zip((EVIDENCE, FEATURES), examples_of(flags.seed, flags.rooms), strict=True):
        weights, bias = fitted(examples, ridge=3.0)
        print(
            f"# {len(examples)} examples, {sum(e[1] for e in examples)} of them right\nBIAS = {bias:.3f}\nWEIGHTS = ("
        )
        print("".join(f'    ("{name}", {weight:.3f}),\n' for name, weight in zip(names, weights, strict=True)) + ")")
    return 0


if __name__ == "__main__":
    sys.exit(main())
