"""Policies on disk: what was saved comes back; what is damaged, foreign or senseless is refused with its name."""

from __future__ import annotations

import contextlib
import itertools
import pickle
from pathlib import Path

import numpy as np
import pytest

from mintpilot.assembly.policies import make_metric, make_planner, make_policy
from mintpilot.conformance import check_policy
from mintpilot.core.errors import InputError, UnknownNameError
from mintpilot.core.policy import PolicyState, policy_task
from mintpilot.policies.files import load_policy, save_policy
from mintpilot.policies.grid import grid_of
from mintpilot.policies.network import NetworkPolicy, observation, observation_size
from mintpilot.policies.q_learning import Training, learn
from policies.worlds import hall

WORLD = hall(5, shape=(8, 12), regions=2)
GRID = grid_of(WORLD.problem)
TASK = policy_task(GRID.free, GRID.goals[0])
STATE = PolicyState(task=TASK, cell=(0, *WORLD.start))


def table():
    return learn(GRID, Training(transitions=5_000))


def network(seed: int = 0) -> NetworkPolicy:
    rng = np.random.default_rng(seed)
    sizes = (observation_size(GRID), 16, 8)
    layers = tuple(
        (rng.normal(size=(b, a)).astype(np.float32), rng.normal(size=b).astype(np.float32))
        for a, b in itertools.pairwise(sizes)
    )
    return NetworkPolicy(GRID, layers, edges_per_unit=10.0)


@pytest.fixture(params=[table, network], ids=["table", "network"])
def saved(request, tmp_path) -> Path:
    save_policy(tmp_path / "mine.npz", request.param())
    return tmp_path / "mine.npz"


def changed(path: Path, **arrays: object) -> Path:
    """The file with some arrays replaced, or left out where None is given."""
    with np.load(path) as file:
        kept = {name: file[name] for name in file.files}
    kept |= arrays
    np.savez(path, **{name: array for name, array in kept.items() if array is not None})
    return path


@pytest.mark.parametrize("make", [table, network])
def test_what_was_saved_comes_back(make, tmp_path) -> None:
    policy = make()
    save_policy(tmp_path / "mine.npz", policy)
    again = make_policy(str(tmp_path / "mine.npz"))
    assert np.array_equal(policy.q_values(STATE), again.q_values(STATE))
    check_policy(lambda: load_policy(tmp_path / "mine.npz"), TASK)


def test_a_network_is_what_its_layers_say() -> None:
    policy = network()
    (w1, b1), (w2, b2) = policy.layers
    seen = observation(GRID, 0, 0, STATE.cell)
    hot = [0, 1 + STATE.cell[1], 1 + 8 + STATE.cell[2], 1 + 8 + 12]
    assert seen[hot].tolist() == [1.0] * 4
    assert seen[-2:].tolist() == [-1.0, -1.0]
    assert observation(GRID, 2, 0, STATE.cell)[-2:].tolist() == [-1.0, 1.0]
    hidden = [max(0.0, sum(w * s for w, s in zip(row, seen, strict=True)) + b) for row, b in zip(w1, b1, strict=True)]
    wanted = [10 * (sum(w * h for w, h in zip(row, hidden, strict=True)) + b) for row, b in zip(w2, b2, strict=True)]
    assert policy.q_values(STATE) == pytest.approx(wanted, rel=1e-5)


def test_a_truncated_file(saved) -> None:
    whole = saved.read_bytes()
    for size in (0, 1, 10, len(whole) // 2, len(whole) - 1):
        saved.write_bytes(whole[:size])
        with pytest.raises(InputError, match=r"mine\.npz: is truncated, or no file of a policy"):
            load_policy(saved)


def test_a_damaged_file_is_refused_or_read_as_it_was(saved) -> None:
    whole, rng = saved.read_bytes(), np.random.default_rng(1)
    for _ in range(60):
        bad = bytearray(whole)
        bad[int(rng.integers(len(bad)))] ^= 1 << int(rng.integers(8))
        saved.write_bytes(bytes(bad))
        with contextlib.suppress(InputError):
            load_policy(saved)


@pytest.mark.parametrize("content", [b"", b"PK", b"torch", pickle.dumps({"policy": 1})])
def test_a_foreign_file(tmp_path, content) -> None:
    (tmp_path / "mine.npz").write_bytes(content)
    with pytest.raises(InputError, match=r"mine\.npz: is truncated, or no file of a policy"):
        load_policy(tmp_path / "mine.npz")


def test_an_archive_of_something_else(tmp_path) -> None:
    np.savez(tmp_path / "mine.npz", weights=np.zeros(3))
    with pytest.raises(InputError, match="is no policy of the form 'mintpilot-policy-1'"):
        load_policy(tmp_path / "mine.npz")


class Trap:
    sprung = False

    def __reduce__(self):
        return (setattr, (Trap, "sprung", True))


def test_pickles_are_not_opened(saved) -> None:
    changed(saved, free=np.array([Trap()], object))
    with pytest.raises(InputError, match=r"mine\.npz"):
        load_policy(saved)
    assert not Trap.sprung


def test_no_such_file(tmp_path) -> None:
    with pytest.raises(InputError, match=r"none\.npz: there is no such file\. Learn it anew"):
        load_policy(tmp_path / "none.npz")


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_none(saved, bad) -> None:
    with np.load(saved) as file:
        name = "values" if "values" in file.files else "weights_1"
        array = file[name].copy()
    array.flat[-1] = bad
    with pytest.raises(InputError, match=r"mine\.npz: .*not finite"):
        load_policy(changed(saved, **{name: array}))


@pytest.mark.parametrize(
    ("arrays", "said"),
    [
        ({"free": None}, "lacks free"),
        ({"goals": None, "region_sizes": None}, "lacks region_sizes, goals"),
        ({"goals": np.array([[0, 99, 0]])}, "grid makes no sense"),
        ({"goals": np.zeros((0, 3), np.int64)}, "grid makes no sense"),
        ({"goals": np.array([0, 1, 2])}, "grid makes no sense"),
        ({"free": np.ones((8, 12), bool)}, "grid makes no sense"),
        ({"free": np.ones((1, 8, 12))}, "free of a wrong type"),
        ({"goals": np.array([["0", "1", "x"]])}, "goals of a wrong type"),
        ({"region_cells": np.array([-1]), "region_sizes": np.array([1])}, "grid makes no sense"),
        ({"region_sizes": np.array([-1, 5])}, "grid makes no sense"),
        ({"region_sizes": np.ones(40, np.int64)}, "grid makes no sense"),
    ],
)
def test_a_grid_that_makes_no_sense(saved, arrays, said) -> None:
    with pytest.raises(InputError, match=rf"mine\.npz: .*{said}"):
        load_policy(changed(saved, **arrays))


def test_values_that_do_not_fit_the_grid(tmp_path) -> None:
    save_policy(tmp_path / "mine.npz", table())
    with pytest.raises(InputError, match=r"a table of shape \(4, 1, 96, 7\) for a grid that needs \(4, 1, 96, 8\)"):
        load_policy(changed(tmp_path / "mine.npz", values=np.zeros((4, 1, 96, 7), np.float32)))
    with pytest.raises(InputError, match="values are of type int64"):
        load_policy(changed(tmp_path / "mine.npz", values=np.zeros((4, 1, 96, 8), np.int64)))


@pytest.mark.parametrize(
    ("arrays", "said"),
    [
        ({"weights_0": np.zeros((16, 5), np.float32)}, r"layer 0: weights of shape \(16, 5\)"),
        ({"biases_1": np.zeros(7, np.float32)}, "layer 1: weights of shape"),
        ({"weights_1": np.zeros((4, 16), np.float32), "biases_1": np.zeros(4, np.float32)}, "4 outputs for 8 actions"),
        ({"weights_0": None}, "lacks weights_0"),
        ({"biases_0": None}, "lacks biases_0"),
        ({"edges_per_unit": np.array(0.0)}, "edges_per_unit = 0.0"),
        ({"edges_per_unit": np.array([1.0, 2.0])}, "one number it must be"),
        ({"edges_per_unit": None}, "lacks edges_per_unit"),
    ],
)
def test_layers_that_do_not_fit(tmp_path, arrays, said) -> None:
    save_policy(tmp_path / "mine.npz", network())
    with pytest.raises(InputError, match=rf"mine\.npz: .*{said}"):
        load_policy(changed(tmp_path / "mine.npz", **arrays))


def test_names(tmp_path) -> None:
    with pytest.raises(UnknownNameError, match=r"unknown policy 'exakt'\. Did you mean 'exact'"):
        make_planner("policy:exakt")
    with pytest.raises(InputError, match="only 'policy' goes by a policy; write policy:exact"):
        make_planner("grid:exact")
    with pytest.raises(InputError, match="only 'q-value' goes by a policy"):
        make_metric("frechet:exact")
    make_metric("q-value:exact")
    with pytest.raises(InputError, match=r"ends in \.npz"):
        save_policy(tmp_path / "mine.pt", table())
    with pytest.raises(InputError, match="cannot be written"):
        save_policy(tmp_path / "no" / "mine.npz", table())
