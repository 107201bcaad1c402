"""What the link process must know of the map to end a flight safely by itself."""

from __future__ import annotations

from dataclasses import dataclass

from mintpilot.core.geometry import Bools, Box, GridFrame, Vec3, frozen


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SafetyEnvelope:
    """Where the vehicle may be, where it may land, and above what it may fly straight."""

    volume: Box
    """Where it may fly. Trajectories that leave it are refused."""
    hover_m: Vec3
    """The hover point above the place of take-off, metres."""
    ground_m: float
    """Height of the ground at the place of take-off, metres on the map."""
    frame: GridFrame
    """Lattice of ``landable``."""
    landable: Bools
    """(nz, ny, nx) cells from which the ground right below is known free to land on."""
    tallest_m: float | None
    """Top of the highest mapped obstacle, metres on the map; None: not known."""
    outdoors: bool
    """True only where the map lies on the earth: there may be no ceiling, and a satellite position."""

    def __post_init__(self) -> None:
        frozen(self.landable)

    def may_land(self, position_m: Vec3) -> bool:
        """Whether the ground right below that place is known free to land on."""
        z, y, x = (int(i) for i in self.frame.cells_of(position_m)[0])
        if self.frame.is_flat:
            z = 0
        inside = bool(self.frame.contains([[z, y, x]])[0])
        return inside and bool(self.landable[z, y, x])

    def clears_everything(self, height_m: float) -> bool:
        """Whether a straight flight at that height (metres on the map) clears all that is mapped."""
        return self.outdoors and self.tallest_m is not None and height_m > self.tallest_m
