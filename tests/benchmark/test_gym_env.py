from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from mintpilot.benchmark.conditions import true_world
from mintpilot.benchmark.experiment import Prices
from mintpilot.benchmark.gym_env import SCALE, ElicitationEnv
from mintpilot.core.errors import InfeasibleError, InputError

POSSIBLE = 2


def test_gymnasium_finds_no_fault() -> None:
    import mintpilot.gym  # noqa: F401

    check_env(gymnasium.make("mintpilot/Elicitation-v0", render_mode="ansi").unwrapped)


def test_the_example_in_the_docs_runs() -> None:
    page = Path(__file__).parents[2] / "docs" / "benchmark.md"
    (code,) = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.S)
    names: dict[str, object] = {}
    exec(code, names)
    assert isinstance(names["reward"], float)


def test_asking_everything_then_committing_succeeds_at_the_price_of_the_questions() -> None:
    env = ElicitationEnv(render_mode="ansi")
    first, info = env.reset(options={"world": POSSIBLE})
    assert env.observation_space.contains(first)
    (commit, best, question, failure, left) = first["costs"]
    assert 0 < best <= commit <= failure + best
    assert (question, failure, left) == pytest.approx((SCALE * Prices().question_s, SCALE * Prices().failure_s, 1.0))
    prices, reward = Prices(), 0.0
    for action in range(1, len(info["gaps"]) + 1):
        seen, paid, ended, cut, info = env.step(np.int64(action))
        assert not ended
        assert not cut
        assert set(np.unique(seen["gaps"][action - 1, 1])) <= {0.0, 1.0}
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
    assert np.array_equal(before["gaps"], after["gaps"])
    assert after["costs"][-1] == pytest.approx(0.5)
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


@pytest.mark.long
def test_it_can_be_made_in_a_fresh_process() -> None:
    code = "import gymnasium; print(gymnasium.make('mintpilot.gym:mintpilot/Elicitation-v0').action_space.n)"
    made = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert made.stdout.strip() == "5", made.stderr


def test_a_world_that_comes_again_is_not_thought_through_again(monkeypatch: pytest.MonkeyPatch) -> None:
    env = ElicitationEnv(worlds=[POSSIBLE])
    first, _ = env.reset(seed=0)
    asked, *_ = env.step(np.int64(1))
    monkeypatch.setattr("mintpilot.mission.rehearsal.Rehearsal.deliberated", lambda _: pytest.fail("thought again"))
    again, _ = env.reset()
    asked_again, *_ = env.step(np.int64(1))
    for key, value in first.items():
        assert np.array_equal(value, again[key])
        assert np.array_equal(asked[key], asked_again[key])


def test_worlds_must_be_given() -> None:
    with pytest.raises(InputError, match="worlds is empty"):
        ElicitationEnv(worlds=[])
