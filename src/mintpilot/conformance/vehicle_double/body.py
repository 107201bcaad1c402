"""How the double moves: after its set-point, with bounded speed and acceleration, and never through the ground."""

from __future__ import annotations

import math
from dataclasses import dataclass

Ned = tuple[float, float, float]

GAIN = 1.8
"""Speed for each metre that is missing, 1/s."""
FASTEST_MPS = 4.0
HARDEST_MPS2 = 5.0
TURN_RADPS = 1.5
SINK_MPS = 0.6
"""Speed of landing."""
CLIMB_MPS = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """Where to be, with what velocity; a heading of None stays as it is."""

    ned_m: Ned
    velocity: Ned = (0.0, 0.0, 0.0)
    heading_rad: float | None = None
    fastest_mps: float = FASTEST_MPS


@dataclass(slots=True)
class Body:
    """Place, velocity and heading, north, east, down from where it stood first."""

    ned_m: Ned = (0.0, 0.0, 0.0)
    velocity: Ned = (0.0, 0.0, 0.0)
    heading_rad: float = math.pi / 2

    @property
    def on_ground(self) -> bool:
        """Whether it stands."""
        return self.ned_m[2] >= -0.02

    def follow(self, target: Target, seconds: float) -> None:
        """Moves after a target for a while."""
        wanted = [v + GAIN * (t - p) for p, t, v in zip(self.ned_m, target.ned_m, target.velocity, strict=True)]
        speed = math.hypot(*wanted)
        if speed > target.fastest_mps:
            wanted = [w * target.fastest_mps / speed for w in wanted]
        change = [w - v for w, v in zip(wanted, self.velocity, strict=True)]
        size, most = math.hypot(*change), HARDEST_MPS2 * seconds
        share = min(1.0, most / size) if size > 0 else 0.0
        vn, ve, vd = (v + c * share for v, c in zip(self.velocity, change, strict=True))
        n, e, d = (p + v * seconds for p, v in zip(self.ned_m, (vn, ve, vd), strict=True))
        if d > 0.0:
            n, e, d, vn, ve, vd = *self.ned_m[:2], 0.0, 0.0, 0.0, 0.0
        self.ned_m, self.velocity = (n, e, d), (vn, ve, vd)
        if target.heading_rad is not None:
            off = math.remainder(target.heading_rad - self.heading_rad, 2 * math.pi)
            most = TURN_RADPS * seconds
            self.heading_rad = math.remainder(self.heading_rad + min(max(off, -most), most), 2 * math.pi)

    def stand(self) -> None:
        """Its motors are off: on the ground it stands (in the air it would fall, and the double calls that a crash)."""
        self.velocity = (0.0, 0.0, 0.0)
