"""Procedural textures: square pictures that tile, made once a process."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.geometry import Floats

SIZE_PX = 256
_Y, _X = np.mgrid[0:SIZE_PX, 0:SIZE_PX]


def _cloud(seed: int, exponent: float = 1.5) -> Floats:
    """Noise from 0 to 1 with a power-law spectrum; periodic, so that it tiles without a seam."""
    frequency = np.fft.fftfreq(SIZE_PX) * SIZE_PX
    radius = np.hypot(frequency[:, None], frequency[None, :])
    radius[0, 0] = 1.0
    spectrum = np.fft.fft2(np.random.default_rng(seed).standard_normal((SIZE_PX, SIZE_PX))) * radius**-exponent
    spectrum[0, 0] = 0.0
    noise = np.real(np.fft.ifft2(spectrum))
    cloud: Floats = (noise - noise.min()) / (noise.max() - noise.min())
    return cloud


def _shades(cloud: Floats, base: tuple[float, float, float], span: tuple[float, float, float]) -> Floats:
    """``base + span * cloud`` for each of the three colours (n, n, 3)."""
    shades: Floats = np.asarray(base, float) + cloud[..., None] * np.asarray(span, float)
    return shades


def _concrete() -> Floats:
    image = _shades(_cloud(1), (98, 97, 93), (62, 61, 59))
    image[(_X < 2) | (_Y < 2)] *= 0.6
    return image


def _corrugated() -> Floats:
    image = _shades(_cloud(2), (148, 144, 133), (42, 40, 37))
    return np.asarray(image * (0.85 + 0.15 * np.sin(_X * 2 * np.pi * 16 / SIZE_PX))[..., None])


def _brick() -> Floats:
    height, width = SIZE_PX // 16, SIZE_PX // 8
    row = _Y // height
    along = _X + (row % 2) * width // 2
    tint = np.random.default_rng(3).random((17, 17))[row % 17, (along // width) % 8]
    image = _shades(tint, (138, 68, 53), (44, 28, 22)) * (0.8 + 0.3 * _cloud(3))[..., None]
    image[(_Y % height < 2) | (along % width < 2)] = (165, 160, 150)
    return image


def _cardboard() -> Floats:
    n = SIZE_PX
    image = _shades(_cloud(4), (176, 135, 88), (20, 16, 14))
    image[np.abs(_Y - n // 2) < n // 28] = (205, 180, 130)
    label = (slice(int(n * 0.62), int(n * 0.8)), slice(int(n * 0.6), int(n * 0.88)))
    image[label] = 235
    image[int(n * 0.66) : int(n * 0.68), int(n * 0.63) : int(n * 0.85)] = 60
    image[int(n * 0.72) : int(n * 0.74), int(n * 0.63) : int(n * 0.80)] = 60
    return image


def _metal() -> Floats:
    return _shades(_cloud(5, 1.0), (112, 113, 117), (46, 46, 48))


def _wood() -> Floats:
    grain = 0.5 + 0.5 * np.sin((_X + 26 * _cloud(6)) * 2 * np.pi * 10 / SIZE_PX)
    return _shades(grain, (128, 88, 49), (42, 30, 19))


def _hazard() -> Floats:
    dark = ((_X + _Y) // (SIZE_PX // 8)) % 2 == 1
    image = np.where(dark[..., None], (26.0, 26.0, 26.0), (228.0, 188.0, 24.0))
    return np.asarray(image * (0.8 + 0.2 * _cloud(7))[..., None])


def _char() -> Floats:
    cloud = _cloud(8, 1.2)
    image = _shades(cloud, (22, 20, 19), (50, 47, 44))
    image[cloud > 0.8] = (190, 70, 15)  # embers
    return image


def _plaster() -> Floats:
    image = _shades(_cloud(9), (196, 196, 190), (30, 30, 30))
    image[_Y < 2] *= 0.8
    return image


_MAKERS: dict[str, Callable[[], Floats]] = {
    "brick": _brick,
    "cardboard": _cardboard,
    "char": _char,
    "concrete": _concrete,
    "corrugated": _corrugated,
    "hazard": _hazard,
    "metal": _metal,
    "plaster": _plaster,
    "wood": _wood,
}
NAMES = tuple(_MAKERS)


@cache
def texture(name: str) -> NDArray[np.uint8]:
    """The texture with that name, (256, 256, 3), read-only.

    Raises:
        UnknownNameError: there is none of that name.
    """
    if name not in _MAKERS:
        raise UnknownNameError("texture", name, _MAKERS)
    image = np.clip(_MAKERS[name](), 0, 255).astype(np.uint8)
    image.setflags(write=False)
    return image
