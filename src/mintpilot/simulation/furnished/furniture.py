"""Tables and other furniture: none of it is a person, a door, smoke or fire, and none of it has to be found."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

import numpy as np

from mintpilot.simulation.furnished.shapes import Assembly, Shown
from mintpilot.simulation.furnished.style import Rgb, Style


def furniture(kind: str, style: Style, rng: np.random.Generator) -> Shown:
    """A piece of a kind, standing at the origin, its back towards -y."""
    made = Assembly()
    MAKERS[kind](made, style.wood[int(rng.integers(len(style.wood)))], rng)
    return Shown(kind="furniture", name=kind, labels=_LABELS.get(kind, frozenset({kind})), parts=tuple(made.parts))


def table(style: Style, rng: np.random.Generator) -> tuple[Shown, tuple[float, float], float]:
    """A table at the origin; half its length and depth; the height of its top."""
    length, depth, height = (float(rng.uniform(*span)) for span in style.table_m)
    wood, made = style.wood[int(rng.integers(len(style.wood)))], Assembly()
    if style.round_tables and rng.random() < 0.5:
        r = depth / 2 + 0.1
        made.upright((0, 0), height - 0.03, height, r, wood)
        made.upright((0, 0), 0.03, height - 0.03, 0.05, wood)
        made.upright((0, 0), 0.0, 0.03, 0.6 * r, wood)
        half = (0.6 * r, 0.6 * r)
    else:
        made.block((-length / 2, -depth / 2, height - 0.035), (length / 2, depth / 2, height), wood)
        for x in (-length / 2, length / 2 - 0.05):
            for y in (-depth / 2, depth / 2 - 0.05):
                made.block((x, y, 0), (x + 0.05, y + 0.05, height - 0.035), wood)
        half = (length / 2, depth / 2)
    shown = Shown(kind="furniture", name="table", labels=frozenset({"table", "desk"}), parts=tuple(made.parts))
    return shown, half, height


def _cabinet(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    w, d, h = rng.uniform(0.5, 1.1), rng.uniform(0.35, 0.5), rng.uniform(0.8, 1.9)
    made.block((-w / 2, -d / 2, 0), (w / 2, d / 2, h), wood)
    made.block((-w / 2 + 0.03, d / 2, 0.05), (-0.01, d / 2 + 0.015, h - 0.05), wood)
    made.block((0.01, d / 2, 0.05), (w / 2 - 0.03, d / 2 + 0.015, h - 0.05), wood)


def _chair(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    w, seat, back = rng.uniform(0.4, 0.5), rng.uniform(0.42, 0.48), rng.uniform(0.8, 1.0)
    made.block((-w / 2, -w / 2, seat - 0.04), (w / 2, w / 2, seat), wood)
    made.block((-w / 2, -w / 2, seat + 0.15), (w / 2, -w / 2 + 0.03, back), wood)
    for x in (-w / 2, w / 2 - 0.035):
        for y, top in ((-w / 2, back), (w / 2 - 0.035, seat)):
            made.block((x, y, 0), (x + 0.035, y + 0.035, top), wood)


def _stool(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    r, h = float(rng.uniform(0.16, 0.22)), float(rng.uniform(0.42, 0.7))
    made.upright((0, 0), h - 0.06, h, r, wood)
    made.upright((0, 0), 0.02, h - 0.06, 0.03, (0.6, 0.6, 0.62))
    made.upright((0, 0), 0.0, 0.02, 0.9 * r, (0.6, 0.6, 0.62))


def _shelf(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    w, d, h = rng.uniform(0.7, 1.3), rng.uniform(0.28, 0.4), rng.uniform(1.2, 1.9)
    made.block((-w / 2, -d / 2, 0), (-w / 2 + 0.03, d / 2, h), wood)
    made.block((w / 2 - 0.03, -d / 2, 0), (w / 2, d / 2, h), wood)
    made.block((-w / 2, -d / 2, 0), (w / 2, -d / 2 + 0.015, h), wood)
    for level in np.linspace(0.05, h - 0.03, int(rng.integers(3, 6))):
        made.block((-w / 2, -d / 2, level), (w / 2, d / 2, level + 0.025), wood)


def _bed(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    w, h = rng.uniform(0.85, 1.0), rng.uniform(0.45, 0.7)
    made.block((-1.0, -w / 2, h - 0.18), (1.0, w / 2, h), (0.9, 0.92, 0.94))
    made.blob((0.78, 0, h + 0.02), (0.18, 0.3, 0.07), (0.95, 0.95, 0.96))
    for x in (-0.98, 0.93):
        for y in (-w / 2, w / 2 - 0.05):
            made.block((x, y, 0), (x + 0.05, y + 0.05, h - 0.18), wood)
    made.block((0.98, -w / 2, 0.2), (1.01, w / 2, h + 0.35), wood)


def _screen(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    w, h = rng.uniform(0.6, 1.0), rng.uniform(1.5, 1.8)
    made.block((-w, -0.015, 0.1), (0, 0.015, h), wood)
    made.block((0, -0.015, 0.1), (0.03, 0.5, h), wood)
    for x in (-w, -0.03):
        made.block((x, -0.2, 0), (x + 0.04, 0.2, 0.1), wood)


def _drum(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    made.upright((0, 0), 0.0, float(rng.uniform(0.8, 0.95)), float(rng.uniform(0.27, 0.31)), wood)


def _pile(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    for _ in range(int(rng.integers(3, 7))):
        x, y = rng.uniform(-0.4, 0.4, 2)
        a, b, c = rng.uniform(0.1, 0.25, 3)
        if rng.random() < 0.5:
            made.blob((float(x), float(y), float(c)), (float(a), float(b), float(c)), wood)
        else:
            made.block((x - a, y - b, 0), (x + a, y + b, c), wood)


def _bench(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    w, h = rng.uniform(1.0, 1.6), rng.uniform(0.4, 0.5)
    made.block((-w / 2, -0.17, h - 0.05), (w / 2, 0.17, h), wood)
    for x in (-w / 2 + 0.1, w / 2 - 0.16):
        made.block((x, -0.15, 0), (x + 0.06, 0.15, h - 0.05), wood)


MAKERS: MappingProxyType[str, Callable[[Assembly, Rgb, np.random.Generator], None]] = MappingProxyType(
    {
        "cabinet": _cabinet,
        "chair": _chair,
        "stool": _stool,
        "shelf": _shelf,
        "bed": _bed,
        "screen": _screen,
        "drum": _drum,
        "pile": _pile,
        "bench": _bench,
    }
)
_LABELS = {
    "drum": frozenset({"drum", "barrel"}),
    "cabinet": frozenset({"cabinet", "box", "cupboard"}),
    "stool": frozenset({"stool", "chair"}),
}
"""Names that are right, where there are more than the kind's own."""
