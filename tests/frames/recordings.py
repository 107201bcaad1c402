"""Small recordings of a room with known things, made without the package's own geometry."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from PIL import Image

from perception.scenes import CAMERA, Block, picture, pose

BLOCKS = [
    Block(lo_m=(2.4, -0.9, 0.0), hi_m=(2.9, -0.4, 0.5), colour=(0.8, 0.06, 0.06)),
    Block(lo_m=(2.9, 0.5, 0.0), hi_m=(3.3, 0.9, 0.7), colour=(0.06, 0.18, 0.75)),
]
EYES = [(0.0, 0.12 * i, 1.5 + 0.03 * i) for i in range(5)]


def views(eyes=None, blocks=None):  # type: ignore[no-untyped-def]
    """Frames of the room along a short walk to the left."""
    return [picture(blocks or BLOCKS, eye=eye, seed=i) for i, eye in enumerate(eyes or EYES)]


def poses(eyes=None):  # type: ignore[no-untyped-def]
    return [pose(eye, 0.0, 0.35) for eye in (eyes or EYES)]


def intrinsics() -> dict[str, float]:
    """As files give them: the first pixel's centre is at (0, 0)."""
    lens = CAMERA
    return {
        "width": lens.width,
        "height": lens.height,
        "fx": lens.fx,
        "fy": lens.fy,
        "cx": lens.cx - 0.5,
        "cy": lens.cy - 0.5,
    }


def save_picture(folder: Path, name: str, frame, per_metre: float = 1000.0) -> tuple[Path, Path]:  # type: ignore[no-untyped-def]
    (folder / "color").mkdir(parents=True, exist_ok=True)
    (folder / "depth").mkdir(parents=True, exist_ok=True)
    color, depth = folder / "color" / f"{name}.png", folder / "depth" / f"{name}.png"
    Image.fromarray(frame.rgb).save(color)
    steps = np.clip(np.nan_to_num(frame.depth_m) * per_metre, 0, 65535).round().astype(np.uint16)
    Image.fromarray(steps).save(depth)
    return color, depth


def save_folder(folder: Path, frames, matrices, per_metre: float = 1000.0) -> Path:  # type: ignore[no-untyped-def]
    """The layout with color/, depth/, trajectory.log and an intrinsics file."""
    lines = []
    for i, (frame, matrix) in enumerate(zip(frames, matrices, strict=True)):
        save_picture(folder, f"{i:05d}", frame, per_metre)
        lines += [f"{i} {i} {i + 1}", *(" ".join(f"{x:.9g}" for x in row) for row in matrix)]
    (folder / "trajectory.log").write_text("\n".join(lines) + "\n")
    (folder / "camera_intrinsics.json").write_text(json.dumps(intrinsics()))
    return folder


def quaternion(matrix: np.ndarray) -> tuple[float, float, float, float]:
    """x, y, z, w of a rotation, by its largest diagonal."""
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(matrix[:3, :3]).as_quat()
    return float(x), float(y), float(z), float(w)


def save_tum(folder: Path, frames, matrices) -> Path:  # type: ignore[no-untyped-def]
    """The TUM layout: 5000 steps a metre."""
    rgb, depth, track = ["# colour"], ["# depth"], ["# time x y z qx qy qz qw"]
    for i, (frame, matrix) in enumerate(zip(frames, matrices, strict=True)):
        save_picture(folder, f"{i}", frame, 5000.0)
        t = 100.0 + 0.1 * i
        rgb.append(f"{t:.4f} color/{i}.png")
        depth.append(f"{t + 0.012:.4f} depth/{i}.png")
        numbers = (*matrix[:3, 3], *quaternion(matrix))
        track.append(f"{t - 0.004:.4f} " + " ".join(f"{x:.9f}" for x in numbers))
    for name, lines in (("rgb.txt", rgb), ("depth.txt", depth), ("groundtruth.txt", track)):
        (folder / name).write_text("\n".join(lines) + "\n")
    (folder / "camera.json").write_text(json.dumps(intrinsics()))
    return folder
