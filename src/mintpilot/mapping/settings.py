"""What can be tuned about mapping. Defaults suit a room of some tens of metres and voxels of about 0.2 m."""

from __future__ import annotations

from dataclasses import dataclass

from mintpilot.core.errors import MapError


@dataclass(frozen=True, slots=True, kw_only=True)
class MappingSettings:
    """Sensor model of the voxels, and thresholds of fusing detections over frames."""

    max_rays: int = 20_000
    """Pixels are thinned evenly until no more than this many rays are cast for one frame."""
    min_range_m: float = 0.15
    """Depth below this is the vehicle itself or noise, and teaches nothing."""
    max_range_m: float = 12.0
    """Depth above this is too coarse to place a surface: the ray only clears space, up to here."""
    hit: float = 0.9
    """Log-odds added to a voxel in which a ray ended (at most once a frame)."""
    far_hit: float = 0.3
    """The same for a ray longer than ``near_m``."""
    near_m: float = 5.0
    """From further away a cloud may look like something solid: the sensor's noise hides how soft it is."""
    miss: float = 0.4
    """Log-odds taken from a voxel that was looked through (at most once a frame)."""
    clamp: float = 4.0
    """Log-odds never leave ± this, so that a changed world is learnt again."""
    occupied_above: float = 0.2
    """Log-odds above which a voxel is occupied."""
    free_below: float = -0.3
    """Log-odds below which a voxel is free; between the two it is unknown."""
    sure_score: float = 0.9
    """Score from which an object that was seen once only is kept."""
    fire_margin_m: float = 0.4
    """Clearance kept from flames that were seen, metres."""
    sure_door: float = 0.75
    """Probability, of all sightings together, from which a door is one."""
    smoke_share: float = 0.4
    """Share of the frames that tell of a voxel which must show smoke there for it to belong to a cloud's front."""
    smoke_margin_m: float = 0.4
    """Width of a cloud's thin edge, metres, which is seen through and added to its visible front."""
    smoke_gap_m: float = 0.8
    """Distance between smoke points, metres, above which they belong to different clouds."""
    widest_inside_m: float = 2.5
    """Distance between two fronts, metres, up to which they may be the sides of one cloud."""
    least_smoke_m3: float = 0.4
    """Volume of a cloud, cubic metres, below which it is noise."""
    least_smoke_height_m: float = 1.0
    """Height of a cloud, metres, below which it is noise."""
    viewpoint_m: float = 1.2
    """Distance of a room's viewpoint from its door."""
    viewpoint_height_m: float = 1.3
    """Height of a room's viewpoint above the floor."""

    def __post_init__(self) -> None:
        if not self.free_below < self.occupied_above:
            raise MapError(f"free_below {self.free_below} must be below occupied_above {self.occupied_above}")
        if self.max_rays < 1 or not 0 <= self.min_range_m < self.max_range_m:
            raise MapError(
                f"max_rays {self.max_rays} must be at least 1, and ranges "
                f"{self.min_range_m} to {self.max_range_m} m in order"
            )
