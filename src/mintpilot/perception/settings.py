"""What can be tuned about perception. Lengths are those of things, not of one simulator."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class PerceptionSettings:
    """Sensor model, and sizes of the things that are looked for."""

    noise_m: float = 0.004
    """Standard deviation of depth close by, metres."""
    noise_per_m: float = 0.001
    """Added standard deviation per square metre of distance."""
    floor_m: float = 0.0
    """Height of the floor in the world frame."""
    furthest_m: float = 25.0
    """Depth from here on is no depth: no sensor of this kind measures it."""
    reach_m: float = 9.0
    """Things further away are not named."""
    tall_m: float = 1.35
    """What stands in a column with something above this height is a wall or a rack, not an object."""
    tallest_object_m: float = 1.2
    """Objects are not taller than this."""
    widest_object_m: float = 1.5
    """Boxes are not wider than this."""
    least_pixels: int = 40
    """Smaller patches are noise."""
    rough: float = 1.0
    """Depth with this mean deviation from its surroundings, in standard deviations of the sensor (surfaces have about
    0.6), comes from inside a cloud …"""
    perhaps_rough: float = 0.78
    """… and from this one on it does so when it hangs together with such depth …"""
    flat_contrast: float = 4.5
    """… where also the picture's contrast, in grey levels of 255, is at most this."""
    least_smoke_pixels: int = 150
    """Smaller patches of smoke are noise."""
