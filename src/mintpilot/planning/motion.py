"""A motion along corners that keeps its limits by construction.

The velocity is a chain of straight ramps in time, each with at most the allowed acceleration: speeding up along a
segment, cruising, slowing down, and turning the velocity from one segment's direction into the next one's at the speed
set for the corner (a parabolic blend inside the corner). Then a moving average over ``SMOOTHING_S`` is taken, in closed
form. Averages of velocities and accelerations within their limits stay within them (both are balls, hence convex), the
acceleration becomes continuous, and straight lines stay straight. At a corner of speed 0 the chain waits for as long as
the average lasts: such corners are met exactly and the curve there is the polyline itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Floats

SMOOTHING_S = 0.25
"""Length of the moving average, seconds: how long the acceleration takes from none to its limit."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """Velocity ramps between knots, with their first and second integrals there."""

    time_s: Floats
    """Knots (k,), ascending from 0."""
    velocity_mps: Floats
    """(k, 3), linear between knots; the first and last are zero."""
    position_m: Floats
    """(k, 3), from the origin of the motion."""
    integral_ms: Floats
    """(k, 3), integral of the position over time."""
    corner_s: Floats
    """(c,) middle of the turn at each inner corner, on the clock of `sample`."""

    @property
    def duration_s(self) -> float:
        """Seconds from rest to rest, the moving average included."""
        return float(self.time_s[-1]) + SMOOTHING_S

    def sample(self, time_s: Floats) -> tuple[Floats, Floats, Floats]:
        """Position relative to the start, velocity and acceleration, (n, 3) each, at times from 0 to `duration_s`."""
        v1, p1, i1 = self._raw(time_s)
        v0, p0, i0 = self._raw(time_s - SMOOTHING_S)
        return (i1 - i0) / SMOOTHING_S, (p1 - p0) / SMOOTHING_S, (v1 - v0) / SMOOTHING_S

    def _raw(self, time_s: Floats) -> tuple[Floats, Floats, Floats]:
        """Velocity, position and its integral before averaging; at rest outside the knots."""
        inside = np.clip(time_s, 0.0, self.time_s[-1])
        k = np.clip(np.searchsorted(self.time_s, inside, side="right") - 1, 0, len(self.time_s) - 2)
        h = (inside - self.time_s[k])[:, None]
        slope = (self.velocity_mps[k + 1] - self.velocity_mps[k]) / (self.time_s[k + 1] - self.time_s[k])[:, None]
        v0, p0 = self.velocity_mps[k], self.position_m[k]
        position = p0 + h * (v0 + h * slope / 2)
        integral = self.integral_ms[k] + h * (p0 + h * (v0 / 2 + h * slope / 6))
        after = np.maximum(time_s - self.time_s[-1], 0.0)[:, None]
        return v0 + h * slope, position, integral + after * position


def corner_motion(corners_m: Floats, corner_mps: Floats, *, peak_mps: float, acceleration_mps2: float) -> Motion:
    """The motion along a polyline, from rest to rest.

    Args:
        corners_m: (n, 3), n at least 2, neighbours apart.
        corner_mps: (n - 2,) wanted speed at each inner corner; lowered where the segments are too short for it.
        peak_mps: speed limit.
        acceleration_mps2: acceleration limit.
    """
    steps = np.diff(corners_m, axis=0)
    length = np.linalg.norm(steps, axis=1)
    way = steps / length[:, None]
    bend = np.linalg.norm(np.diff(way, axis=0), axis=1)
    speed = _reachable_speeds(length, bend, np.minimum(corner_mps, peak_mps), acceleration_mps2)
    ends = np.concatenate([[0.0], speed, [0.0]])
    reach = np.concatenate([[0.0], speed**2 * bend / (2 * acceleration_mps2), [0.0]])
    spans: list[float] = []
    velocities = [np.zeros(3)]
    for i, u in enumerate(way):
        straight = max(length[i] - reach[i] - reach[i + 1], 0.0)
        top = min(peak_mps, np.sqrt(acceleration_mps2 * straight + (ends[i] ** 2 + ends[i + 1] ** 2) / 2))
        top = max(top, ends[i], ends[i + 1])  # rounding only: the speeds are reachable
        up, down = (top - ends[i]) / acceleration_mps2, (top - ends[i + 1]) / acceleration_mps2
        cruise = straight - up * (top + ends[i]) / 2 - down * (top + ends[i + 1]) / 2
        spans += [up, max(cruise, 0.0) / top, down]
        velocities += [top * u, top * u, ends[i + 1] * u]
        if i < len(bend):
            spans.append(ends[i + 1] * bend[i] / acceleration_mps2 if ends[i + 1] > 0 else SMOOTHING_S)
            velocities.append(ends[i + 1] * way[i + 1])
    return _integrated(np.asarray(spans), np.asarray(velocities))


def _reachable_speeds(length: Floats, bend: Floats, wanted: Floats, acceleration: float) -> Floats:
    """Corner speeds for which every turn fits into its segments and every change of speed in between, too."""
    # A turn takes speed² bend / (2 a) of both segments; it may have half of the shorter one.
    room = acceleration * np.minimum(length[:-1], length[1:])
    square = np.minimum(wanted**2, room / np.maximum(bend, 1e-12))
    reach = np.concatenate([[0.0], square * bend / (2 * acceleration), [0.0]])
    gain = 2 * acceleration * np.maximum(length - reach[:-1] - reach[1:], 0.0)
    square = np.concatenate([[0.0], square, [0.0]])
    for i in range(1, len(square)):
        square[i] = min(square[i], square[i - 1] + gain[i - 1])
    for i in range(len(square) - 2, -1, -1):
        square[i] = min(square[i], square[i + 1] + gain[i])
    return np.asarray(np.sqrt(square[1:-1]))


def _integrated(spans: Floats, velocities: Floats) -> Motion:
    """Knots with both integrals; spans without duration are dropped. The fourth span of each four is a turn."""
    ends = np.cumsum(spans)
    turns = ends[3::4] - spans[3::4] / 2 + SMOOTHING_S / 2
    kept = np.concatenate([[True], spans > 1e-12])
    velocity = velocities[kept]
    time = np.concatenate([[0.0], np.cumsum(spans[kept[1:]])])
    h = np.diff(time)[:, None]
    position = np.concatenate([np.zeros((1, 3)), np.cumsum(h * (velocity[:-1] + velocity[1:]) / 2, axis=0)])
    integral = np.cumsum(h * (position[:-1] + h * (velocity[:-1] / 3 + velocity[1:] / 6)), axis=0)
    return Motion(
        time_s=time,
        velocity_mps=velocity,
        position_m=position,
        integral_ms=np.concatenate([np.zeros((1, 3)), integral]),
        corner_s=turns,
    )
