"""What a campaign has found: by adapter, by fault, and every breach."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mintpilot.conformance.faults.kinds import FaultKind, rule_of
from mintpilot.conformance.faults.records import FaultRecord


@dataclass(frozen=True, slots=True, kw_only=True)
class AdapterRow:
    """All trials of one adapter."""

    adapter: str
    trials: int
    breached: int
    """Trials with a breach."""
    outcomes: dict[str, int]
    mission_s: float
    """Mission time in all."""
    cpu_s: float
    """Computed in all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultRow:
    """All trials in which one fault was drawn, alone or with others."""

    fault: str
    trials: int
    breached: int
    state: str
    """The safe state."""
    within_s: float
    told: int
    """How often a mission was told of it."""
    longest_s: float | None
    """Longest time to the safe state; None: no mission was told of it."""


def adapter_rows(records: Iterable[FaultRecord]) -> Iterator[AdapterRow]:
    """One row an adapter."""
    every = list(records)
    for adapter in dict.fromkeys(record.adapter for record in every):
        mine = [record for record in every if record.adapter is adapter]
        yield AdapterRow(
            adapter=adapter.value,
            trials=len(mine),
            breached=sum(bool(record.breaches) for record in mine),
            outcomes=dict(Counter(record.outcome for record in mine).most_common()),
            mission_s=sum(record.mission_s for record in mine),
            cpu_s=sum(record.cpu_s for record in mine),
        )


def fault_rows(records: Iterable[FaultRecord]) -> Iterator[FaultRow]:
    """One row a fault that was drawn, in the order of `FaultKind`."""
    every = list(records)
    for kind in FaultKind:
        mine = [record for record in every if kind in record.faults]
        if mine:
            took = [seconds for record in mine for told, seconds in record.safe_s if told is kind]
            rule = rule_of(kind)
            yield FaultRow(
                fault=kind.value,
                trials=len(mine),
                breached=sum(bool(record.breaches) for record in mine),
                state=rule.state,
                within_s=rule.within_s,
                told=len(took),
                longest_s=max(took, default=None),
            )
