"""Q-learning finds the exact values where it is given time, says the same for the same seed, and fits its grid only."""

from __future__ import annotations

import numpy as np
import pytest
from bench.policy_judge import costs_to

from mintpilot.core.errors import InputError
from mintpilot.core.policy import PolicyState, policy_task
from mintpilot.policies.following import follow
from mintpilot.policies.grid import grid_of
from mintpilot.policies.q_learning import Training, learn
from policies.worlds import hall

WORLD = hall(5, shape=(8, 12), regions=2)
GRID = grid_of(WORLD.problem)


def free_under(mask: int) -> np.ndarray:
    free = WORLD.free.copy()
    for number, cells in enumerate(WORLD.regions):
        if mask >> number & 1:
            for cell in cells:
                free[cell] = False
    return free


def test_it_finds_the_shortest_ways_from_everywhere_under_every_hypothesis() -> None:
    policy = learn(GRID, Training(transitions=1_500_000, seed=1))
    for mask in range(4):
        free = free_under(mask)
        task, ahead = policy_task(free[None], (0, *WORLD.goal)), costs_to(free, WORLD.goal)
        for (y, x), cost in ahead.items():
            way = follow(policy, task, (0, y, x))
            assert way is not None
            assert way.cost == pytest.approx(cost)
            if cost:
                values = policy.q_values(PolicyState(task=task, cell=(0, y, x)))
                assert max(values[task.allowed[0, y, x]]) == pytest.approx(-cost, abs=1e-4)


def test_too_short_a_training_is_worse() -> None:
    policy = learn(GRID, Training(transitions=2_000, walkers=64, seed=1))
    task, ahead = policy_task(free_under(0)[None], (0, *WORLD.goal)), costs_to(free_under(0), WORLD.goal)
    ways = [(follow(policy, task, (0, *cell)), cost) for cell, cost in ahead.items()]
    assert any(way is None or way.cost > cost + 1e-6 for way, cost in ways)


def test_the_seed_decides() -> None:
    tables = [learn(GRID, Training(transitions=20_000, seed=seed)).values for seed in (3, 3, 4)]
    assert np.array_equal(tables[0], tables[1])
    assert not np.array_equal(tables[0], tables[2])


@pytest.mark.parametrize("wrong", [{"transitions": 0}, {"walkers": 0}, {"explore": 1.5}, {"restart": 0.0}])
def test_training_that_makes_no_sense_is_refused(wrong) -> None:
    with pytest.raises(InputError):
        Training(**wrong)


def test_a_grid_without_a_way_out_is_refused() -> None:
    shut = type(GRID)(free=np.zeros((1, 3, 3), bool), regions=(), goals=((0, 1, 1),))
    with pytest.raises(InputError, match="no cell of this grid has a way out"):
        learn(shut, Training(transitions=10))


def test_another_grid_region_or_goal_is_refused_by_name() -> None:
    policy = learn(GRID, Training(transitions=5_000))
    goal = (0, *WORLD.goal)

    def ask(free: np.ndarray, goal: tuple[int, int, int]) -> None:
        task = policy_task(free, goal)
        policy.q_values(PolicyState(task=task, cell=goal))

    ask(free_under(0)[None], goal)
    ask(free_under(3)[None], goal)
    with pytest.raises(InputError, match=r"made for a grid of \(1, 8, 12\) cells .* this one has \(1, 9, 12\)"):
        ask(np.ones((1, 9, 12), bool), goal)
    other = free_under(0)[None].copy()
    y, x = next((y, x) for y, x in np.argwhere(other[0]) if not any((y, x) in r for r in WORLD.regions))
    other[0, y, x] = False
    with pytest.raises(InputError, match="another grid of this size: 1 cells are free in one and not in the other"):
        ask(other, goal)
    with pytest.raises(InputError, match="made for flights to"):
        ask(free_under(0)[None], (0, *WORLD.start))
