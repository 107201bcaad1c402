"""What makes pictures unusable: named, with the likely cause."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Floats
from mintpilot.core.observation import RawFrame
from mintpilot.frames.consistency import mistakes

FARTHEST_M, NEAREST_M = 25.0, 0.05
"""No RGB-D camera measures much outside of this range."""
CLEARLY = 0.1
"""A mistake in the poses is named when it explains so much more of the pictures than the poses as they are."""
EXPLAINS = 0.5
"""… and at least this share of them."""
RIGID = 0.02
"""Largest deviation of a rotation from being one."""
_DARK, _BRIGHT = 12, 243


def checked_unit(frames: Sequence[RawFrame]) -> None:
    """Whether depth can be metres.

    Raises:
        MapError: most of it is farther than any such camera sees, or nearer; the likely unit is named.
    """
    depths = [f.depth_m[f.depth_m > 0] for f in frames]
    seen = np.concatenate(depths) if depths else np.zeros(0)
    if not seen.size:
        return
    middle, far = float(np.median(seen)), float(np.percentile(seen, 90))
    if far > FARTHEST_M:
        factor = next((f for f in (5, 10, 100, 1000, 5000, 10_000) if far / f <= 10), 1000)
        raise MapError(
            f"depth reaches {far:.0f} m, no RGB-D camera measures so far: the depth unit is wrong. Is one step "
            f"{factor} times smaller (TUM: --depth-unit 0.0002, millimetres: --depth-unit 0.001)?"
        )
    if middle < NEAREST_M:
        raise MapError(
            f"half of the depth is nearer than {1000 * middle:.2g} mm, no RGB-D camera measures so near: the depth "
            "unit is wrong; for millimetres give --depth-unit 0.001"
        )


def checked_pose(pose: Floats, number: int) -> Floats:
    """A pose as a rigid motion (4, 4), small errors of rounding mended.

    Raises:
        MapError: it is not finite, scaled, mirrored, or no rotation at all.
    """
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        raise MapError(f"pose of frame {number} is no finite 4 x 4 matrix; drop the frame or mend the pose")
    if np.abs(pose[3] - (0, 0, 0, 1)).max() > 1e-6:
        turned = np.abs(pose[:, 3] - (0, 0, 0, 1)).max() < 1e-6
        hint = "it is transposed: write it row by row" if turned else "mend it"
        raise MapError(f"pose of frame {number}: the last row is {pose[3].tolist()}, it must be 0 0 0 1; {hint}")
    rotation = pose[:3, :3]
    scale = float(np.cbrt(np.linalg.det(rotation)))
    if scale < 0:
        raise MapError(
            f"pose of frame {number} is mirrored (determinant {scale**3:.2f}): an axis points the wrong way; poses "
            "must be of a right-handed frame"
        )
    if np.abs(rotation @ rotation.T - max(scale, 1e-9) ** 2 * np.eye(3)).max() > RIGID * max(1.0, scale**2):
        raise MapError(f"pose of frame {number}: its upper left 3 x 3 is no rotation; mend the poses")
    if abs(scale - 1) > RIGID:
        raise MapError(
            f"poses are scaled: the rotation of frame {number} stretches by {scale:.4g}, it must keep lengths"
        )
    left, _, right = np.linalg.svd(rotation)
    mended = pose.copy()
    mended[:3, :3] = left @ right
    return mended


def checked_track(frames: Sequence[RawFrame]) -> None:
    """Whether the poses of a few frames make their depths fit each other.

    Raises:
        MapError: another reading of the same poses fits clearly better: they are inverted, of the vehicle's body in
            place of the optical frame, or in another unit than depth.
    """
    scores = mistakes(frames)
    if not scores:
        return
    best = max(scores, key=lambda name: (scores[name], name == "as given"))
    gain = scores[best] - scores["as given"]
    if best == "as given" or gain < CLEARLY or scores[best] < EXPLAINS:
        return
    fit = f"{scores['as given']:.0%} of the depth fits between frames as given, {scores[best]:.0%} otherwise"
    if best == "inverted":
        raise MapError(f"poses are inverted: they are camera from world, world from camera is wanted ({fit})")
    if best == "body":
        raise MapError(
            f"poses are those of a body frame (x ahead, z up), not of the camera's optical frame (x right, y down, "
            f"z ahead) ({fit}); multiply them by the camera's mounting"
        )
    factor = float(best.removeprefix("depth x "))
    raise MapError(
        f"poses are scaled, or the depth unit is wrong, by {factor:g}: depth times {factor:g} fits the poses ({fit}); "
        "give --depth-unit, or poses in metres"
    )


def seen_faults(frames: Sequence[RawFrame]) -> tuple[str, ...]:
    """What spoils what can be seen in all of some frames, a sentence each; empty for sound pictures."""
    if not frames:
        return ("There is no frame.",)
    said = []
    holes = [1 - float((f.depth_m > 0).mean()) for f in frames]
    if min(holes) > 0.999:
        said.append(
            "No frame has any depth: is the file empty, of another encoding, or everything out of the camera's range?"
        )
    elif float(np.median(holes)) > 0.6:
        said.append(
            f"{np.median(holes):.0%} of the depth is missing: glass, sunlight, black or too near things do that."
        )
    brightness = [float(np.median(f.rgb)) for f in frames]
    if max(brightness) < _DARK:
        said.append("The pictures are black: colours mean nothing; was the light off or the lens covered?")
    elif min(brightness) > _BRIGHT:
        said.append("The pictures are over-exposed: colours mean nothing.")
    return tuple(said)
