"""MovingAI benchmark maps: ``.map`` (2D, octile) and ``.3dmap`` (voxels).

Axes are those of the benchmark's scenario files, so that their coordinates are cells as they stand: x is the column and
y the row counted from the top of the file (the picture of a ``.map`` is therefore seen mirrored in a north-up plot);
in a ``.3dmap`` the three numbers of a voxel are x, y and z. Cell (0, 0, 0) has its outer corner at the world's origin.
All that is not blocked is free: these maps have no unknown cells.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import LimitError, MapError
from mintpilot.core.geometry import GridFrame
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mapping.picture_map import check_size

MAX_BYTES = 200_000_000
FREE_TERRAIN = b".GS"
BLOCKED_TERRAIN = b"@OTW"


def load_movingai(path: str | Path, *, resolution_m: float = 1.0, height_m: float = 1.0) -> SemanticMap:
    """The map in that file; ``.3dmap`` files are voxels, all others flat, flown at ``height_m``.

    ``.``, ``G`` and ``S`` (swamp) are free; ``@``, ``O``, ``T`` and ``W`` are blocked.

    Raises:
        MapError: the file is missing, unreadable, malformed or truncated.
        LimitError: it has too many cells.
    """
    path = Path(path)
    data = _bytes_of(path)
    if path.suffix == ".3dmap":
        cells, z_m = _voxels(path, data), 0.0
    else:
        cells, z_m = _octile(path, data)[None], height_m - resolution_m / 2
    nz, ny, nx = cells.shape
    frame = GridFrame(origin_m=(0.0, 0.0, z_m), resolution_m=resolution_m, shape=(nz, ny, nx))
    return SemanticMap(frame=frame, cells=cells)


def _bytes_of(path: Path) -> bytes:
    try:
        if path.stat().st_size > MAX_BYTES:
            raise LimitError(f"'{path}' has {path.stat().st_size} bytes, more than the {MAX_BYTES} that are read")
        return path.read_bytes()
    except FileNotFoundError:
        raise MapError(f"there is no map '{path}'; check the name, relative to the mission file") from None
    except OSError as error:
        raise MapError(f"map '{path}' cannot be read: {error.strerror}; give a file that you may read") from None


def _octile(path: Path, data: bytes) -> NDArray[np.uint8]:
    """Cells (ny, nx); row 0 is the first of the file."""
    lines = data.replace(b"\r", b"").split(b"\n")
    head = [line.split() for line in lines[:4]]
    keys = [part[0].lower() if part else b"" for part in head]
    if keys != [b"type", b"height", b"width", b"map"]:
        raise MapError(f"'{path}' is no MovingAI map: its first lines must be type, height, width and map")
    height, width = _count(path, head[1]), _count(path, head[2])
    check_size(path, width, height)
    rows = lines[4 : 4 + height]
    for number, row in enumerate(rows, start=5):
        if len(row) != width:
            raise MapError(f"'{path}' line {number} has {len(row)} cells, the header says {width}; is it truncated?")
    if len(rows) < height:
        raise MapError(f"'{path}' ends after {len(rows)} of {height} rows; it is truncated, copy it again")
    terrain = np.frombuffer(b"".join(rows), np.uint8).reshape(height, width)
    blocked = np.isin(terrain, list(BLOCKED_TERRAIN))
    strange = ~blocked & ~np.isin(terrain, list(FREE_TERRAIN))
    if strange.any():
        y, x = np.argwhere(strange)[0]
        raise MapError(
            f"'{path}' line {y + 5}, column {x + 1}: terrain {chr(terrain[y, x])!r} is none of . G S @ O T W"
        )
    return np.where(blocked, np.uint8(Cell.OCCUPIED), np.uint8(Cell.FREE))


def _voxels(path: Path, data: bytes) -> NDArray[np.uint8]:
    """Cells (nz, ny, nx)."""
    first, _, body = data.partition(b"\n")
    head = first.split()
    if len(head) != 4 or head[0] != b"voxel":
        raise MapError(f"'{path}' is no MovingAI voxel map: its first line must be 'voxel WIDTH HEIGHT DEPTH'")
    nx, ny, nz = (_count(path, [b"size", part]) for part in head[1:])
    check_size(path, nx, ny, nz)
    if body and not body.endswith(b"\n"):
        raise MapError(f"'{path}' does not end with a line's end; it is truncated, copy it again")
    try:
        numbers = np.array(body.split(), np.int64)
    except (ValueError, OverflowError):
        raise MapError(f"'{path}': each line after the first must be three whole numbers, x y z") from None
    if numbers.size % 3:
        raise MapError(
            f"'{path}' holds {numbers.size} numbers, not three for each voxel; it is truncated, copy it again"
        )
    blocked = numbers.reshape(-1, 3)
    outside = np.flatnonzero(((blocked < 0) | (blocked >= (nx, ny, nz))).any(axis=1))
    if outside.size:
        raise MapError(f"'{path}': voxel {blocked[outside[0]].tolist()} is outside {nx} x {ny} x {nz}")
    cells = np.full((nz, ny, nx), Cell.FREE, np.uint8)
    cells[blocked[:, 2], blocked[:, 1], blocked[:, 0]] = Cell.OCCUPIED
    return cells


def _count(path: Path, words: list[bytes]) -> int:
    if len(words) == 2 and words[1].isdigit() and len(words[1]) < 10:
        return int(words[1])
    raise MapError(f"'{path}': {b' '.join(words).decode('ascii', 'replace')!r} must be a name and a whole number")
