"""Tables and other furniture: none of it is a person, a door, smoke or fire, and none of it has to be found."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

import numpy as np

from mintpilot.core.geometry import Vec3
from mintpilot.simulation.furnished.shapes import Assembly, Shown
from mintpilot.simulation.furnished.style import Rgb, Style

STEEL: Rgb = (0.66, 0.67, 0.70)


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


def lie_m(rest: Shown) -> Vec3:
    """Where on a bed or sofa the middle of somebody lies: on its first part."""
    box = rest.parts[0].box()
    return (box.centre_m[0], box.centre_m[1], box.hi_m[2])


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


def _dark(colour: Rgb, share: float = 0.8) -> Rgb:
    return (share * colour[0], share * colour[1], share * colour[2])


def _sofa(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """Seats, a back, arms: long enough to lie on."""
    w, seat, back = float(rng.uniform(1.7, 1.9)), float(rng.uniform(0.40, 0.46)), float(rng.uniform(0.75, 0.90))
    made.block((-w / 2, -0.12, 0.12), (w / 2, 0.55, seat), wood)
    made.block((-w / 2, -0.33, 0.05), (w / 2, -0.10, back), _dark(wood, 0.92))
    for side in (-1, 1):
        lo, hi = sorted((side * w / 2, side * (w / 2 + 0.16)))
        made.block((lo, -0.33, 0.0), (hi, 0.55, seat + 0.18), _dark(wood, 0.92))
        made.rod((side * (w / 2 + 0.08), -0.3, seat + 0.18), (side * (w / 2 + 0.08), 0.5, seat + 0.18), 0.08, wood)


def _armchair(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    w, seat, back = float(rng.uniform(0.55, 0.65)), float(rng.uniform(0.38, 0.44)), float(rng.uniform(0.85, 1.05))
    made.block((-w / 2, -0.15, 0.1), (w / 2, 0.45, seat), wood)
    made.blob((0, 0.15, seat), (w / 2, 0.3, 0.06), wood)
    made.block((-w / 2, -0.33, 0.1), (w / 2, -0.13, back), _dark(wood, 0.9))
    for side in (-1, 1):
        made.rod((side * (w / 2 + 0.07), -0.25, seat + 0.15), (side * (w / 2 + 0.07), 0.4, seat + 0.15), 0.07, wood)
        lo, hi = sorted((side * w / 2, side * (w / 2 + 0.12)))
        made.block((lo, -0.3, 0.0), (hi, 0.42, seat + 0.15), _dark(wood, 0.9))


def _cot(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """A hospital bed on castors, with rails."""
    w, h = float(rng.uniform(0.86, 0.96)), float(rng.uniform(0.55, 0.75))
    y = 0.16
    made.block((-1.0, y - w / 2, h - 0.14), (1.0, y + w / 2, h), (0.90, 0.92, 0.95))
    made.block((-1.02, y - w / 2, h - 0.24), (1.02, y + w / 2, h - 0.14), wood)
    made.blob((0.76, y, h + 0.02), (0.2, 0.32, 0.07), (0.97, 0.97, 0.98))
    for x, top in ((1.02, h + 0.42), (-1.05, h + 0.22)):
        made.block((x, y - w / 2, 0.35), (x + 0.03, y + w / 2, top), _dark(wood, 0.85))
    for side in (-1, 1):
        for z in (h + 0.06, h + 0.2):
            made.rod((-0.1, y + side * (w / 2 + 0.02), z), (0.75, y + side * (w / 2 + 0.02), z), 0.013, STEEL)
        for x in (-0.85, 0.85):
            made.block((x - 0.03, y + side * 0.38 - 0.03, 0.1), (x + 0.03, y + side * 0.38 + 0.03, h - 0.24), STEEL)
            made.blob((x, y + side * 0.38, 0.06), (0.06, 0.025, 0.06), (0.1, 0.1, 0.1))


def _radiator(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:  # noqa: ARG001
    w, low, high = float(rng.uniform(0.7, 1.5)), 0.12, float(rng.uniform(0.6, 0.8))
    for x in np.arange(-w / 2, w / 2, 0.08):
        made.block((x, -0.3, low), (x + 0.055, -0.2, high), (0.92, 0.91, 0.88))
    made.block((-w / 2, -0.28, low + 0.04), (w / 2, -0.22, low + 0.09), (0.92, 0.91, 0.88))
    made.block((-w / 2, -0.28, high - 0.09), (w / 2, -0.22, high - 0.04), (0.92, 0.91, 0.88))


def _trolley(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """Trays one above the other, on castors, with a bar to push it by."""
    w, d, h = float(rng.uniform(0.6, 0.85)), float(rng.uniform(0.4, 0.5)), float(rng.uniform(0.8, 0.95))
    for z in (0.16, (h + 0.16) / 2, h):
        made.block((-w / 2, -d / 2, z - 0.025), (w / 2, d / 2, z), wood)
    for x in (-w / 2 + 0.02, w / 2 - 0.02):
        for y in (-d / 2 + 0.02, d / 2 - 0.02):
            made.upright((x, y), 0.08, h + 0.05, 0.014, STEEL)
            made.blob((x, y, 0.045), (0.045, 0.02, 0.045), (0.1, 0.1, 0.1))
    made.rod((w / 2 + 0.06, -d / 2, h + 0.05), (w / 2 + 0.06, d / 2, h + 0.05), 0.014, STEEL)


def _ladder(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """A stepladder, opened."""
    h, foot = float(rng.uniform(1.2, 1.9)), float(rng.uniform(0.26, 0.3))
    for side in (-1, 1):
        x, top = side * foot, side * 0.17
        made.rod((x, 0.45, 0.02), (top, 0.02, h), 0.022, wood)
        made.rod((x, -0.3, 0.02), (top, -0.02, h), 0.018, STEEL)
    for z in np.arange(0.25, h, 0.27):
        share = z / h
        half = foot + share * (0.17 - foot)
        y = 0.45 + share * (0.02 - 0.45)
        made.block((-half, y - 0.05, z - 0.015), (half, y + 0.04, z + 0.01), wood)
    made.block((-0.19, -0.1, h), (0.19, 0.12, h + 0.03), wood)


def _floor_lamp(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """As tall as somebody, with a head: but nobody."""
    h = float(rng.uniform(1.4, 1.75))
    made.upright((0, 0), 0.0, 0.03, 0.14, wood)
    made.upright((0, 0), 0.03, h - 0.2, 0.015, wood)
    made.upright((0, 0), h - 0.28, h, float(rng.uniform(0.16, 0.22)), (0.93, 0.86, 0.68))


def _coats(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """A stand with coats and hats on it."""
    h = float(rng.uniform(1.65, 1.85))
    made.upright((0, 0), 0.0, 0.03, 0.2, wood)
    made.upright((0, 0), 0.03, h, 0.025, wood)
    for turn in (0.3, 2.4, 4.5):
        c, s = float(np.cos(turn)), float(np.sin(turn))
        made.rod((0, 0, h - 0.15), (0.16 * c, 0.16 * s, h - 0.08), 0.014, wood)
        if rng.random() < 0.7:
            colour = [(0.18, 0.22, 0.32), (0.42, 0.34, 0.24), (0.45, 0.12, 0.14), (0.25, 0.28, 0.2)][
                int(rng.integers(4))
            ]
            long = float(rng.uniform(0.7, 1.0))
            made.rod((0.15 * c, 0.15 * s, h - 0.2), (0.17 * c, 0.17 * s, h - long), 0.1, colour, tapered=True)
            for side in (-0.13, 0.13):
                top = (0.15 * c - side * s, 0.15 * s + side * c, h - 0.26)
                made.rod(top, (top[0], top[1], h - 0.75), 0.05, colour)


def _lockers(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """Two to four side by side, each with a narrow door."""
    count, h = int(rng.integers(2, 5)), float(rng.uniform(1.5, 1.85))
    w = 0.32 * count
    made.block((-w / 2, -0.3, 0.06), (w / 2, 0.18, h), _dark(wood))
    made.block((-w / 2, -0.28, 0.0), (w / 2, 0.14, 0.06), (0.1, 0.1, 0.1))
    for i in range(count):
        x = -w / 2 + 0.32 * i
        made.block((x + 0.01, 0.18, 0.09), (x + 0.31, 0.195, h - 0.03), wood)
        made.block((x + 0.26, 0.195, 0.95), (x + 0.28, 0.215, 1.08), STEEL)
        for z in (h - 0.16, h - 0.2, h - 0.24):
            made.block((x + 0.08, 0.195, z), (x + 0.24, 0.197, z + 0.015), (0.1, 0.1, 0.1))


def _fridge(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:  # noqa: ARG001
    h, white = float(rng.uniform(1.5, 1.85)), (0.92, 0.93, 0.93)
    made.block((-0.3, -0.3, 0.03), (0.3, 0.25, h), white)
    for low, high in ((0.06, 0.62 * h), (0.64 * h, h - 0.01)):
        made.block((-0.298, 0.25, low), (0.298, 0.30, high), white)
        made.block((0.22, 0.30, high - 0.4), (0.25, 0.34, high - 0.1), STEEL)


def _counter(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """A kitchen's: cupboards, a hob or a sink with its tap."""
    w = float(rng.uniform(1.2, 1.8))
    made.block((-w / 2, -0.28, 0.1), (w / 2, 0.27, 0.87), wood)
    made.block((-w / 2, -0.28, 0.0), (w / 2, 0.2, 0.1), (0.1, 0.1, 0.1))
    made.block((-w / 2 - 0.01, -0.3, 0.87), (w / 2 + 0.01, 0.3, 0.91), (0.32, 0.30, 0.29))
    for x in np.arange(-w / 2, w / 2 - 0.3, w / 3):
        made.block((x + 0.01, 0.27, 0.13), (x + w / 3 - 0.01, 0.288, 0.84), _dark(wood, 0.94))
        made.block((x + 0.1, 0.288, 0.76), (x + w / 3 - 0.1, 0.31, 0.78), STEEL)
    if rng.random() < 0.5:
        made.block((-0.25, -0.18, 0.91), (0.25, 0.2, 0.915), STEEL)
        made.upright((0, -0.22), 0.91, 1.15, 0.014, STEEL)
        made.rod((0, -0.22, 1.15), (0, -0.06, 1.12), 0.012, STEEL)
    else:
        for x in (-0.14, 0.14):
            for y in (-0.12, 0.12):
                made.upright((x, y), 0.91, 0.918, 0.08, (0.06, 0.06, 0.06))


def _drip(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:  # noqa: ARG001
    """A stand with bags of a liquid."""
    h = float(rng.uniform(1.7, 2.0))
    for turn in np.arange(5) * 1.2566:
        made.rod((0, 0, 0.1), (0.26 * float(np.cos(turn)), 0.26 * float(np.sin(turn)), 0.04), 0.016, STEEL)
    made.upright((0, 0), 0.1, h, 0.014, STEEL)
    made.rod((-0.14, 0, h), (0.14, 0, h), 0.01, STEEL)
    made.block((-0.19, -0.025, h - 0.28), (-0.09, 0.025, h - 0.04), (0.85, 0.88, 0.80))
    made.block((-0.07, -0.08, 0.95), (0.07, 0.06, 1.2), (0.80, 0.82, 0.84))


def _wheelchair(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    seat = float(rng.uniform(0.46, 0.52))
    made.block((-0.22, -0.2, seat - 0.03), (0.22, 0.22, seat), wood)
    made.block((-0.22, -0.23, seat), (0.22, -0.2, seat + 0.45), wood)
    for side in (-1, 1):
        for turn in np.arange(16) * np.pi / 8:
            a, b = turn, turn + np.pi / 8
            ring = [(0.27 * side, -0.08 + 0.29 * float(np.cos(t)), 0.3 + 0.29 * float(np.sin(t))) for t in (a, b)]
            made.rod((ring[0][0], ring[0][1], ring[0][2]), (ring[1][0], ring[1][1], ring[1][2]), 0.014, (0.1, 0.1, 0.1))
        made.rod((0.24 * side, -0.2, seat + 0.2), (0.24 * side, 0.2, seat + 0.2), 0.02, (0.1, 0.1, 0.1))
        made.rod((0.22 * side, -0.22, seat + 0.4), (0.22 * side, -0.36, seat + 0.45), 0.013, (0.1, 0.1, 0.1))
        made.rod((0.2 * side, 0.22, seat), (0.2 * side, 0.42, 0.12), 0.013, STEEL)
        made.blob((0.2 * side, 0.3, 0.08), (0.02, 0.08, 0.08), (0.1, 0.1, 0.1))
        made.block((0.1 * side - 0.07, 0.38, 0.1), (0.1 * side + 0.07, 0.5, 0.12), (0.1, 0.1, 0.1))


def _curtain(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """Folds of cloth that hang from a rail across the room, to part one bed from the next."""
    w, out = float(rng.uniform(1.2, 1.8)), 0.0
    for i, x in enumerate(np.arange(-w / 2, w / 2, 0.1)):
        out = float(rng.uniform(-0.03, 0.03)) + 0.03 * (i % 2)
        made.rod((float(x), out, 0.35), (float(x), out, 2.1), 0.06, wood)
    made.rod((-w / 2 - 0.1, 0, 2.2), (w / 2 + 0.1, 0, 2.2), 0.015, STEEL)
    for x in (-w / 2 - 0.1, w / 2 + 0.1):
        made.rod((x, 0, 0.02), (x, 0, 2.2), 0.015, STEEL)


def _barrow(made: Assembly, wood: Rgb, rng: np.random.Generator) -> None:
    """A wheelbarrow."""
    w = float(rng.uniform(0.26, 0.32))
    made.block((-0.4, -w, 0.35), (0.35, w, 0.42), wood)
    for side in (-1, 1):
        made.block((-0.45, side * w - 0.015, 0.4), (0.4, side * w + 0.015, 0.62), wood)
        made.rod((-1.0, side * 0.24, 0.55), (0.45, side * 0.08, 0.25), 0.02, (0.35, 0.24, 0.15))
        made.rod((-0.3, side * 0.2, 0.4), (-0.35, side * 0.22, 0.02), 0.016, STEEL)
    for x in (-0.42, 0.38):
        made.block((x - 0.015, -w, 0.4), (x + 0.015, w, 0.6), wood)
    for turn in np.arange(12) * np.pi / 6:
        a, b = ((0.5 + 0.16 * float(np.cos(t)), 0.0, 0.19 + 0.16 * float(np.sin(t))) for t in (turn, turn + np.pi / 6))
        made.rod(a, b, 0.03, (0.08, 0.08, 0.08))


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
        "sofa": _sofa,
        "armchair": _armchair,
        "cot": _cot,
        "radiator": _radiator,
        "trolley": _trolley,
        "ladder": _ladder,
        "floor lamp": _floor_lamp,
        "coats": _coats,
        "lockers": _lockers,
        "fridge": _fridge,
        "counter": _counter,
        "drip": _drip,
        "wheelchair": _wheelchair,
        "curtain": _curtain,
        "barrow": _barrow,
    }
)
_LABELS = {
    "sofa": frozenset({"sofa", "couch", "settee"}),
    "armchair": frozenset({"armchair", "chair", "sofa"}),
    "cot": frozenset({"bed", "hospital bed"}),
    "trolley": frozenset({"trolley", "cart"}),
    "ladder": frozenset({"ladder", "stepladder"}),
    "floor lamp": frozenset({"lamp", "floor lamp"}),
    "coats": frozenset({"coat rack", "coat stand", "coats", "clothes"}),
    "lockers": frozenset({"lockers", "locker", "cabinet", "cupboard"}),
    "fridge": frozenset({"fridge", "refrigerator"}),
    "counter": frozenset({"counter", "kitchen counter", "cabinet", "sink", "stove"}),
    "drip": frozenset({"drip stand", "stand", "pole"}),
    "wheelchair": frozenset({"wheelchair", "chair"}),
    "curtain": frozenset({"curtain", "screen"}),
    "barrow": frozenset({"wheelbarrow", "cart"}),
    "drum": frozenset({"drum", "barrel"}),
    "cabinet": frozenset({"cabinet", "box", "cupboard"}),
    "stool": frozenset({"stool", "chair"}),
}
"""Names that are right, where there are more than the kind's own."""
