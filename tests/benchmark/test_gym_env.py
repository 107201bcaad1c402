from __future__ import annotations

import re
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from mintpilot.benchmark.conditions import true_world
from mintpilot.benchmark.experiment import Prices
from mintpilot.benchmark.gym_env import SCALE, ElicitationEnv
from mintpilot.core.errors import InfeasibleError

POSSIBLE = 2


def test_gymnasium_finds_no_fault() -> None:
    import mintpilot.benchmark.gym_env  # noqa: F401  (a checkout that is not installed anew has no entry point yet)

    check_env(gymnasium.make("mintpilot/Elicitation-v0", render_mode="ansi").unwrapped)


def test_the_example_in_the_docs_runs() -> None:
    import mintpilot.benchmark.gym_env  # noqa: F401

    page = Path(__file__).parents[2] / "docs" / "benchmark.md"
    (code,) = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.S)
    names: dict[str, object] = {}
    exec(code, names)
    assert isinstance(names["reward"], float)


def test_asking_everything_then_committing_succeeds_at_the_price_of_the_questions() -> None:
    env = ElicitationEnv(render_mode="ansi")
    first, info = env.reset(options={"world": POSSIBLE})
    assert env.observation_space.contains(first)
    prices, reward = Prices(), 0.0
    for action in range(1, len(info["gaps"]) + 1):
        seen, paid, ended, cut, info = env.step(np.int64(action))
        assert not ended
        assert not cut
        assert set(np.unique(seen[action - 1, 1])) <= {0.0, 1.0}
        reward += paid
    assert reward == pytest.approx(-SCALE * prices.question_s * len(info["gaps"]))
    _, paid, ended, _, info = env.step(np.int64(0))
    assert ended
    assert info["success"]
    assert -SCALE * prices.failure_s < paid < 0
    assert "success" in (env.render() or "")


def test_asking_about_nothing_costs_and_too_many_questions_end_it() -> None:
    env = ElicitationEnv(max_questions=2)
    before, _ = env.reset(options={"world": POSSIBLE})
    after, paid, ended, cut, _ = env.step(np.int64(4))
    assert np.array_equal(before, after)
    assert (ended, cut) == (False, False)
    assert paid == pytest.approx(-SCALE * Prices().question_s)
    _, paid, ended, cut, _ = env.step(np.int64(4))
    assert (ended, cut) == (False, True)
    assert paid == pytest.approx(-SCALE * (Prices().question_s + Prices().failure_s))


def test_same_seed_same_worlds() -> None:
    env = ElicitationEnv()
    runs = []
    for _ in range(2):
        worlds = [env.reset(seed=9)[1]["world"]]
        worlds += [env.reset()[1]["world"] for _ in range(2)]
        runs.append(worlds)
    assert runs[0] == runs[1]
    assert len(set(runs[0])) == 3
    assert true_world(env._cell, runs[0][0]).seed == runs[0][0]
    with pytest.raises(InfeasibleError):
        ElicitationEnv(parameters={"endurance_least": 0.1, "endurance_most": 0.2}).reset(options={"world": 0})
