"""Warehouses to search in, drawn from a seed, and regions put where they hurt most."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from mintpilot.core.geometry import Bools, Ints
from mintpilot.planning.joint_search import JointSearch

Cell3 = tuple[int, int, int]


@dataclass(frozen=True, kw_only=True, eq=False)
class World:
    """A grid with the half edges of the boxes that serve as regions."""

    name: str
    free: Bools
    half: Cell3


def warehouse_2d(edge: int, seed: int = 0) -> World:
    """Shelves 4 wide with aisles of 4, cut by cross aisles at random distances, and pallets left standing about."""
    rng = np.random.default_rng(seed)
    free = np.ones((1, edge, edge), bool)
    for x in range(8, edge - 8, 8):
        y = 6
        while y < edge - 6:
            end = min(y + int(rng.integers(30, 80)), edge - 6)
            free[0, y:end, x : x + 4] = False
            y = end + 5
    for _ in range(edge // 2):
        y, x = rng.integers(6, edge - 8, 2)
        free[0, y : y + 2, x : x + int(rng.integers(2, 4))] = False
    return World(name=f"2D {edge} x {edge}", free=free, half=(0, 6, 6))


def warehouse_3d(nx: int, ny: int, nz: int, half: Cell3, seed: int = 0) -> World:
    """Racks 2 deep of many heights with empty slots, aisles of 4, and two walls with four openings each."""
    rng = np.random.default_rng(seed)
    free = np.ones((nz, ny, nx), bool)
    for x in range(5, nx - 5, 6):
        y = 4
        while y < ny - 8:
            length = int(rng.integers(12, 30))
            end = min(y + length, ny - 4)
            height = nz if rng.random() < 0.5 else int(nz * rng.uniform(0.6, 0.95))
            free[:height, y:end, x : x + 2] = False
            for _ in range(length * height // 40):
                slot_y, slot_z = int(rng.integers(y, end)), int(rng.integers(0, max(1, height - 3)))
                free[slot_z : slot_z + 2, slot_y : slot_y + 2, x : x + 2] = True
            y = end + int(rng.integers(3, 7))
    for x in (nx // 3, 2 * nx // 3):
        free[:, :, x] = False
        for _ in range(4):
            y, z = int(rng.integers(2, ny - 8)), int(rng.integers(0, max(1, nz - 6)))
            free[z : z + 5, y : y + 5, x] = True
    return World(name=f"3D {nx} x {ny} x {nz}", free=free, half=half)


def far_pairs(world: World, count: int, seed: int = 5) -> list[tuple[Cell3, Cell3]]:
    """Connected pairs of cells, at least 0.6 of the longest edge apart along some axis."""
    rng = np.random.default_rng(seed)
    parts, _ = ndimage.label(world.free)
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    cells = np.argwhere(parts == sizes.argmax())
    pairs: list[tuple[Cell3, Cell3]] = []
    while len(pairs) < count:
        a, b = cells[rng.integers(len(cells), size=2)]
        if np.abs(a - b).max() >= 0.6 * max(world.free.shape):
            pairs.append((_cell(a), _cell(b)))
    return pairs


def adversarial_regions(world: World, ends: tuple[Cell3, Cell3], count: int, seed: int) -> list[Ints]:
    """Boxes that do not overlap, each centred on the best path that is left when all earlier ones are blocked."""
    rng = np.random.default_rng(seed)
    taken = np.zeros(world.free.shape, bool)
    regions: list[Ints] = []
    search = JointSearch(world.free, [])
    for _ in range(50 * count):
        if len(regions) == count:
            break
        found = search.grid.shortest_path(*ends)
        cells = np.argwhere(world.free) if found is None else found[1]
        low, high = int(len(cells) * 0.1), int(len(cells) * 0.9)
        centre = cells[rng.integers(low, max(high, low + 1))]
        box = np.zeros(world.free.shape, bool)
        box[tuple(slice(max(0, c - h), c + h + 1) for c, h in zip(centre, world.half, strict=True))] = True
        if any(box[end] for end in ends) or not (box & world.free & ~taken).any():
            continue
        regions.append(np.flatnonzero(box & world.free & ~taken).astype(np.int64))
        taken |= box
        search = JointSearch(world.free & ~taken, [])
    return regions


def _cell(cell: Ints) -> Cell3:
    z, y, x = (int(i) for i in cell)
    return (z, y, x)
