"""Things that lie about, on floors and tables."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

import numpy as np

from mintpilot.simulation.furnished.shapes import Assembly, Shown
from mintpilot.simulation.furnished.style import Rgb

PAINTS: dict[str, Rgb] = {
    "red": (0.75, 0.08, 0.08),
    "blue": (0.08, 0.20, 0.72),
    "green": (0.10, 0.50, 0.16),
    "yellow": (0.88, 0.78, 0.10),
    "white": (0.92, 0.92, 0.92),
    "black": (0.05, 0.05, 0.06),
    "grey": (0.45, 0.45, 0.46),
    "brown": (0.50, 0.34, 0.18),
    "orange": (0.92, 0.45, 0.06),
}
"""Colours that most people would call so."""
STEEL: Rgb = (0.66, 0.67, 0.70)
_OWN_COLOUR = {"plant": "green", "monitor": "black", "extinguisher": "red"}
"""Of kinds that come in one only."""


def thing(kind: str, rng: np.random.Generator, *, largest_m: float) -> Shown:
    """A thing of a kind, standing at the origin, with no edge longer than about ``largest_m``."""
    names = tuple(PAINTS)
    colour = names[int(rng.integers(len(names)))]
    made = Assembly()
    colour = _OWN_COLOUR.get(kind, colour)
    name, labels = MAKERS[kind](made, PAINTS[colour], rng, largest_m)
    return Shown(kind="thing", name=name, labels=frozenset(labels), parts=tuple(made.parts), colour=colour)


def _size(rng: np.random.Generator, low: float, high: float, most: float) -> float:
    return float(rng.uniform(min(low, 0.6 * most), min(high, most)))


def _carton(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    x, y, z = (_size(rng, 0.14, 0.6, most) for _ in range(3))
    made.block((-x / 2, -y / 2, 0), (x / 2, y / 2, z), paint)
    return "box", {"box", "carton", "package"}


def _crate(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    x, y, z = (_size(rng, 0.2, 0.6, most) for _ in range(3))
    slat = z / 4
    for i in range(4):
        made.block((-x / 2, -y / 2, i * slat), (x / 2, y / 2, i * slat + 0.8 * slat), paint)
        made.block((-x / 2 + 0.01, -y / 2 + 0.01, i * slat), (x / 2 - 0.01, y / 2 - 0.01, (i + 1) * slat), paint)
    return "box", {"box", "crate"}


def _books(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    x, y = _size(rng, 0.14, 0.22, most), _size(rng, 0.20, 0.30, most)
    made.block((-x / 2, -y / 2, 0), (x / 2, y / 2, float(rng.uniform(0.04, 0.16))), paint)
    return "books", {"book", "books", "box"}


def _mug(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    r, h = float(rng.uniform(0.036, 0.048)), float(rng.uniform(0.08, 0.11))
    made.upright((0, 0), 0.0, h, r, paint)
    made.block((r * 0.9, -0.008, 0.2 * h), (r + 0.03, 0.008, 0.8 * h), paint)
    return "cup", {"cup", "mug"}


def _tin(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    r = float(rng.uniform(0.035, min(0.12, most / 2)))
    made.upright((0, 0), 0.0, r * float(rng.uniform(1.8, 3.2)), r, paint)
    return "can", {"can", "tin"}


def _bottle(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    r, h = float(rng.uniform(0.034, 0.05)), float(rng.uniform(0.22, 0.32))
    made.upright((0, 0), 0.0, 0.68 * h, r, paint)
    made.upright((0, 0), 0.68 * h, h, 0.4 * r, paint)
    return "bottle", {"bottle"}


def _bin(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    r = min(float(rng.uniform(0.13, 0.2)), most / 2)
    made.upright((0, 0), 0.0, r * float(rng.uniform(1.6, 2.4)), r, paint)
    return "bin", {"bin", "bucket", "can", "barrel"}


def _bag(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    x, y, z = (_size(rng, 0.18, 0.45, most) for _ in range(3))
    made.blob((0, 0, 0.42 * z), (x / 2, y / 2, 0.5 * z), paint)
    made.blob((0.1 * x, 0, 0.75 * z), (x / 4, y / 4, z / 4), paint)
    return "bag", {"bag", "sack"}


def _ball(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    r = _size(rng, 0.16, 0.6, most) / 2
    made.blob((0, 0, r), (r, r, r), paint)
    return "ball", {"ball"}


def _lamp(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    """A table lamp, its shade in its colour."""
    h, r = float(rng.uniform(0.32, 0.48)), float(rng.uniform(0.10, 0.15))
    made.upright((0, 0), 0.0, 0.025, 0.08, STEEL)
    made.upright((0, 0), 0.025, 0.6 * h, 0.015, STEEL)
    made.upright((0, 0), 0.58 * h, h, r, paint)
    return "lamp", {"lamp", "table lamp", "desk lamp"}


def _plant(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    """A pot with leaves."""
    h, r = _size(rng, 0.25, 0.6, most), float(rng.uniform(0.06, 0.11))
    made.upright((0, 0), 0.0, 0.35 * h, r, (0.62, 0.33, 0.20))
    for turn in np.arange(0.0, 6.2, 0.8) + float(rng.uniform(0, 0.8)):
        out, up = float(rng.uniform(0.10, 0.18)), h * float(rng.uniform(0.6, 0.95))
        made.rod((0, 0, 0.35 * h), (out * np.cos(turn), out * np.sin(turn), up), 0.028, paint, tapered=True)
    return "plant", {"plant", "potted plant", "flower", "flowerpot"}


def _monitor(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    w = float(rng.uniform(0.42, 0.60))
    h = 0.58 * w
    made.block((-0.1, -0.08, 0.0), (0.1, 0.08, 0.015), paint)
    made.block((-0.02, -0.02, 0.015), (0.02, 0.02, 0.2), paint)
    made.block((-w / 2, 0.0, 0.1), (w / 2, 0.035, 0.1 + h), paint)
    return "monitor", {"monitor", "screen", "computer", "television", "tv"}


def _laptop(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    """Open."""
    w, d = float(rng.uniform(0.30, 0.38)), float(rng.uniform(0.21, 0.25))
    made.block((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.02), paint)
    made.block((-w / 2, d / 2, 0.0), (w / 2, d / 2 + 0.012, d), paint)
    return "laptop", {"laptop", "computer", "notebook"}


def _backpack(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    w, h = _size(rng, 0.24, 0.34, most), _size(rng, 0.36, 0.50, most)
    made.rod((0, -0.05, 0.1), (0, -0.05, h - 0.1), 0.1, paint)
    made.block((-w / 2, -0.14, 0.0), (w / 2, 0.0, 0.85 * h), paint)
    made.block((-0.4 * w, 0.0, 0.03), (0.4 * w, 0.07, 0.45 * h), tuple(0.8 * c for c in paint))  # type: ignore[arg-type]
    for x in (-0.3 * w, 0.22 * w):
        made.block((x, -0.17, 0.1), (x + 0.04, -0.14, 0.8 * h), (0.12, 0.12, 0.12))
    return "backpack", {"backpack", "rucksack", "bag", "schoolbag"}


def _pan(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    """With a handle, and sometimes so deep that it is a pot with a lid."""
    r, deep = float(rng.uniform(0.09, 0.14)), bool(rng.random() < 0.5)
    h = float(rng.uniform(0.11, 0.17)) if deep else 0.05
    made.upright((0, 0), 0.0, h, r, paint)
    made.rod((r, 0, h - 0.02), (r + 0.17, 0, h), 0.011, (0.08, 0.08, 0.08))
    if deep:
        made.blob((0, 0, h + 0.02), (0.025, 0.025, 0.02), (0.08, 0.08, 0.08))
    return "pan", {"pan", "pot", "saucepan", "frying pan"}


def _kettle(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    r, h = float(rng.uniform(0.08, 0.10)), float(rng.uniform(0.17, 0.22))
    made.blob((0, 0, h / 2), (r, r, h / 2), paint)
    made.upright((0, 0), 0.0, 0.45 * h, r, paint)
    made.rod((r * 0.7, 0, 0.6 * h), (r + 0.05, 0, 0.85 * h), 0.016, paint)
    made.rod((-r * 0.9, 0, 0.45 * h), (-r - 0.04, 0, 0.9 * h), 0.012, (0.1, 0.1, 0.1))
    made.rod((-r - 0.04, 0, 0.9 * h), (-0.2 * r, 0, h + 0.03), 0.012, (0.1, 0.1, 0.1))
    return "kettle", {"kettle", "teapot", "pot", "jug"}


def _bowl(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    """With fruit in it."""
    r = float(rng.uniform(0.10, 0.15))
    made.upright((0, 0), 0.0, 0.02, 0.5 * r, paint)
    made.upright((0, 0), 0.02, 0.05, 0.8 * r, paint)
    made.upright((0, 0), 0.05, 0.085, r, paint)
    for turn, colour in ((0.5, (0.8, 0.2, 0.1)), (2.6, (0.9, 0.6, 0.1)), (4.7, (0.5, 0.7, 0.2))):
        made.blob((0.5 * r * np.cos(turn), 0.5 * r * np.sin(turn), 0.10), (0.036, 0.036, 0.036), colour)
    return "bowl", {"bowl", "fruit bowl", "dish", "fruit"}


def _toolbox(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    w, d, h = _size(rng, 0.38, 0.55, most), _size(rng, 0.18, 0.25, most), _size(rng, 0.16, 0.22, most)
    made.block((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.72 * h), paint)
    made.block((-0.48 * w, -0.46 * d, 0.72 * h), (0.48 * w, 0.46 * d, h), paint)
    for x in (-0.2 * w, 0.2 * w):
        made.rod((x, 0, h), (x, 0, h + 0.04), 0.01, (0.1, 0.1, 0.1))
    made.rod((-0.2 * w, 0, h + 0.045), (0.2 * w, 0, h + 0.045), 0.013, (0.1, 0.1, 0.1))
    return "toolbox", {"toolbox", "tool box", "box", "case"}


def _teddy(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    """Sits, its legs towards x: small, but built as people are."""
    s = _size(rng, 0.28, 0.45, most)
    made.blob((0, 0, 0.30 * s), (0.20 * s, 0.22 * s, 0.30 * s), paint)
    made.blob((0.02 * s, 0, 0.74 * s), (0.19 * s, 0.21 * s, 0.20 * s), paint)
    made.blob((0.19 * s, 0, 0.70 * s), (0.08 * s, 0.09 * s, 0.07 * s), (0.85, 0.75, 0.60))
    for side in (1, -1):
        made.blob((0, 0.17 * s * side, 0.92 * s), (0.04 * s, 0.08 * s, 0.08 * s), paint)
        made.rod((0.1 * s, 0.14 * s * side, 0.1 * s), (0.38 * s, 0.2 * s * side, 0.1 * s), 0.09 * s, paint)
        made.rod((0.05 * s, 0.2 * s * side, 0.46 * s), (0.2 * s, 0.32 * s * side, 0.3 * s), 0.07 * s, paint)
    return "teddy bear", {"teddy bear", "teddy", "toy", "bear", "doll", "stuffed animal"}


def _cushion(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    w = _size(rng, 0.36, 0.50, most)
    made.blob((0, 0, 0.08), (0.56 * w, 0.56 * w, 0.08), paint)
    made.block((-0.42 * w, -0.42 * w, 0.03), (0.42 * w, 0.42 * w, 0.11), paint)
    return "cushion", {"cushion", "pillow"}


def _extinguisher(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    r, h = float(rng.uniform(0.07, 0.09)), float(rng.uniform(0.42, 0.52))
    made.upright((0, 0), 0.0, 0.82 * h, r, paint)
    made.blob((0, 0, 0.82 * h), (r, r, 0.06), paint)
    made.upright((0, 0), 0.85 * h, h, 0.022, (0.1, 0.1, 0.1))
    made.block((-0.02, -0.015, h), (0.13, 0.015, h + 0.02), (0.1, 0.1, 0.1))
    made.rod((0.03, 0, 0.95 * h), (r + 0.03, 0, 0.45 * h), 0.012, (0.1, 0.1, 0.1))
    return "fire extinguisher", {"fire extinguisher", "extinguisher"}


def _jerrycan(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:
    w, d, h = _size(rng, 0.28, 0.36, most), _size(rng, 0.15, 0.19, most), _size(rng, 0.36, 0.46, most)
    made.block((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.84 * h), paint)
    made.upright((0.34 * w, 0), 0.84 * h, 0.95 * h, 0.03, (0.1, 0.1, 0.1))
    made.rod((-0.4 * w, 0, 0.95 * h), (0.12 * w, 0, 0.95 * h), 0.018, paint)
    for x in (-0.4 * w, 0.12 * w):
        made.rod((x, 0, 0.82 * h), (x, 0, 0.95 * h), 0.018, paint)
    return "canister", {"canister", "jerrycan", "jerry can", "can", "fuel can"}


def _shoes(made: Assembly, paint: Rgb, rng: np.random.Generator, most: float) -> tuple[str, set[str]]:  # noqa: ARG001
    """A pair, side by side: sometimes boots."""
    shaft = float(rng.uniform(0.20, 0.32)) if rng.random() < 0.5 else 0.08
    for y in (-0.08, 0.08):
        made.blob((0.06, y, 0.045), (0.10, 0.045, 0.045), paint)
        made.rod((-0.06, y, 0.045), (-0.06, y, max(0.06, shaft)), 0.045, paint)
        made.block((-0.10, y - 0.042, 0.0), (0.13, y + 0.042, 0.018), (0.1, 0.09, 0.08))
    return "shoes", {"shoes", "shoe", "boots", "boot"}


_Maker = Callable[[Assembly, Rgb, np.random.Generator, float], tuple[str, set[str]]]
MAKERS: MappingProxyType[str, _Maker] = MappingProxyType(
    {
        "carton": _carton,
        "crate": _crate,
        "books": _books,
        "mug": _mug,
        "tin": _tin,
        "bottle": _bottle,
        "bin": _bin,
        "bucket": _bin,
        "bag": _bag,
        "ball": _ball,
        "lamp": _lamp,
        "plant": _plant,
        "monitor": _monitor,
        "laptop": _laptop,
        "backpack": _backpack,
        "pan": _pan,
        "kettle": _kettle,
        "bowl": _bowl,
        "toolbox": _toolbox,
        "teddy": _teddy,
        "cushion": _cushion,
        "extinguisher": _extinguisher,
        "jerrycan": _jerrycan,
        "shoes": _shoes,
    }
)
TABLEWARE = frozenset({"mug", "bottle", "lamp", "monitor", "laptop", "pan", "kettle", "bowl"})
"""Kinds that do not stand on floors."""
SMALL = TABLEWARE | {"books", "tin", "carton", "bag", "ball", "crate", "plant", "teddy", "toolbox", "backpack"}
"""Kinds that may stand on tables."""
