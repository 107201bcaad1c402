"""The monitors see a product that is broken: each mutant takes one safeguard away, and its breach is found.

A campaign that finds nothing is worth as much as these.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from mintpilot.conformance.faults.campaign import fly
from mintpilot.conformance.faults.drawing import drawn
from mintpilot.conformance.faults.kinds import Adapter, Fault, FaultKind
from mintpilot.conformance.faults.ledger import Counter
from mintpilot.mission import telling

TRIES = 8
"""Missions at most until a mutant is found."""
Mutate = Callable[[pytest.MonkeyPatch], None]


def what_is_told_counts_at_once(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(telling, "_FREEING", ())
    patch.setattr(telling, "enlarges", lambda *_: False)


def what_is_drawn_is_flown(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(telling.facts, "with_drawn", lambda map, drawn: map)


KINEMATIC = [
    (what_is_told_counts_at_once, FaultKind.TOLD, "flown where not known free"),
    (what_is_drawn_is_flown, FaultKind.TOLD, "flown where drawn"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("mutate", "kind", "rule"), KINEMATIC, ids=[mutate.__name__ for mutate, _, _ in KINEMATIC])
def test_a_safeguard_that_is_gone_is_missed(
    mutate: Mutate, kind: FaultKind, rule: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mutate(monkeypatch)
    found: set[str] = set()
    for number in range(1, TRIES + 1):
        fault = Fault(kind=kind, at_s=2.0 + number, lasts_s=float("inf"), size=0.5)
        silent = replace(fault, kind=FaultKind.OPERATOR_SILENT, at_s=0.0)  # nobody else opens a region
        faults = (fault, silent) if kind is FaultKind.TOLD else (fault,)
        draw = replace(drawn(Adapter.KINEMATIC, number), world="sample", world_seed=number, faults=faults)
        found |= {breach.rule for breach in fly(draw, tmp_path / str(number), Counter()).breaches}
        if rule in found:
            return
    raise AssertionError(f"{mutate.__name__} is not found in {TRIES} missions; found: {sorted(found)}")
