"""The network of the example: small, on its own grid, and as safe as any policy."""

from __future__ import annotations

import pytest

from mintpilot.assembly.learning import mission_grid
from mintpilot.conformance import check_policy
from mintpilot.core.gap import BLOCKED, PASSABLE
from mintpilot.core.mission import Outcome
from mintpilot.core.policy import policy_task
from mintpilot.policies.files import load_policy
from policies.test_hostile import EXAMPLE, entered_smoke, flown

NETWORK = EXAMPLE.parent / "dqn.npz"


def test_it_keeps_the_contract_on_the_grid_of_its_mission() -> None:
    grid = mission_grid(EXAMPLE)
    for mask in range(grid.masks):
        check_policy(lambda: load_policy(NETWORK), policy_task(grid.under(mask), grid.goals[0]))


def test_it_is_small() -> None:
    assert NETWORK.stat().st_size < 100_000


@pytest.mark.long
@pytest.mark.parametrize("truth", [(a, b) for a in (PASSABLE, BLOCKED) for b in (PASSABLE, BLOCKED)])
def test_it_flies_the_mission(truth) -> None:
    outcome, path = flown(load_policy(NETWORK), truth, metric=True)
    assert outcome is Outcome.SUCCESS
    assert not entered_smoke(path, truth)
