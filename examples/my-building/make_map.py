"""Draws the map of a small building as ROS map_server files: `building.pgm` and `building.yaml`.

    python examples/my-building/make_map.py

Two halls, a wall between them with a middle gate and a northern one, a shelf, a closed room in the south-east.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

RESOLUTION_M = 0.1
ORIGIN_M = (-1.0, -1.0)
SIZE_M = (18.0, 12.0)
FREE, OCCUPIED, UNKNOWN = 254, 0, 205

INSIDE = (0.0, 0.0, 16.0, 10.0)
WALLS = (
    (0.0, 0.0, 16.0, 0.2),
    (0.0, 9.8, 16.0, 10.0),
    (0.0, 0.0, 0.2, 10.0),
    (15.8, 0.0, 16.0, 10.0),
    (7.9, 0.0, 8.1, 4.2),  # between the halls; the middle gate is from y = 4.2 to 5.8
    (7.9, 5.8, 8.1, 8.2),  # the northern gate is from y = 8.2 on
    (3.0, 6.6, 5.5, 7.4),  # a shelf
    (12.0, 0.0, 12.2, 4.0),  # the closed room, its door drawn shut
    (12.0, 3.8, 16.0, 4.0),
)


def draw() -> np.ndarray:
    """The map as grey values, row 0 in the south."""
    width, height = (round(edge / RESOLUTION_M) for edge in SIZE_M)
    grey = np.full((height, width), UNKNOWN, np.uint8)
    for shade, boxes in ((FREE, (INSIDE,)), (OCCUPIED, WALLS)):
        for x0, y0, x1, y1 in boxes:
            columns = slice(*(round((x - ORIGIN_M[0]) / RESOLUTION_M) for x in (x0, x1)))
            rows = slice(*(round((y - ORIGIN_M[1]) / RESOLUTION_M) for y in (y0, y1)))
            grey[rows, columns] = shade
    # Nobody has seen the inside of the closed room.
    grey[12:48, 132:168] = UNKNOWN
    return grey


def main(folder: Path = Path(__file__).parent) -> None:
    """Writes both files."""
    Image.fromarray(draw()[::-1]).save(folder / "building.pgm")
    (folder / "building.yaml").write_text(
        "image: building.pgm\n"
        "mode: trinary\n"
        f"resolution: {RESOLUTION_M}\n"
        f"origin: [{ORIGIN_M[0]}, {ORIGIN_M[1]}, 0.0]\n"
        "negate: 0\n"
        "occupied_thresh: 0.65\n"
        "free_thresh: 0.196\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
