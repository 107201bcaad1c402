"""The monitors see a product that is broken: each mutant takes one safeguard away, and its breach is found.

A campaign that finds nothing is worth as much as these.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from mintpilot.conformance.faults.campaign import fly
from mintpilot.conformance.faults.drawing import drawn
from mintpilot.conformance.faults.kinds import Adapter, Fault, FaultKind
from mintpilot.conformance.faults.ledger import Counter
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.mission import ordering, shell, telling, transition
from mintpilot.recording.run_folder import RunFolder
from mintpilot.vehicle import control

TRIES = 8
"""Missions at most until a mutant is found."""
Mutate = Callable[[pytest.MonkeyPatch], None]


def what_is_told_counts_at_once(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(telling, "_FREEING", ())
    patch.setattr(telling, "enlarges", lambda *_: False)


def what_is_drawn_is_flown(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(telling.facts, "with_drawn", lambda map, drawn: map)


def it_flies_on_blind(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(ordering, "_blind", lambda *_: None)


def it_flies_on_in_a_pilots_hands(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(ordering, "link_changed", lambda *_: None)


def it_never_brakes(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(transition.Transition, "brake", lambda self: None)


def it_loses_events(patch: pytest.MonkeyPatch) -> None:
    inner, count = RunFolder.record, itertools.count()
    patch.setattr(RunFolder, "record", lambda self, event: inner(self, event) if next(count) % 20 else None)


def it_always_says_success(patch: pytest.MonkeyPatch) -> None:
    success = Verdict(outcome=Outcome.SUCCESS, reason="")
    patch.setattr(shell.Shell, "verdict", lambda self, state: success)


def the_deadman_sleeps(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(control, "_deadman", lambda turn: None)


KINEMATIC = [
    (what_is_told_counts_at_once, FaultKind.TOLD, "flown where not known free"),
    (what_is_drawn_is_flown, FaultKind.TOLD, "flown where drawn"),
    (it_flies_on_blind, FaultKind.CAMERA_GONE, "not safe in time"),
    (it_flies_on_in_a_pilots_hands, FaultKind.PILOT, "commanded after hands off"),
    (it_never_brakes, FaultKind.ORDERS, "not safe in time"),
    (it_loses_events, FaultKind.OPERATOR_SILENT, "record lost"),
    (it_always_says_success, FaultKind.OPERATOR_GONE, "verdict"),
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


@pytest.mark.slow
def test_a_deadman_that_sleeps_is_missed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    the_deadman_sleeps(monkeypatch)
    records = (fly(drawn(Adapter.LINK, number), tmp_path, Counter()) for number in range(40))
    assert any(breach.rule == "left flying" for record in records for breach in record.breaches)
