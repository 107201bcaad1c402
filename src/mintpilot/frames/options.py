"""What a person may say about a source of pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceOptions:
    """What the command line or a caller knows about the pictures. None: found out, or assumed and said."""

    color: Path | None = None
    """Colour picture of a single view."""
    depth: Path | None = None
    """Depth picture of a single view."""
    intrinsics: Path | None = None
    """File with the lens, see `mintpilot.frames.intrinsics`."""
    depth_unit_m: float | None = None
    """Metres in one step of a depth picture of whole numbers: 0.001 for millimetres, 0.0002 for TUM's recordings."""
    every: int = 1
    """Each n-th frame is used."""
    longest: int = 300
    """No more frames than this are used."""
    seed: int = 0
    """For simulated sources."""
