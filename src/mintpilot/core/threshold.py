"""An ordered value that is not known, as thresholds that plans turn on (method, section 13)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class ValueKind(StrEnum):
    """What is measured, in metres."""

    CLEARANCE = "clearance_m"
    """How wide a passage is."""
    CEILING = "ceiling_m"
    """How high the lower edge of something is above the map's zero."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Threshold:
    """A region can be flown through exactly where a value is at least this large."""

    of: str
    """Id of the value; regions of one value are free from the least threshold up."""
    subject: str
    """What is measured, as the operator can see it, with its article: ``the passage beside the rack``."""
    kind: ValueKind
    at_least_m: float
    """Metres."""

    @property
    def words(self) -> str:
        """The threshold with its unit: ``0.8 m``."""
        return f"{self.at_least_m:g} m"
