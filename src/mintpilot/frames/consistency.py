"""Whether two posed pictures show one world, and what is wrong with their poses where they do not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.observation import RawFrame
from mintpilot.frames.rotations import BODY_FROM_OPTICAL

SAMPLE = 4000
"""Pixels of a picture that are compared, about."""
NEAR_M, NEAR_SHARE = 0.03, 0.02
"""Depths that differ by no more than this, and this share of the distance, agree."""
LEAST_OVERLAP = 0.25
"""Pictures that share less of their view tell nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """How well two pictures fit each other."""

    overlap: float
    """Share of the first one's points that fall on pixels with depth of the second one."""
    agreeing: float
    """Share of those that the second one sees at the same depth."""

    @property
    def score(self) -> float:
        """Share of all points that agree."""
        return self.overlap * self.agreeing


def agreement(first: RawFrame, second: RawFrame, second_from_first: Floats, *, depth_scale: float = 1.0) -> Agreement:
    """How well two pictures fit under a relative pose (4, 4).

    Args:
        first: its points are moved.
        second: its depth is compared with.
        second_from_first: pose of the first camera in the second one's optical frame.
        depth_scale: both depths are multiplied by this.
    """
    step = max(1, int(np.sqrt(first.depth_m.size / SAMPLE)))
    lens = first.camera
    v, u = np.mgrid[step // 2 : lens.height : step, step // 2 : lens.width : step]
    z = first.depth_m[v, u].astype(float) * depth_scale
    has = z > 0
    if not has.any():
        return Agreement(overlap=0.0, agreeing=0.0)
    u, v, z = u[has] + 0.5, v[has] + 0.5, z[has]
    points = np.stack([(u - lens.cx) / lens.fx * z, (v - lens.cy) / lens.fy * z, z], axis=1)
    moved = points @ second_from_first[:3, :3].T + second_from_first[:3, 3]
    lens = second.camera
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.floor(moved[:, 0] / moved[:, 2] * lens.fx + lens.cx)
        y = np.floor(moved[:, 1] / moved[:, 2] * lens.fy + lens.cy)
    inside = (moved[:, 2] > 0) & (x >= 0) & (x < lens.width) & (y >= 0) & (y < lens.height)
    seen = np.zeros(len(moved))
    seen[inside] = second.depth_m[y[inside].astype(int), x[inside].astype(int)] * depth_scale
    shared = seen > 0
    near = np.abs(seen - moved[:, 2]) <= NEAR_M + NEAR_SHARE * seen
    return Agreement(
        overlap=float(shared.mean()),
        agreeing=float(near[shared].mean()) if shared.any() else 0.0,
    )


SCALES = (0.001, 0.01, 0.1, 0.2, 0.5, 2.0, 5.0, 10.0, 100.0, 1000.0)
"""Factors by which units are confused."""


def relative(first: Floats, second: Floats) -> Floats:
    """The first camera in the second one's frame, of two poses (4, 4) in one world."""
    return np.asarray(np.linalg.solve(second, first), np.float64)


def mistakes(frames: Sequence[RawFrame]) -> Mapping[str, float]:
    """Mean score of what the poses may be → its score: ``as given``, ``inverted``, ``body``, ``depth x 5`` ….

    Args:
        frames: two or more with poses, those compared that moved against each other but share their view.
    """
    pairs = _telling_pairs(frames)
    scores: dict[str, list[float]] = {}
    for a, b in pairs:
        first, second = a.source_from_camera, b.source_from_camera
        assert first is not None
        assert second is not None
        given = relative(first, second)
        tries = {
            "as given": given,
            "inverted": np.asarray(second @ np.linalg.inv(first), np.float64),
            "body": relative(_optical(first), _optical(second)),
        }
        for name, pose in tries.items():
            scores.setdefault(name, []).append(agreement(a, b, pose).score)
        for scale in SCALES:
            scores.setdefault(f"depth x {scale:g}", []).append(agreement(a, b, given, depth_scale=scale).score)
    return {name: float(np.mean(values)) for name, values in scores.items()}


def _telling_pairs(frames: Sequence[RawFrame]) -> list[tuple[RawFrame, RawFrame]]:
    """Up to six pairs of neighbours at growing distance."""
    posed = [f for f in frames if f.source_from_camera is not None]
    pairs = [(posed[i], posed[i + gap]) for gap in (1, 2, 4) for i in range(0, len(posed) - gap, max(1, gap))]
    return pairs[:: max(1, len(pairs) // 6)][:6] if len(pairs) > 6 else pairs


def _optical(body: Floats) -> Floats:
    """The optical frame of a camera that looks ahead from a body at that pose."""
    return np.asarray(body @ BODY_FROM_OPTICAL, np.float64)
