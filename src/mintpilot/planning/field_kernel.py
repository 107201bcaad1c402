"""The compiled heart of distance fields; it may stop and go on. Label-correcting, as `mintpilot.planning.kernels`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.buckets import (
    FULL,
    KNOWN,
    PER_EDGE,
    RING,
    SLACK,
    coordinates,
    lowest_bit,
    octile,
    put,
    redundant,
)
from mintpilot.planning.lattice import Words


@compiled(error_model="numpy")
def field(
    allowed: Words,
    offset: Ints,
    step: Floats,
    length: Floats,
    after: NDArray[np.uint32],
    detour: NDArray[np.uint32],
    open_ground: np.uint32,
    nx: int,
    ny: int,
    source: int,
    target: int,
    until: float,
    hold: bool,
    cells: NDArray[np.void],
    tag: int,
    pool: NDArray[np.void],
    head: NDArray[np.int32],
    queue: Ints,
) -> tuple[float, int]:
    """Grows the exact distances from the source in the order of f = distance + octile distance to the target.

    With target -1, f is the distance. ``head`` and ``queue`` (first unused entry or -1, entries ever used, entries
    queued, bucket) are left so that the next call goes on from here. Distances stay in ``cells``.

    It stops when all nodes whose f is at most ``until`` were expanded; with ``hold`` also as soon as the distance to
    the target is known.

    Returns:
        (reach: every distance whose f is less is exact; infinite when all are; `FULL` when the pool is too small;
        nodes expanded).
    """
    gx, gy, gz = coordinates(max(target, 0), nx, ny)
    x, y, z = coordinates(source, nx, ny)
    f0 = octile(x - gx, y - gy, z - gz) if target >= 0 else 0.0
    spare, used, queued, bucket = queue[0], queue[1], queue[2], queue[3]
    expanded, reach = 0, np.inf
    while queued > 0:
        if used + length.size > pool.size:
            reach = FULL
            break
        entry = head[bucket & (RING - 1)]
        if entry < 0:
            edge = f0 + (bucket + 1) / PER_EDGE
            if edge > until + SLACK or (hold and cells[target].tag == tag and cells[target].g <= edge + SLACK):
                reach = edge
                break
            bucket += 1
            continue
        node, g = pool[entry].node, pool[entry].g
        head[bucket & (RING - 1)] = pool[entry].next
        pool[entry].next = spare
        spare = entry
        queued -= 1
        if cells[node].g != g:
            continue
        expanded += 1
        last = cells[node].last
        cells[node].last = last | KNOWN
        x, y, z = coordinates(node, nx, ny)
        ground = allowed[node] >> np.uint64(32)
        word = allowed[node] & after[last, 1 if ground == open_ground else 0]
        while word:
            k = lowest_bit(word)
            word &= word - np.uint64(1)
            if redundant(ground, detour, last, k):
                continue
            to = node + offset[k]
            cost = g + length[k]
            if cells[to].tag == tag and cost >= cells[to].g - 1e-12:
                continue
            f = cost
            if target >= 0:
                f += octile(x + step[k, 2] - gx, y + step[k, 1] - gy, z + step[k, 0] - gz)
            cells[to].g = cost
            cells[to].tag = tag
            cells[to].last = k
            spare, used = put(pool, head, max(bucket, int((f - f0) * PER_EDGE)), to, cost, spare, used)
            queued += 1
    queue[0], queue[1], queue[2], queue[3] = spare, used, queued, bucket
    return reach, expanded
