"""The campaign: it goes on where it stopped, a fault is found wherever it is put, and nothing is breached."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path
from typing import get_args

import pytest

from mintpilot.cli.bench_faults import AdapterName
from mintpilot.conformance.faults.campaign import RECORDS, FaultStore, counts, fly, planned, run_campaign
from mintpilot.conformance.faults.drawing import KINDS, drawn
from mintpilot.conformance.faults.kinds import RULES, Adapter, Fault, FaultKind, rule_of
from mintpilot.conformance.faults.ledger import Counter
from mintpilot.conformance.faults.records_kept import kept
from mintpilot.core.message import NOTHING
from mintpilot.core.mission import Outcome, Verdict

ENDED = Verdict(outcome=Outcome.SUCCESS, reason=NOTHING)


def draw_of(kind: FaultKind, *, at_s: float = 4.0, lasts_s: float = float("inf"), size: float = 0.5):
    fault = Fault(kind=kind, at_s=at_s, lasts_s=lasts_s, size=size)
    return replace(drawn(Adapter.KINEMATIC, 1), world="sample", world_seed=0, faults=(fault,))


def test_a_trial_depends_on_its_number_alone() -> None:
    assert drawn(Adapter.KINEMATIC, 7) == drawn(Adapter.KINEMATIC, 7)
    assert len({drawn(Adapter.KINEMATIC, n).faults for n in range(50)}) == 50
    for adapter, kinds in KINDS.items():
        assert {fault.kind for n in range(400) for fault in drawn(adapter, n).faults} == set(kinds)
    assert {kind for kinds in KINDS.values() for kind in kinds} == set(FaultKind), "each is drawn somewhere"


def test_every_fault_has_a_safe_state_and_a_time() -> None:
    assert all(rule_of(kind).state and rule_of(kind).within_s >= 0 for kind in FaultKind)
    assert set(RULES) <= set(FaultKind)


def test_a_part_of_a_campaign_is_the_beginning_of_the_whole() -> None:
    assert sum(counts(10_000).values()) == pytest.approx(10_000, abs=2)
    small, large = planned(counts(300)), planned(counts(3000))
    assert set(small) <= set(large)


@pytest.mark.long
@pytest.mark.parametrize(
    ("kind", "outcomes"),
    [
        (FaultKind.CAMERA_GONE, {"no-safe-plan"}),
        (FaultKind.POSITION_LOST, {"no-safe-plan"}),
        (FaultKind.LINK_LOST, {"vehicle-failed"}),
        (FaultKind.PILOT, {"aborted"}),
        (FaultKind.MOTOR_LOST, {"vehicle-failed"}),
        (FaultKind.DISK_FULL, {"success"}),
        (FaultKind.DISK_GONE, {"success"}),
    ],
)
def test_what_a_mission_comes_to_with_a_fault(tmp_path: Path, kind: FaultKind, outcomes: set[str]) -> None:
    record = fly(draw_of(kind), tmp_path, Counter())
    assert record.breaches == ()
    assert record.outcome in outcomes


@pytest.mark.long
def test_a_flood_changes_nothing_but_what_it_says(tmp_path: Path) -> None:
    """All that it says of the open question is that nobody knows: the mission asks on, and ends as without answers."""
    flooded = fly(draw_of(FaultKind.FLOODING, at_s=0.0), tmp_path / "flood", Counter())
    silent = fly(draw_of(FaultKind.OPERATOR_SILENT, at_s=0.0), tmp_path / "silent", Counter())
    calm = fly(replace(draw_of(FaultKind.WIND), faults=()), tmp_path / "calm", Counter())
    assert flooded.breaches == silent.breaches == calm.breaches == ()
    assert calm.outcome == "success"
    assert flooded.outcome in {silent.outcome, calm.outcome}
    assert flooded.events > 2 * calm.events, "there was a flood"


@pytest.mark.long
def test_a_recogniser_that_hears_anything_opens_nothing(tmp_path: Path) -> None:
    for number in range(3):
        heard = replace(draw_of(FaultKind.MISHEARD, at_s=0.0, size=1.0), number=number, world_seed=number)
        record = fly(heard, tmp_path / str(number), Counter())
        assert record.breaches == ()


@pytest.mark.long
def test_a_campaign_goes_on_where_it_stopped(tmp_path: Path) -> None:
    keys = [(Adapter.KINEMATIC, number) for number in (1, 4, 8)]
    store, heard = FaultStore(tmp_path), []
    run_campaign(store, keys[:2], jobs=2, heard=heard.append)
    store.close()
    file = tmp_path / RECORDS
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) // 2 + 40])  # cut inside of the second line
    again = FaultStore(tmp_path)
    run_campaign(again, keys, jobs=2, heard=heard.append)
    again.close()
    assert len(heard) == 4, "one was finished, one torn, one new"
    assert set(FaultStore(tmp_path).records) == set(keys)


def test_a_process_that_is_killed_leaves_all_that_it_wrote(tmp_path: Path) -> None:
    draw, written = draw_of(FaultKind.KILLED, at_s=30.0), Counter()
    if not (pid := os.fork()):
        try:
            fly(draw, tmp_path, written)
        finally:
            os._exit(1)
    assert os.WIFSIGNALED(os.waitpid(pid, 0)[1])
    assert 20 <= written.get() <= 30
    assert list(kept(tmp_path / "run", written=written.get(), refused=0, verdict=None)) == []
    assert list(kept(tmp_path / "run", written=written.get() + 1, refused=0, verdict=None)), "one more would be missed"


def test_a_line_that_is_missing_or_changed_is_found(tmp_path: Path) -> None:
    written = Counter()
    fly(draw_of(FaultKind.BATTERY, size=0.0), tmp_path, written)
    file = tmp_path / "run" / "events.ndjson"
    lines = file.read_bytes().splitlines(keepends=True)
    last = json.loads(lines[-1])["event"]["verdict"]["outcome"]
    file.write_bytes(b"".join([*lines[:10], *lines[11:]]))
    found = list(
        kept(tmp_path / "run", written=written.get(), refused=0, verdict=replace(ENDED, outcome=Outcome(last)))
    )
    assert {breach.rule for breach in found} >= {"record lost", "record unreadable"}


def test_the_command_names_every_adapter() -> None:
    assert set(get_args(AdapterName)) == {adapter.value for adapter in Adapter}
