"""MovingAI benchmark maps: ``.map`` (2D, octile) and ``.3dmap`` (voxels).

Axes are those of the benchmark's scenario files, so that their coordinates are cells as they stand: x is the column and
y the row counted from the top of the file (the picture of a ``.map`` is therefore seen mirrored in a north-up plot);
in a ``.3dmap`` the three numbers of a voxel are x, y and z. Cell (0, 0, 0) has its outer corner at the world's origin.
All that is not blocked is free: these maps have no unknown cells.
"""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import GridFrame
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mapping.map_file import check_file
from mintpilot.mapping.picture_map import MAX_BYTES, check_size

_CHUNK_BYTES = 8_000_000
FREE_TERRAIN = b".GS"
BLOCKED_TERRAIN = b"@OTW"
_STRANGE = 255


def load_movingai(path: str | Path, *, resolution_m: float = 1.0, height_m: float = 1.0) -> SemanticMap:
    """The map in that file; ``.3dmap`` files are voxels, all others flat, flown at ``height_m``.

    ``.``, ``G`` and ``S`` (swamp) are free; ``@``, ``O``, ``T`` and ``W`` are blocked.

    Raises:
        MapError: the file is missing, unreadable, malformed or truncated.
        LimitError: it has too many cells.
    """
    path = Path(path)
    check_file(path, MAX_BYTES)
    try:
        if path.suffix == ".3dmap":
            cells, z_m = _voxels(path), 0.0
        else:
            cells, z_m = _octile(path, path.read_bytes())[None], height_m - resolution_m / 2
    except OSError as error:
        raise MapError(f"map '{path}' cannot be read: {error.strerror}; give a file that you may read") from None
    nz, ny, nx = cells.shape
    frame = GridFrame(origin_m=(0.0, 0.0, z_m), resolution_m=resolution_m, shape=(nz, ny, nx))
    return SemanticMap(frame=frame, cells=cells)


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
    states = np.full(256, _STRANGE, np.uint8)
    states[list(FREE_TERRAIN)], states[list(BLOCKED_TERRAIN)] = Cell.FREE, Cell.OCCUPIED
    cells: NDArray[np.uint8] = states[terrain]
    if cells.max() == _STRANGE:
        y, x = np.unravel_index(int(np.argmax(cells)), cells.shape)
        raise MapError(
            f"'{path}' line {y + 5}, column {x + 1}: terrain {chr(terrain[y, x])!r} is none of . G S @ O T W"
        )
    return cells


def _voxels(path: Path) -> NDArray[np.uint8]:
    """Cells (nz, ny, nx), read piece by piece."""
    with path.open("rb") as file:
        head = file.readline(1000).split()
        if len(head) != 4 or head[0] != b"voxel":
            raise MapError(f"'{path}' is no MovingAI voxel map: its first line must be 'voxel WIDTH HEIGHT DEPTH'")
        nx, ny, nz = (_count(path, [b"size", part]) for part in head[1:])
        check_size(path, nx, ny, nz)
        cells = np.full((nz, ny, nx), Cell.FREE, np.uint8)
        while piece := file.read(_CHUNK_BYTES):
            piece += file.readline(1000)
            if not piece.endswith(b"\n"):
                raise MapError(f"'{path}' does not end with a line's end; it is truncated, copy it again")
            blocked = _numbers(path, piece).reshape(-1, 3)
            outside = np.flatnonzero(((blocked < 0) | (blocked >= (nx, ny, nz))).any(axis=1))
            if outside.size:
                raise MapError(f"'{path}': voxel {blocked[outside[0]].tolist()} is outside {nx} x {ny} x {nz}")
            cells[blocked[:, 2], blocked[:, 1], blocked[:, 0]] = Cell.OCCUPIED
    return cells


def _numbers(path: Path, text: bytes) -> NDArray[np.int64]:
    """The whole numbers of some lines, three for each voxel."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            numbers = np.fromstring(text, np.int64, sep=" ") if text.strip() else np.zeros(0, np.int64)
    except (ValueError, OverflowError, DeprecationWarning):
        raise MapError(f"'{path}': each line after the first must be three whole numbers, x y z") from None
    if numbers.size % 3:
        raise MapError(
            f"'{path}' holds {numbers.size} numbers, not three for each voxel; it is truncated, copy it again"
        )
    return numbers


def _count(path: Path, words: list[bytes]) -> int:
    if len(words) == 2 and words[1].isdigit() and len(words[1]) < 10:
        return int(words[1])
    raise MapError(f"'{path}': {b' '.join(words).decode('ascii', 'replace')!r} must be a name and a whole number")
