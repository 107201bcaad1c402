"""Frames that may be doors': two jambs and a lintel in a wall's picture, and what speaks for and against each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.perception.view import Singles
from mintpilot.perception.wall_pictures import CELL_M, WallPicture

WIDTH_M, HEIGHT_M = (0.58, 2.3), (1.78, 2.36)
"""Doors, those of two leaves included."""
JAMB_M = (0.1, 1.75)
"""Heights at which upright lines are looked for."""
LINES, LEAST_LINE, LEAST_SEEN = 28, 0.3, 0.3
"""So many upright lines of a wall at most are taken for jambs: those seen so far, and there at so many heights."""
BEYOND_M, BESIDE_M, ABOVE_M = (0.36, 0.75), (0.1, 0.32), (0.12, 0.4)
"""How far outside of a frame it is looked whether a lintel goes on, what the wall is like, and whether a jamb goes on;
casings and rails of sliding doors end before."""
KNEE_M, USUAL_M = 0.6, 2.05
"""Jambs are seen below this height too; and how high most doors are."""
SOME = 0.15
"""The colour and the place of a part of the wall is known where this share of it is seen."""
UNKNOWN = 0.3
"""What counts for the strength of a line that is not in view."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DoorFrames:
    """Possible doors of one wall; arrays have one entry, or row, for each."""

    left: Ints
    right: Ints
    """Columns of the wall's picture where they begin and end."""
    top: Ints
    """Rows at which they end; where the picture ends before, the last one that is seen."""
    evidence: Floats
    """What speaks for and against each (n, len(EVIDENCE))."""


EVIDENCE = (
    "jambs, mean", "jambs, weaker", "jambs near the floor", "lintel", "lintel in view", "lintel goes on",
    "jambs go on above", "colour against the wall", "relief against the wall", "sides differ in colour",
    "wall beside", "inside in view", "inside uneven", "pixels", "narrow", "wide", "height", "level lines inside",
    "upright lines inside", "lintel x jambs", "wall above differs",
)  # fmt: skip
"""Names of the columns of `DoorFrames.evidence`."""


def door_frames(wall: WallPicture) -> DoorFrames | None:
    """All pairs of jambs with the lintel that suits them best; None where there are none."""
    rows = [round(h / CELL_M) for h in JAMB_M]
    columns = _jambs(wall, rows[0], rows[1])
    if len(columns) < 2:
        return None
    i, j = np.triu_indices(len(columns), 1)
    left, right = columns[i], columns[j]
    wide = (right - left) * CELL_M
    fits = (wide >= WIDTH_M[0]) & (wide <= WIDTH_M[1])
    left, right = left[fits], right[fits]
    if not len(left):
        return None
    return _with_evidence(_Sums(wall), left, right)


def _jambs(wall: WallPicture, low: int, high: int) -> Ints:
    """Columns at whose left edge an upright line runs, the strongest of each few."""
    seen = wall.seen[low:high].mean(axis=0)
    strength = wall.upright[low:high].sum(axis=0) / np.maximum(wall.seen[low:high].sum(axis=0), 1)
    strength = np.where(seen >= LEAST_SEEN, strength, 0.0)
    padded = np.pad(strength, 1)
    peak = (strength >= padded[:-2]) & (strength > padded[2:]) & (strength >= LEAST_LINE)
    columns = np.flatnonzero(peak)
    kept: Ints = np.sort(columns[np.argsort(-strength[columns], kind="stable")[:LINES]])
    return kept


class _Sums:
    """Integral images of a wall's picture: means over rectangles of it, however many."""

    def __init__(self, wall: WallPicture) -> None:
        self.seen = _integral(wall.seen.astype(np.float32))
        self.upright, self.level = _integral(wall.upright), _integral(wall.level)
        self.rgb, self.off, self.square = (_integral(v) for v in (wall.rgb, wall.off_m, wall.off_m * wall.off_m))
        self.pixels = _integral(wall.pixels)
        last: Ints = wall.seen.shape[0] - 1 - wall.seen[::-1].argmax(axis=0)
        self.last = last
        """Highest row that is seen in each column."""

    def share(self, table: Floats, r0: Ints, r1: Ints, c0: Ints, c1: Ints, least: float = 0.25) -> Floats:
        """Mean over what is seen of each rectangle; NaN where too little of it is."""
        there = _over(self.seen, r0, r1, c0, c1)
        enough = there >= np.maximum(least * np.maximum(r1 - r0, 0) * np.maximum(c1 - c0, 0), 1)
        total, count = _over(table, r0, r1, c0, c1), np.maximum(there, 1)
        if total.ndim > there.ndim:
            count, enough = count[..., None], enough[..., None]
        return np.where(enough, total / count, np.nan)

    def visible(self, r0: Ints, r1: Ints, c0: Ints, c1: Ints) -> Floats:
        """Share of each rectangle that is seen."""
        return _over(self.seen, r0, r1, c0, c1) / np.maximum((r1 - r0) * (c1 - c0), 1)


def _integral(values: Singles) -> Floats:
    table = np.zeros((values.shape[0] + 1, values.shape[1] + 1, *values.shape[2:]))
    table[1:, 1:] = values.cumsum(axis=0, dtype=np.float64).cumsum(axis=1)
    return table


def _over(table: Floats, r0: Ints, r1: Ints, c0: Ints, c1: Ints) -> Floats:
    """Sum over rows r0 to r1 - 1 and columns c0 to c1 - 1, kept within the picture; 0 for empty ones."""
    h, w = table.shape[0] - 1, table.shape[1] - 1
    r0, r1, c0, c1 = np.clip(r0, 0, h), np.clip(r1, 0, h), np.clip(c0, 0, w), np.clip(c1, 0, w)
    r1, c1 = np.maximum(r0, r1), np.maximum(c0, c1)
    found: Floats = table[r1, c1] - table[r0, c1] - table[r1, c0] + table[r0, c0]
    return found


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Outline:
    """Where each frame ends, and how strong its lines are; NaN for what is not in view."""

    top: Ints
    in_view: Bools
    """Whether the picture reaches up to the lintel."""
    lintel: Floats
    goes_on: Floats
    """Strength of the lintel's line beyond the jambs."""
    jambs: tuple[Floats, Floats]
    above: Floats
    """Strength of the jambs' lines above the lintel."""


def _outline(sums: _Sums, left: Ints, right: Ints) -> _Outline:
    """The height at which lines end as a door's do: a level one between the jambs, that does not go on, nor do they."""
    foot, n_rows = round(JAMB_M[0] / CELL_M), len(sums.seen) - 1
    tops = np.arange(round(HEIGHT_M[0] / CELL_M), min(n_rows - 1, round(HEIGHT_M[1] / CELL_M)) + 1)
    t, a, b = np.broadcast_arrays(tops[None, :], left[:, None], right[:, None])
    (near, far), (low, high) = ([round(d / CELL_M) for d in span] for span in (BEYOND_M, ABOVE_M))
    lintel = sums.share(sums.level, t, t + 1, a + 1, b - 1)
    goes_on = np.fmax(
        sums.share(sums.level, t, t + 1, a - far, a - near), sums.share(sums.level, t, t + 1, b + near, b + far)
    )
    jambs = [sums.share(sums.upright, foot + 0 * t, t - 1, c, c + 1) for c in (a, b)]
    above = np.fmax(*(sums.share(sums.upright, t + low, t + high, c, c + 1) for c in (a, b)))
    mean = (_known(jambs[0]) + _known(jambs[1])) / 2
    rank = np.where(
        np.isnan(lintel), -np.inf, _known(lintel) - 0.7 * _known(goes_on) + 0.7 * mean - 0.3 * _known(above)
    )
    best, each = rank.argmax(axis=1), np.arange(len(left))
    in_view = np.isfinite(rank[each, best])
    ends = np.minimum(np.minimum(sums.last[left], sums.last[np.minimum(right, len(sums.last) - 1)]), tops[-1])
    top = np.where(in_view, tops[best], np.maximum(ends, foot + 1))
    whole = [sums.share(sums.upright, foot + 0 * top, top, c, c + 1) for c in (left, right)]
    return _Outline(
        top=top,
        in_view=in_view,
        lintel=np.where(in_view, lintel[each, best], np.nan),
        goes_on=np.where(in_view, goes_on[each, best], np.nan),
        jambs=tuple(np.where(in_view, j[each, best], w) for j, w in zip(jambs, whole, strict=True)),  # type: ignore[arg-type]
        above=np.where(in_view, above[each, best], np.nan),
    )


def _with_evidence(sums: _Sums, left: Ints, right: Ints) -> DoorFrames:
    """The frames between pairs of columns, with what the inside is like against the wall beside and above."""
    outline = _outline(sums, left, right)
    top = outline.top
    low, knee = (round(h / CELL_M) + 0 * top for h in (JAMB_M[0], KNEE_M))
    near, far = (round(d / CELL_M) for d in BESIDE_M)
    inner = (low, top - 2, left + 2, right - 2)
    deeper = (low + 3, top - 3, left + 3, right - 3)
    sides = ((low, top, left - far, left - near), (low, top, right + near, right + far))
    inside, depth = sums.share(sums.rgb, *inner, least=SOME), sums.share(sums.off, *inner, least=SOME)
    beside = [sums.share(sums.rgb, *side, least=SOME) for side in sides]
    roof = sums.share(sums.rgb, top + 3, top + 10, left, right, least=SOME)
    differ = np.fmin(*(_difference(inside, one) for one in beside))
    relief = np.fmin(*(np.minimum(np.abs(depth - sums.share(sums.off, *s, least=SOME)) / 0.05, 1.5) for s in sides))
    spread = np.sqrt(np.maximum(sums.share(sums.square, *inner) - _known(depth, 0.0) ** 2, 0.0))
    feet = sum(_known(sums.share(sums.upright, low, knee, c, c + 1)) for c in (left, right))
    jl, jr = (_known(jamb) for jamb in outline.jambs)
    line, width = _known(outline.lintel), (right - left) * CELL_M
    pixels = np.log10(np.maximum(_over(sums.pixels, low, top, left, right), 10))
    evidence = np.column_stack([
        (jl + jr) / 2, np.minimum(jl, jr), feet / 2, line, outline.in_view, _known(outline.goes_on),
        _known(outline.above), _known(differ, 0.05) ** 0.5, _known(relief, 0.2),
        _known(_difference(*beside), 0.1), np.minimum(*(sums.visible(*side) for side in sides)),
        sums.visible(*inner), np.minimum(_known(spread, 0.02) / 0.03, 2.0), np.minimum(pixels, 4.0),
        np.maximum(0.0, 0.8 - width), np.maximum(0.0, width - 1.1),
        np.where(outline.in_view, np.abs(top * CELL_M - USUAL_M), 0.1),
        _known(sums.share(sums.level, *deeper)), _known(sums.share(sums.upright, *deeper)), line * (jl + jr) / 2,
        _known(_difference(roof, inside), 0.1) ** 0.5,
    ])  # fmt: skip
    return DoorFrames(left=left, right=right, top=top, evidence=evidence)


def _known(values: Floats, otherwise: float = UNKNOWN) -> Floats:
    return np.where(np.isnan(values), otherwise, values)


def _difference(one: Floats, other: Floats) -> Floats:
    """Of colours (n, 3), in the channel in which it is greatest, as a share of the full range."""
    most: Floats = np.abs(one - other).max(axis=1) / 255
    return most
