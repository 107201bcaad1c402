"""What an operator tells the drone of its own accord: typed facts with their author (method, section 12)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from mintpilot.core.errors import InputError
from mintpilot.core.message import NOTHING, Message

MOST_CORNERS = 64
"""Corners of a drawn region."""
PREFIX = "told-"
"""Ids of drawn regions on the map begin so."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KeepOut:
    """A drawn region that the drone stays out of, at every height. It adds caution.

    Raises:
        InputError: it has fewer than three corners or more than `MOST_CORNERS`, or one that is no place.
    """

    corners_m: tuple[tuple[float, float], ...]
    """The outline seen from above, metres in the world: x, y of each corner in order; the last joins the first."""

    def __post_init__(self) -> None:
        if not 3 <= len(self.corners_m) <= MOST_CORNERS:
            raise InputError(f"a drawn region of {len(self.corners_m)} corners: it needs 3 to {MOST_CORNERS}")
        if not all(math.isfinite(value) for corner in self.corners_m for value in corner):
            raise InputError("a drawn region needs corners that are places: one of them is infinite or no number")


@dataclass(frozen=True, slots=True, kw_only=True)
class RegionBlocked:
    """A region that the drone found must not be entered. It adds caution."""

    region: str


@dataclass(frozen=True, slots=True, kw_only=True)
class RegionPassable:
    """A region that the drone found may be flown through, as it is shown. It takes caution away."""

    region: str


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomSearched:
    """A closed room was searched by somebody: nobody needs to look into it. It takes caution away."""

    room: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ThisOne:
    """This thing is the one that is meant. It takes caution away."""

    thing: str


Fact: TypeAlias = KeepOut | RegionBlocked | RegionPassable | RoomSearched | ThisOne


class Standing(StrEnum):
    """What has become of a fact that was told."""

    READ_BACK = "read-back"
    """It would take caution away: it counts once it is confirmed."""
    COUNTS = "counts"
    UNDO_READ_BACK = "undo-read-back"
    """It counts. Taking it back would take caution away: that is done once it is confirmed."""
    UNDONE = "undone"
    """It was taken back, or not confirmed in time."""
    LAPSED = "lapsed"
    """It is too old, or what it was said of has changed."""
    REFUSED = "refused"
    """It speaks of nothing that is known, or goes against what was said before."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ToldFact:
    """One fact with its author."""

    id: str
    """``told-N``; of a drawn region also its id on the map."""
    fact: Fact
    words: str
    """What it speaks of, as the drone calls it; empty for a drawn region."""
    operator: str
    """Who told it."""
    told_s: float
    """Mission clock."""
    standing: Standing
    why: Message = NOTHING
    """Of one that was refused."""

    @property
    def counts(self) -> bool:
        """Whether the mission goes by it."""
        return self.standing in (Standing.COUNTS, Standing.UNDO_READ_BACK)

    @property
    def read_back(self) -> bool:
        """Whether it, or taking it back, waits to be confirmed."""
        return self.standing in (Standing.READ_BACK, Standing.UNDO_READ_BACK)
