"""People in many postures, each a little different: joints, size and clothes are drawn at random."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Vec3
from mintpilot.simulation.furnished.shapes import Assembly, Shown
from mintpilot.simulation.furnished.style import Rgb, Style

POSTURES = ("standing", "sitting", "crouching", "lying", "covered", "child")
MORE_POSTURES = (
    "reaching", "carrying", "bending", "kneeling", "slumped", "sprawled", "curled", "tucked in", "child crawling",
    "child cross-legged",
)  # fmt: skip
LYING = frozenset({"lying", "covered", "sprawled", "curled", "tucked in"})
WEAR = ("skirt", "coat", "long hair", "helmet", "cap", "scarf", "pack")


def person(posture: str, style: Style, rng: np.random.Generator) -> Shown:
    """Somebody on the floor at the origin, looking along x; lying people have their middle there."""
    grown = float(rng.uniform(*style.stature))
    size = grown * (float(rng.uniform(0.55, 0.75)) if posture.startswith("child") else 1.0) / 1.75
    body = _Body(style, rng, size)
    {
        "standing": body.stand,
        "child": body.stand,
        "sitting": body.sit,
        "crouching": body.crouch,
        "lying": body.lie,
        "covered": body.lie_covered,
        "reaching": body.reach,
        "carrying": body.carry,
        "bending": body.bend,
        "kneeling": body.kneel,
        "slumped": body.slump,
        "sprawled": body.sprawl,
        "curled": body.curl,
        "tucked in": body.tuck_in,
        "child crawling": body.crawl,
        "child cross-legged": body.cross_legs,
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
        self._sleeve = self._shirt if style.long_sleeves else self._skin
        self._hair = style.hair[0] if len(style.hair) == 1 else style.hair[int(rng.integers(len(style.hair)))]
        self._wear = style.wear[0] if len(style.wear) == 1 else str(rng.choice(style.wear))

    def stand(self) -> None:
        """Upright, the arms somewhere."""
        for side in (1, -1):
            self._leg(side)
            hand = (self._about(0.08, 0.15), (0.26 + self._about(0.03, 0.05)) * side, self._about(0.85, 0.12))
            self._arm((0, 0.20 * side, 1.38), hand)
        self._upright()

    def reach(self) -> None:
        """Both hands up, at something high."""
        for side in (1, -1):
            self._leg(side)
            self._arm((0, 0.20 * side, 1.40), (0.32 + self._about(0, 0.1), 0.17 * side, self._about(1.90, 0.12)))
        self._upright()

    def carry(self) -> None:
        """Upright, a box before the belly."""
        low, s = self._about(0.95, 0.08), self._size
        for side in (1, -1):
            self._leg(side)
            self._arm((0, 0.20 * side, 1.38), (0.32, 0.19 * side, low + 0.08))
        self.made.block((0.2 * s, -0.2 * s, low * s), (0.5 * s, 0.2 * s, (low + 0.26) * s), (0.62, 0.47, 0.30))
        self._upright()

    def bend(self) -> None:
        """Bent forward from the hips, straight legs."""
        drop = self._about(1.08, 0.08)
        for side in (1, -1):
            self._leg(side)
            self._arm((0.38, 0.19 * side, drop), (0.50 + self._about(0, 0.08), 0.16 * side, self._about(0.62, 0.1)))
        self._trunk((0.02, 0, 0.98), (0.36, 0, drop), 0.15)
        self._head((0.60, 0, drop + 0.08))

    def kneel(self) -> None:
        """On both knees, the trunk upright."""
        lean = self._about(0.08, 0.08)
        for side in (1, -1):
            self._limb((0.04, 0.11 * side, 0.07), (-0.40, 0.11 * side, 0.06), 0.06, self._trousers)
            self._limb((0.04, 0.11 * side, 0.09), (-0.06, 0.09 * side, 0.44), 0.085, self._trousers)
            self._arm((lean, 0.20 * side, 0.92), (lean + 0.3, 0.12 * side, self._about(0.55, 0.12)))
        self._trunk((-0.06, 0, 0.54), (lean, 0, 0.90), 0.155)
        self._head((lean + 0.05, 0, 1.18))

    def slump(self) -> None:
        """On the floor, leaning back and to a side, the head hanging."""
        tilt = self._about(0.0, 0.14)
        for side in (1, -1):
            bent = float(self._rng.uniform(0.0, 0.3))
            knee = (0.42, 0.15 * side, 0.09 + bent)
            self._limb((0.0, 0.10 * side, 0.10), knee, 0.085, self._trousers)
            self._limb(knee, (0.86 - 0.5 * bent, 0.18 * side, 0.06), 0.065, self._trousers)
            self._arm((-0.18, 0.20 * side + tilt, 0.54), (0.10, 0.30 * side, 0.06))
        self._trunk((0.0, 0, 0.16), (-0.20, tilt, 0.50), 0.155)
        self._head((-0.08, 1.3 * tilt, 0.73))

    def sprawl(self) -> None:
        """Face down, the arms above the head, one knee drawn up."""
        for side in (1, -1):
            out = 0.28 if side > 0 else 0.12
            knee = (-0.36 if side > 0 else -0.46, out, 0.08)
            self._limb((-0.08, 0.09 * side, 0.11), (knee[0], knee[1] * side, knee[2]), 0.08, self._trousers)
            self._limb((knee[0], out * side, 0.08), (-0.84, 0.16 * side, 0.06), 0.06, self._trousers)
            self._arm(
                (0.36, 0.20 * side, 0.10), (0.72 + self._about(0, 0.12), (0.36 + self._about(0, 0.1)) * side, 0.05)
            )
        self._trunk((0.0, 0, 0.13), (0.36, self._about(0, 0.03), 0.13), 0.14)
        self._head((0.66, self._about(0, 0.06), 0.11))

    def curl(self) -> None:
        """On a side, the knees drawn up."""
        knee = self._about(0.36, 0.08)
        for z, shift in ((0.10, 0.0), (0.26, 0.05)):
            self._limb((-0.28, 0.02, z), (-0.06, knee, z), 0.085, self._trousers)
            self._limb((-0.06, knee, z), (-0.44 - shift, knee + 0.06, z - 0.03), 0.06, self._trousers)
            self._limb((0.26, 0.02, z + 0.04), (0.10 + shift, 0.28, z), 0.05, self._shirt)
            self._limb((0.10 + shift, 0.28, z), (0.36, 0.32, max(0.05, z - 0.08)), 0.042, self._sleeve)
            self._limb((-0.20, 0.0, z + 0.03), (0.24, 0.04, z + 0.03), 0.13, self._shirt)
        self._head((0.50, 0.12, 0.14))

    def tuck_in(self) -> None:
        """On the back, a blanket up to the chest."""
        s, blanket = self._size, self._trousers
        for side in (1, -1):
            self._limb((-0.80, 0.10 * side, 0.10), (-0.05, 0.09 * side, 0.11), 0.11, blanket)
            hand = (self._about(0.05, 0.1), 0.24 * side, 0.16)
            self._arm((0.36, 0.21 * side, 0.11), hand)
        self._limb((0.0, 0, 0.11), (0.22, 0, 0.12), 0.19, blanket)
        self.made.block((-0.98 * s, -0.40, 0.0), (0.24 * s, 0.40, 0.04), blanket)
        self._trunk((0.10, 0, 0.12), (0.36, 0, 0.13), 0.13)
        self._head((0.68, self._about(0, 0.05), 0.15))

    def crawl(self) -> None:
        """On hands and knees."""
        for side in (1, -1):
            self._limb((-0.22, 0.12 * side, 0.08), (-0.62, 0.12 * side, 0.06), 0.06, self._trousers)
            self._limb(
                (-0.22 + self._about(0, 0.1), 0.12 * side, 0.08), (-0.24, 0.09 * side, 0.44), 0.08, self._trousers
            )
            self._arm((0.22, 0.18 * side, 0.50), (0.30 + self._about(0, 0.12), 0.18 * side, 0.05))
        self._trunk((-0.20, 0, 0.50), (0.20, 0, 0.52), 0.145)
        self._head((0.46, 0, 0.64))

    def cross_legs(self) -> None:
        """On the floor, the legs crossed."""
        for side in (1, -1):
            self._limb((0.0, 0.10 * side, 0.10), (0.26, 0.30 * side, 0.14), 0.085, self._trousers)
            self._limb((0.26, 0.30 * side, 0.12), (0.32, -0.06 * side, 0.07), 0.06, self._trousers)
            self._arm((0.02, 0.20 * side, 0.58), (0.30, 0.16 * side, self._about(0.26, 0.06)))
        self._trunk((0, 0, 0.16), (self._about(0.06, 0.05), 0, 0.54), 0.155)
        self._head((0.10, 0, 0.82))

    def _leg(self, side: int) -> None:
        step = self._about(0.0, 0.12)
        self._limb((step, 0.10 * side, 0.07), (0, 0.09 * side, 0.86), 0.08, self._trousers)

    def _upright(self) -> None:
        """Trunk and head of somebody who stands, and what hangs from them."""
        self._trunk((0, 0, 0.98), (self._about(0, 0.03), 0, 1.34), 0.155)
        self._head((self._about(0.02, 0.03), self._about(0, 0.02), 1.62))
        s = self._size
        if self._wear == "skirt":
            self.made.blob((0, 0, 0.70 * s), (0.21 * s, 0.25 * s, 0.36 * s), self._trousers)
        elif self._wear == "coat":
            self.made.blob((0, 0, 0.88 * s), (0.19 * s, 0.25 * s, 0.46 * s), self._shirt)
        elif self._wear == "pack":
            self.made.blob((-0.24 * s, 0, 1.15 * s), (0.14 * s, 0.18 * s, 0.25 * s), self._trousers)

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
        self.made.blob((x - 0.25 * r, y, z + 0.3 * r), (0.85 * r, 0.82 * r, 0.95 * r), self._hair)
        self.made.rod((x, y, z - 1.6 * r), (x, y, z - 0.8 * r), 0.5 * r, self._skin)
        if self._wear == "long hair":
            self.made.blob((x - 0.55 * r, y, z - 0.5 * r), (0.55 * r, 0.85 * r, 1.6 * r), self._hair)
        elif self._wear == "scarf":
            self.made.blob((x - 0.2 * r, y, z), (1.0 * r, 0.98 * r, 1.25 * r), self._shirt)
            self.made.blob((x, y, z - 1.4 * r), (1.0 * r, 1.1 * r, 0.7 * r), self._shirt)
        elif self._wear in ("helmet", "cap"):
            colour = (0.95, 0.78, 0.10) if self._wear == "helmet" else self._trousers
            self.made.blob((x, y, z + 0.55 * r), (1.2 * r, 1.1 * r, 0.85 * r), colour)
            self.made.blob((x + 0.8 * r, y, z + 0.45 * r), (0.9 * r, 0.8 * r, 0.12 * r), colour)

    def _arm(self, shoulder: Vec3, hand: Vec3) -> None:
        elbow = tuple((a + b) / 2 + d for a, b, d in zip(shoulder, hand, (-0.05, 0.0, 0.0), strict=True))
        self._limb(shoulder, (elbow[0], elbow[1], elbow[2]), 0.05, self._shirt)
        self._limb((elbow[0], elbow[1], elbow[2]), hand, 0.042, self._sleeve)
        if self._sleeve != self._skin:
            self.made.blob((self._size * hand[0], self._size * hand[1], self._size * hand[2]), (0.05,) * 3, self._skin)

    def _limb(self, a: Vec3, b: Vec3, radius: float, colour: Rgb) -> None:
        s, r = self._size, self._size * radius * self._girth
        start, end = (s * a[0], s * a[1], max(s * a[2], r)), (s * b[0], s * b[1], max(s * b[2], r))
        self.made.rod(start, end, r, colour, tapered=self._tapered)

    def _about(self, value: float, spread: float) -> float:
        return value + spread * float(self._rng.uniform(-1, 1))
