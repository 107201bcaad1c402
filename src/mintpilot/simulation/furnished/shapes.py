"""Simple bodies that everything in a furnished room is put together from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from mintpilot.core.geometry import Box, Floats, Vec3
from mintpilot.simulation.furnished.style import Rgb


class Form(StrEnum):
    """Shapes, by the names of MuJoCo's geoms."""

    BOX = "BOX"
    CYLINDER = "CYLINDER"
    """Along its own z axis."""
    ELLIPSOID = "ELLIPSOID"
    CAPSULE = "CAPSULE"
    """Along its own z axis; its half length without the round ends."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One simple body."""

    form: Form
    centre_m: Vec3
    half_m: Vec3
    """Half sizes as MuJoCo has them: of a cylinder or capsule the radius, then half the length."""
    colour: Rgb
    axes: tuple[Vec3, Vec3, Vec3] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    """Its own x, y and z axes."""

    def box(self) -> Box:
        """The extent in the world."""
        axes = np.array(self.axes)
        a, b, c = self.half_m
        match self.form:
            case Form.BOX:
                reach = np.abs(axes.T) @ (a, b, c)
            case Form.ELLIPSOID:
                reach = np.sqrt((axes.T**2) @ np.square((a, b, c)))
            case Form.CAPSULE:
                reach = np.abs(axes[2]) * b + a
            case Form.CYLINDER:
                reach = np.abs(axes[2]) * b + a * np.sqrt(np.maximum(0.0, 1 - axes[2] ** 2))
        lo, hi = np.array(self.centre_m) - reach, np.array(self.centre_m) + reach
        return Box(lo_m=_vec(lo), hi_m=_vec(hi))

    def moved(self, by_m: Vec3, turned_rad: float = 0.0) -> Part:
        """Turned about the world's z axis, then moved."""
        c, s = math.cos(turned_rad), math.sin(turned_rad)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        x, y, z = (_vec(turn @ axis) for axis in self.axes)
        return replace(self, centre_m=_vec(turn @ self.centre_m + by_m), axes=(x, y, z))


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """Something that is to be found, or that stands about, with the truth about it."""

    kind: str
    """``thing``, ``person``, ``door``, or ``furniture``: which need not be found, but is nothing else either."""
    name: str
    """What it is: ``box``, ``crouching`` …"""
    labels: frozenset[str]
    """Names that are right for it."""
    parts: tuple[Part, ...]
    colour: str = ""
    """Its colour in one word; empty where it has none that one would name."""
    on_m: float = 0.0
    """Height of what it stands on."""

    @property
    def box_m(self) -> Box:
        """Its extent."""
        return union([part.box() for part in self.parts])

    def moved(self, by_m: Vec3, turned_rad: float = 0.0) -> Shown:
        """The same elsewhere."""
        return replace(self, parts=tuple(p.moved(by_m, turned_rad) for p in self.parts), on_m=self.on_m + by_m[2])


@dataclass(slots=True)
class Assembly:
    """Collects parts."""

    parts: list[Part] = field(default_factory=list)

    def block(self, lo: Sequence[float], hi: Sequence[float], colour: Rgb) -> None:
        """A box between two corners."""
        lo_, hi_ = np.asarray(lo, float), np.asarray(hi, float)
        self.parts.append(
            Part(form=Form.BOX, centre_m=_vec((lo_ + hi_) / 2), half_m=_vec((hi_ - lo_) / 2), colour=colour)
        )

    def upright(self, at: tuple[float, float], low: float, high: float, radius: float, colour: Rgb) -> None:
        """An upright cylinder."""
        middle = (at[0], at[1], (low + high) / 2)
        self.parts.append(
            Part(form=Form.CYLINDER, centre_m=middle, half_m=(radius, (high - low) / 2, 0.0), colour=colour)
        )

    def blob(self, centre: Vec3, half: Vec3, colour: Rgb) -> None:
        """An ellipsoid."""
        self.parts.append(Part(form=Form.ELLIPSOID, centre_m=centre, half_m=half, colour=colour))

    def rod(self, a: Vec3, b: Vec3, radius: float, colour: Rgb, *, tapered: bool = False) -> None:
        """A rod with round ends from one point to another; or as thick in the middle, and pointed."""
        start, end = np.asarray(a, float), np.asarray(b, float)
        length = float(np.linalg.norm(end - start))
        z = (end - start) / max(length, 1e-9) if length > 1e-9 else np.array([0.0, 0.0, 1.0])
        side = np.array([1.0, 0, 0]) if abs(z[0]) < 0.9 else np.array([0, 1.0, 0])
        x = np.cross(side, z)
        x /= np.linalg.norm(x)
        axes = (_vec(x), _vec(np.cross(z, x)), _vec(z))
        middle = _vec((start + end) / 2)
        if tapered:
            half = (radius * 1.15, radius * 1.15, length / 2 + radius)
            self.parts.append(Part(form=Form.ELLIPSOID, centre_m=middle, half_m=half, colour=colour, axes=axes))
        else:
            half = (radius, length / 2, 0.0)
            self.parts.append(Part(form=Form.CAPSULE, centre_m=middle, half_m=half, colour=colour, axes=axes))


def union(boxes: Sequence[Box]) -> Box:
    """The extent of several."""
    lo, hi = np.min([b.lo_m for b in boxes], axis=0), np.max([b.hi_m for b in boxes], axis=0)
    return Box(lo_m=_vec(lo), hi_m=_vec(hi))


def _vec(v: Floats | Sequence[float]) -> Vec3:
    return (float(v[0]), float(v[1]), float(v[2]))
