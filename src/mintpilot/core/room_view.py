"""What a vehicle itself can say of a look into a room."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomView:
    """Told by simulators, which know what is in a room; a real vehicle's camera draws it into the map instead."""

    people: int
    """How many people were seen inside."""
    seen_share: float
    """Share of the doorway through which the room was seen, 0 to 1."""
