"""People in six postures, each a little different: joints, size and clothes are drawn at random."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Vec3
from mintpilot.simulation.furnished.shapes import Assembly, Shown
from mintpilot.simulation.furnished.style import Rgb, Style

POSTURES = ("standing", "sitting", "crouching", "lying", "covered", "child")


def person(posture: str, style: Style, rng: np.random.Generator) -> Shown:
    """Somebody on the floor at the origin, looking along x; lying people have their middle there."""
    grown = float(rng.uniform(*style.stature))
    size = grown * (float(rng.uniform(0.55, 0.75)) if posture == "child" else 1.0) / 1.75
    body = _Body(style, rng, size)
    {
        "standing": body.stand,
        "child": body.stand,
        "sitting": body.sit,
        "crouching": body.crouch,
        "lying": body.lie,
        "covered": body.lie_covered,
    }[posture]()
    return Shown(kind="person", name=posture, labels=frozenset({"person"}), parts=tuple(body.made.parts))


class _Body:
    """One body while it is put together; lengths are those of somebody of 1.75 m, times the size."""

    def __init__(self, style: Style, rng: np.random.Generator, size: float) -> None:
        self.made, self._rng, self._size, self._tapered = Assembly(), rng, size, not style.round_limbs
        self._girth = float(rng.uniform(*style.girth))
        picked = rng.choice(len(style.clothes), size=2, replace=False)
        self._shirt, self._trousers = (style.clothes[int(i)] for i in picked)
        self._skin = style.skin[int(rng.integers(len(style.skin)))]

    def stand(self) -> None:
        """Upright, the arms somewhere."""
        for side in (1, -1):
            step = self._about(0.0, 0.12)
            self._limb((step, 0.10 * side, 0.07), (0, 0.09 * side, 0.86), 0.08, self._trousers)
            hand = (self._about(0.08, 0.15), (0.26 + self._about(0.03, 0.05)) * side, self._about(0.85, 0.12))
            self._arm((0, 0.20 * side, 1.38), hand)
        self._trunk((0, 0, 0.98), (self._about(0, 0.03), 0, 1.34), 0.155)
        self._head((self._about(0.02, 0.03), self._about(0, 0.02), 1.62))

    def sit(self) -> None:
        """On a stool, or on the floor with the legs stretched."""
        seat = float(self._rng.choice([0.0, 0.44])) * 1.0
        if seat:
            self.made.block((-0.2, -0.2, 0.0), (0.2, 0.2, seat * self._size - 0.02), (0.35, 0.33, 0.3))
        for side in (1, -1):
            hip = (0.0, 0.10 * side, seat + 0.10)
            if seat:
                knee = (0.42, 0.12 * side, seat + 0.09)
                self._limb(hip, knee, 0.085, self._trousers)
                self._limb(knee, (0.44 + self._about(0, 0.08), 0.12 * side, 0.07), 0.065, self._trousers)
            else:
                bent = float(self._rng.uniform(0.1, 0.4))
                knee = (0.40, 0.14 * side, 0.08 + bent)
                self._limb(hip, knee, 0.085, self._trousers)
                self._limb(knee, (0.80 - 0.5 * bent, 0.14 * side, 0.06), 0.065, self._trousers)
            self._arm(
                (0.0, 0.20 * side, seat + 0.58),
                (self._about(0.30, 0.06), 0.20 * side, seat + self._about(0.22, 0.06)),
            )
        lean = self._about(0.0, 0.08)
        self._trunk((0, 0, seat + 0.16), (lean, 0, seat + 0.54), 0.155)
        self._head((lean + 0.04, 0, seat + 0.82))

    def crouch(self) -> None:
        """On the heels, bent forward."""
        for side in (1, -1):
            knee = (0.26 + self._about(0.02, 0.04), 0.16 * side, 0.48)
            self._limb((0.08, 0.14 * side, 0.07), knee, 0.07, self._trousers)
            self._limb(knee, (-0.14, 0.10 * side, 0.26), 0.09, self._trousers)
            self._arm((0.14, 0.19 * side, 0.66), (0.34, 0.10 * side, self._about(0.38, 0.1)))
        bend = self._about(0.14, 0.06)
        self._trunk((-0.12, 0, 0.34), (bend, 0, 0.66), 0.16)
        self._head((bend + 0.10, 0, 0.88))

    def lie(self) -> None:
        """On the back or the side."""
        for side in (1, -1):
            spread, bent = abs(self._about(0.10, 0.06)) * side, max(0.0, self._about(0.05, 0.1))
            knee = (-0.46, spread, 0.09 + bent)
            self._limb((-0.08, 0.09 * side, 0.11), knee, 0.08, self._trousers)
            self._limb(knee, (-0.86 + bent, spread, 0.07), 0.06, self._trousers)
            self._arm(
                (0.38, 0.21 * side, 0.09), (self._about(0.0, 0.25), (0.30 + self._about(0.05, 0.08)) * side, 0.06)
            )
        self._trunk((0.0, 0, 0.15), (0.36, self._about(0, 0.02), 0.15), 0.14)
        self._head((0.70, self._about(0, 0.05), 0.11))

    def lie_covered(self) -> None:
        """On the back under a sheet: nothing but its folds is seen."""
        sheet = self._shirt
        feet, low = self._about(0.18, 0.03), 0.10
        self._limb((-0.82, feet / 2, 0.06), (-0.70, feet / 2, low), 0.12, sheet)
        self._limb((-0.82, -feet / 2, 0.06), (-0.70, -feet / 2, low), 0.12, sheet)
        self._limb((-0.70, 0.09, 0.07), (0.0, 0.08, 0.09), 0.15, sheet)
        self._limb((-0.70, -0.09, 0.07), (0.0, -0.08, 0.09), 0.15, sheet)
        self._limb((0.0, 0, 0.10), (0.42, 0, 0.11), 0.21, sheet)
        self._limb((0.66, 0, 0.09), (0.74, 0, 0.10), 0.14, sheet)

    def _trunk(self, low: Vec3, high: Vec3, radius: float) -> None:
        for side in (1, -1):
            shift = 0.05 * side
            self._limb((low[0], shift, low[2]), (high[0], high[1] + shift, high[2]), radius, self._shirt)
        self._limb((high[0], 0.16, high[2] + 0.06), (high[0], -0.16, high[2] + 0.06), 0.07, self._shirt)

    def _head(self, at: Vec3) -> None:
        x, y, z = (self._size * v for v in at)
        r = 0.105 * (0.4 + 0.6 * self._size)
        self.made.blob((x, y, z), (0.95 * r, 0.80 * r, 1.15 * r), self._skin)
        self.made.blob((x - 0.25 * r, y, z + 0.3 * r), (0.85 * r, 0.82 * r, 0.95 * r), (0.15, 0.10, 0.07))
        self.made.rod((x, y, z - 1.6 * r), (x, y, z - 0.8 * r), 0.5 * r, self._skin)

    def _arm(self, shoulder: Vec3, hand: Vec3) -> None:
        elbow = tuple((a + b) / 2 + d for a, b, d in zip(shoulder, hand, (-0.05, 0.0, 0.0), strict=True))
        self._limb(shoulder, (elbow[0], elbow[1], elbow[2]), 0.05, self._shirt)
        self._limb((elbow[0], elbow[1], elbow[2]), hand, 0.042, self._skin)

    def _limb(self, a: Vec3, b: Vec3, radius: float, colour: Rgb) -> None:
        s, r = self._size, self._size * radius * self._girth
        start, end = (s * a[0], s * a[1], max(s * a[2], r)), (s * b[0], s * b[1], max(s * b[2], r))
        self.made.rod(start, end, r, colour, tapered=self._tapered)

    def _about(self, value: float, spread: float) -> float:
        return value + spread * float(self._rng.uniform(-1, 1))
