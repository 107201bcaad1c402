"""People in six postures, made of rounded limbs and met by rays: an oracle that shares no code with the package."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scenes import CAMERA, pose

from mintpilot.core.observation import Frame

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Limb:
    """A rod with round ends, in a person's own frame (x ahead, y left, z up)."""

    a: Point
    b: Point
    radius: float
    colour: Point = (0.4, 0.4, 0.5)


SKIN, SHIRT, JEANS, SHEET = (0.8, 0.6, 0.5), (0.55, 0.55, 0.58), (0.3, 0.35, 0.5), (0.7, 0.7, 0.72)


def posture(name: str) -> list[Limb]:
    if name in ("standing", "child"):
        s = 1.0 if name == "standing" else 0.62
        limbs = [
            Limb(a=(0, 0.1, 0.06), b=(0, 0.1, 0.85), radius=0.085, colour=JEANS),
            Limb(a=(0, -0.1, 0.06), b=(0, -0.1, 0.85), radius=0.085, colour=JEANS),
            Limb(a=(0, 0.0, 0.95), b=(0, 0.0, 1.35), radius=0.165, colour=SHIRT),
            Limb(a=(0, 0.23, 1.4), b=(0.05, 0.3, 0.85), radius=0.055, colour=SHIRT),
            Limb(a=(0, -0.23, 1.4), b=(0.05, -0.3, 0.85), radius=0.055, colour=SHIRT),
            Limb(a=(0, 0.15, 1.42), b=(0, -0.15, 1.42), radius=0.08, colour=SHIRT),
            Limb(a=(0, 0, 1.6), b=(0, 0, 1.68), radius=0.105, colour=SKIN),
        ]
        return [_scaled(limb, s) for limb in limbs]
    if name == "sitting":
        return [
            Limb(a=(0.45, 0.12, 0.08), b=(0.42, 0.12, 0.45), radius=0.075, colour=JEANS),
            Limb(a=(0.45, -0.12, 0.08), b=(0.42, -0.12, 0.45), radius=0.075, colour=JEANS),
            Limb(a=(0.0, 0.1, 0.48), b=(0.42, 0.12, 0.5), radius=0.09, colour=JEANS),
            Limb(a=(0.0, -0.1, 0.48), b=(0.42, -0.12, 0.5), radius=0.09, colour=JEANS),
            Limb(a=(-0.02, 0, 0.15), b=(-0.02, 0, 0.4), radius=0.2, colour=SHEET),
            Limb(a=(0, 0, 0.55), b=(0.02, 0, 0.95), radius=0.165, colour=SHIRT),
            Limb(a=(0.02, 0.22, 0.98), b=(0.25, 0.2, 0.62), radius=0.055, colour=SHIRT),
            Limb(a=(0.02, -0.22, 0.98), b=(0.25, -0.2, 0.62), radius=0.055, colour=SHIRT),
            Limb(a=(0.04, 0, 1.18), b=(0.04, 0, 1.26), radius=0.105, colour=SKIN),
        ]
    if name == "crouching":
        return [
            Limb(a=(0.1, 0.14, 0.08), b=(0.28, 0.16, 0.5), radius=0.085, colour=JEANS),
            Limb(a=(0.1, -0.14, 0.08), b=(0.28, -0.16, 0.5), radius=0.085, colour=JEANS),
            Limb(a=(-0.12, 0.1, 0.28), b=(0.28, 0.16, 0.5), radius=0.095, colour=JEANS),
            Limb(a=(-0.12, -0.1, 0.28), b=(0.28, -0.16, 0.5), radius=0.095, colour=JEANS),
            Limb(a=(-0.12, 0, 0.35), b=(0.12, 0, 0.68), radius=0.17, colour=SHIRT),
            Limb(a=(0.12, 0.2, 0.68), b=(0.3, 0.1, 0.4), radius=0.055, colour=SHIRT),
            Limb(a=(0.12, -0.2, 0.68), b=(0.3, -0.1, 0.4), radius=0.055, colour=SHIRT),
            Limb(a=(0.2, 0, 0.86), b=(0.22, 0, 0.9), radius=0.105, colour=SKIN),
        ]
    lying = [
        Limb(a=(-0.85, 0.1, 0.08), b=(-0.1, 0.1, 0.1), radius=0.08, colour=JEANS),
        Limb(a=(-0.85, -0.12, 0.08), b=(-0.1, -0.1, 0.1), radius=0.08, colour=JEANS),
        Limb(a=(0.0, 0, 0.15), b=(0.4, 0, 0.15), radius=0.15, colour=SHIRT),
        Limb(a=(0.42, 0.24, 0.07), b=(-0.1, 0.34, 0.06), radius=0.055, colour=SHIRT),
        Limb(a=(0.42, -0.24, 0.07), b=(-0.1, -0.3, 0.06), radius=0.055, colour=SHIRT),
        Limb(a=(0.7, 0, 0.11), b=(0.74, 0, 0.11), radius=0.105, colour=SKIN),
    ]
    if name == "lying":
        return lying
    if name == "covered":
        return [
            Limb(a=(-0.8, 0.08, 0.06), b=(0.1, 0.08, 0.08), radius=0.14, colour=SHEET),
            Limb(a=(-0.8, -0.08, 0.06), b=(0.1, -0.08, 0.08), radius=0.14, colour=SHEET),
            Limb(a=(0.0, 0, 0.1), b=(0.45, 0, 0.1), radius=0.21, colour=SHEET),
            Limb(a=(0.68, 0, 0.1), b=(0.74, 0, 0.1), radius=0.13, colour=SHEET),
        ]
    raise ValueError(name)


POSTURES = ("standing", "sitting", "crouching", "lying", "covered", "child")


def _scaled(limb: Limb, s: float) -> Limb:
    a, b = (tuple(s * x for x in p) for p in (limb.a, limb.b))
    return Limb(a=a, b=b, radius=s * limb.radius, colour=limb.colour)  # type: ignore[arg-type]


def picture_of(
    limbs: list[Limb],
    *,
    at: tuple[float, float] = (2.8, 0.0),
    turned_rad: float = 0.0,
    eye: Point = (0.0, 0.0, 1.6),
    pitch_rad: float = 0.3,
    seed: int = 0,
) -> Frame:
    """The limbs on a floor before a wall, with the noise of a depth sensor."""
    lens, world = CAMERA, pose(eye, 0.0, pitch_rad)
    v, u = np.mgrid[0 : lens.height, 0 : lens.width] + 0.5
    rays = np.stack([(u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, np.ones_like(u)], -1)
    length = np.linalg.norm(rays, axis=-1)
    ways = rays / length[..., None] @ world[:3, :3].T
    start = world[:3, 3]
    with np.errstate(divide="ignore"):
        floor = np.where(ways[..., 2] < 0, -start[2] / ways[..., 2], np.inf)
        wall = np.where(ways[..., 0] > 0, (6.0 - start[0]) / ways[..., 0], np.inf)
    far = np.minimum(floor, wall)
    rgb = np.where((floor < wall)[..., None], 120.0, 165.0) * np.ones(3)
    reach, colour = _met(limbs, at, turned_rad, start, ways, far)
    met = reach < far
    rgb = np.where(met[..., None], 255 * colour, rgb)
    depth = np.minimum(reach, far) / length
    rng = np.random.default_rng(seed)
    noisy = depth + rng.normal(0, 1, depth.shape) * (0.003 + 0.0008 * depth**2)
    rgb = np.clip(rgb + rng.normal(0, 3, rgb.shape), 0, 255).astype(np.uint8)
    return Frame(time_s=0.0, rgb=rgb, depth_m=noisy.astype(np.float32), camera=lens, world_from_camera=world)


def _met(limbs, at, turned_rad, start, ways, far):  # type: ignore[no-untyped-def]
    """Sphere tracing."""
    cosine, sine = math.cos(turned_rad), math.sin(turned_rad)
    turn = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    ends = [(turn @ limb.a + (*at, 0.0), turn @ limb.b + (*at, 0.0), limb) for limb in limbs]
    reach = np.full(far.shape, 0.3)
    which = np.zeros(far.shape, int)
    for _ in range(60):
        points = start + reach[..., None] * ways
        off = np.full(far.shape, np.inf)
        for i, (a, b, limb) in enumerate(ends):
            d = b - a
            t = np.clip(((points - a) @ d) / max(d @ d, 1e-9), 0, 1)
            near = np.linalg.norm(points - a - t[..., None] * d, axis=-1) - limb.radius
            which = np.where(near < off, i, which)
            off = np.minimum(off, near)
        reach = np.where(off > 1e-3, reach + np.maximum(off, 0), reach)
    colours = np.array([limb.colour for limb in limbs])[which]
    return np.where(off < 5e-3, reach, np.inf), colours
