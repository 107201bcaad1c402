"""The same trials on a real local Ray of two workers."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.benchmark.small import experiment
from tests.benchmark.test_run import plain

from mintpilot.benchmark.on_ray import RayPool
from mintpilot.benchmark.runner import RunOptions, run_experiment
from mintpilot.benchmark.store import read_records
from mintpilot.benchmark.trial import CRASHED, RAISED
from mintpilot.core.errors import MissingPartError


@pytest.mark.slow
@pytest.mark.usefixtures("bad_plugins")
@pytest.mark.filterwarnings("ignore")  # Ray leaves sockets to the collector, and deprecates itself
def test_ray_and_processes_make_the_same_records(tmp_path: Path) -> None:
    pytest.importorskip("ray")
    made = experiment("mint", "exhaustive", "raising", trials=3)
    for name, executor in (("pool", "process"), ("ray", "ray")):
        run_experiment(made, RunOptions(folder=tmp_path / name, executor=executor), lambda *_: None)
    pool, ray = (read_records(tmp_path / name) for name in ("pool", "ray"))
    assert [plain(t) for t in pool[0] if t.outcome != RAISED] == [plain(t) for t in ray[0] if t.outcome != RAISED]
    assert [t.outcome for t in pool[0]] == [t.outcome for t in ray[0]]
    assert pool[1] == ray[1]


@pytest.mark.slow
@pytest.mark.usefixtures("bad_plugins")
@pytest.mark.filterwarnings("ignore")
def test_a_ray_worker_that_dies_costs_its_own_trial_only(tmp_path: Path) -> None:
    pytest.importorskip("ray")
    made = experiment("mint", "dying", trials=1)
    run_experiment(made, RunOptions(folder=tmp_path / "ray", executor="ray"), lambda *_: None)
    found = {t.method: t for t in read_records(tmp_path / "ray")[0]}
    assert found["dying"].outcome == CRASHED
    assert found["mint"].success


def test_without_ray_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(MissingPartError, match=r"mintpilot\[ray\]"):
        RayPool(experiment("mint"), 1)
