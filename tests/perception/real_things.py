"""Obvious things in real pictures, listed by looking at them: which pixels show them, and what they are.

The middle of a thing is the mean of the places of its pixels (opposite ends, for a thing that is deep or wide), which
follow from their depth by the pinhole formula alone.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

DATA = Path(os.environ.get("MINTPILOT_TEST_DATA") or Path(__file__).parents[3] / "shared" / "data")
RGBD, TABLETOP = DATA / "rgbd", DATA / "tabletop"
TUNED = (0, 12, 20, 25, 31, 38)
"""Frames of `TABLETOP` on which parameters were chosen: every other one by number. Fixed before any was measured."""
REPORTED = (5, 17, 23, 28, 34, 43)
"""The others: figures are about these."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Thing:
    name: str
    pixels: tuple[tuple[int, int], ...]
    """Column and row of pixels around its middle."""
    behind_m: float = 0.03
    """How far behind its surface its middle is."""
    frame: int = 0
    """In which frame of a recording it was pointed at."""
    names: tuple[str, ...] = ()
    """Labels that would be right."""


LIVING_ROOM = (
    Thing(name="rocking chair", pixels=((415, 150), (500, 262)), behind_m=0.0, names=("chair",)),
    Thing(name="curtain", pixels=((190, 200), (272, 200)), behind_m=0.0, names=("curtain",)),
    Thing(name="low brick wall outside", pixels=((38, 220),), names=("wall",)),
    Thing(name="post of the window", pixels=((97, 200),), names=("window", "door")),
    Thing(name="cabinet at the right edge", pixels=((595, 290),), behind_m=0.0, frame=4, names=("cabinet",)),
)
"""In the recording `RGBD`. The cabinet has depth in the last frame only, and shows little more than an edge."""
DESK = (
    Thing(name="near can", pixels=((52, 288),), names=("can",)),
    Thing(name="far can", pixels=((421, 170),), names=("can",)),
    Thing(name="mug", pixels=((424, 338),), names=("cup", "mug")),
    Thing(name="mouse", pixels=((352, 352),), names=("mouse",)),
    Thing(name="roll of tape", pixels=((528, 350),), names=("tape",)),
    Thing(name="keyboard", pixels=((272, 292),), names=("keyboard",)),
    Thing(name="screen", pixels=((297, 170),), names=("screen", "monitor")),
    Thing(name="telephone", pixels=((452, 275),), names=("telephone", "phone")),
    Thing(name="book", pixels=((518, 262),), names=("book", "box")),
    Thing(name="teddy bear", pixels=((333, 105),), names=("bear",)),
    Thing(name="carton with a label", pixels=((160, 215),), names=("box",)),
)
"""In the second frame of ``tum_desk``."""


def place(thing: Thing, depth: Path, per_metre: float, pose: np.ndarray) -> np.ndarray:
    """World position (3,) of a thing, from a few pixels around those that were pointed at."""
    picture, points = np.asarray(Image.open(depth), float), []
    for u, v in thing.pixels:
        window = picture[v - 4 : v + 5, u - 4 : u + 5]
        z = float(np.median(window[window > 0])) / per_metre
        ray = np.array([(u - 319.5) / 525.0, (v - 239.5) / 525.0, 1.0])
        points.append(ray * z + ray / np.linalg.norm(ray) * thing.behind_m)
    return pose[:3, :3] @ np.mean(points, axis=0) + pose[:3, 3]


def room_places() -> dict[str, np.ndarray]:
    """Places of `LIVING_ROOM` in the world of the recording, by name."""
    rows = [row.split() for row in (RGBD / "trajectory.log").read_text().split("\n")]
    found = {}
    for thing in LIVING_ROOM:
        pose = np.array(rows[5 * thing.frame + 1 : 5 * thing.frame + 5], float)
        found[thing.name] = place(thing, RGBD / "depth" / f"{thing.frame:05d}.png", 1000.0, pose)
    return found
