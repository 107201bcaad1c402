"""What a campaign has found: by adapter, by fault, and every breach."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mintpilot.conformance.faults.drawing import drawn
from mintpilot.conformance.faults.kinds import ENDS, FaultKind, rule_of
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
    """How often a mission was told of it; of one that it is not told of, how often it began."""
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


def _ended_s(record: FaultRecord, kind: FaultKind) -> float | None:
    """From when a fault began to the end of the mission, seconds; None: it never began, or somebody let it hold."""
    fault = drawn(record.adapter, record.number).first(kind)
    ordered = any(told is FaultKind.ORDERS for told, _ in record.safe_s)
    if fault is None or ordered or record.mission_s <= fault.at_s:
        return None
    return record.mission_s - fault.at_s


def fault_rows(records: Iterable[FaultRecord]) -> Iterator[FaultRow]:
    """One row a fault that was drawn, in the order of `FaultKind`."""
    every = list(records)
    for kind in FaultKind:
        mine = [record for record in every if kind in record.faults]
        if mine:
            rule = rule_of(kind)
            if rule is ENDS:
                took = [seconds for record in mine if (seconds := _ended_s(record, kind)) is not None]
            else:
                took = [seconds for record in mine for told, seconds in record.safe_s if told is kind]
            yield FaultRow(
                fault=kind.value,
                trials=len(mine),
                breached=sum(bool(record.breaches) for record in mine),
                state=rule.state,
                within_s=rule.within_s,
                told=len(took),
                longest_s=max(took, default=None),
            )
