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


def thing(kind: str, rng: np.random.Generator, *, largest_m: float) -> Shown:
    """A thing of a kind, standing at the origin, with no edge longer than about ``largest_m``."""
    names = tuple(PAINTS)
    colour = names[int(rng.integers(len(names)))]
    made = Assembly()
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
    }
)
SMALL = frozenset({"mug", "bottle", "books", "tin", "carton", "bag", "ball", "crate"})
"""Kinds that may stand on tables."""
