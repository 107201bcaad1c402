"""One trial's record: a line of the campaign's store."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict

from mintpilot.conformance.faults.kinds import Adapter, FaultKind


class BreachRecord(BaseModel):
    """One thing that went wrong."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    rule: str
    what: str


class FaultRecord(BaseModel):
    """What one trial came to."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    schema_version: Literal[1] = 1
    adapter: Adapter
    number: int
    world: str
    faults: tuple[FaultKind, ...]
    """Those that were drawn; a mission may be over before one begins."""
    outcome: str
    """The mission's, ``killed`` or ``raised``."""
    breaches: tuple[BreachRecord, ...] = ()
    safe_s: tuple[tuple[FaultKind, float], ...] = ()
    """From when the mission was told of a fault to its safe state, seconds of mission clock."""
    events: int = 0
    mission_s: float = 0.0
    wall_s: float = 0.0
    cpu_s: float = 0.0
    """What it computed, seconds; 0 where its process died."""
