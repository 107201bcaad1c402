"""Whatever a policy says, what is flown stays in what is known free (method, sections 6 and 15).

The judges look at the cells and at the flown path by themselves; they share no code with the planner.
"""

from __future__ import annotations

import contextlib
import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.assembly.components import Choices, VehicleChoice, components_for, scripted_operator
from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import InputError
from mintpilot.core.events import LegFlown
from mintpilot.core.gap import BLOCKED, PASSABLE, Assumptions
from mintpilot.core.mission import Outcome
from mintpilot.core.policy import PolicyState, policy_task
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.schema import MissionFile
from mintpilot.policies.exact import ExactPolicy
from mintpilot.policies.metric import QValueMetric
from mintpilot.policies.planner import PolicyPlanner
from mintpilot.recording.recorders import MemoryRecorder
from policies.worlds import hall

EXAMPLE = Path(__file__).parents[2] / "examples" / "my-policy" / "mission.yaml"


class Drunk(ExactPolicy):
    """Knows the way, and misses it now and then: other errors for every seed and cell, the same ones each time."""

    def __init__(self, seed: int = 0) -> None:
        super().__init__()
        self.seed = seed

    def q_values(self, state):
        rng = np.random.default_rng([self.seed, *state.cell])
        return super().q_values(state) + rng.normal(0.0, 0.8, state.task.allowed.shape[-1])


class Straight:
    """Always wants east, through walls and smoke alike; what is allowed otherwise counts for less."""

    def q_values(self, state):
        return np.arange(state.task.allowed.shape[-1], dtype=float)


class Scribbler(Straight):
    """Tries to make smoke free by writing into what it is shown."""

    def q_values(self, state):
        for array in (state.task.free, state.task.allowed):
            with contextlib.suppress(ValueError):
                array.setflags(write=True)
            with contextlib.suppress(ValueError):
                array[...] = True
        return super().q_values(state)


class Nan:
    def q_values(self, state):
        return np.full(state.task.allowed.shape[-1], np.nan)


class Endless:
    def q_values(self, state):
        return np.full(state.task.allowed.shape[-1], np.inf)


class Hopeless:
    def q_values(self, state):
        return np.full(state.task.allowed.shape[-1], -np.inf)


class Crash:
    def q_values(self, state):
        raise ZeroDivisionError("no values today")


class Words:
    def q_values(self, state):
        return ["east"] * state.task.allowed.shape[-1]


class Short:
    def q_values(self, state):
        return np.zeros(2)


class Smoker(ExactPolicy):
    """Takes every cell for free, smoke and walls too, and wants through."""

    def q_values(self, state):
        open_ = policy_task(np.ones_like(state.task.free), state.task.goal)
        return super().q_values(PolicyState(task=open_, cell=state.cell))


HOSTILE = [Smoker, Drunk, Straight, Scribbler, Nan, Endless, Hopeless, Crash, Words, Short]
REFUSED = (Nan, Endless, Crash, Words, Short)


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**31), world=st.integers(0, 5), blocked=st.integers(0, 7))
def test_no_plan_of_any_policy_enters_what_is_not_free(seed, world, blocked) -> None:
    drawn = hall(world, shape=(10, 14))
    space = PolicyPlanner(Drunk(seed)).open(drawn.problem)
    assumed = Assumptions.exactly(
        {f"obstacle:r{i}": BLOCKED if blocked >> i & 1 else PASSABLE for i in range(len(drawn.regions))}
    )
    for plan in (space.optimistic(assumed), space.cautious(assumed)):
        if plan is None:
            continue
        cells = [(int(y), int(x)) for x, y, _ in plan.path_m]
        swept = {(a, b) for (y, x), (v, u) in itertools.pairwise(cells) for a in (y, v) for b in (x, u)} | set(cells)
        assert all(drawn.free[cell] for cell in swept)
        assert all(abs(y - v) <= 1 and abs(x - u) <= 1 for (y, x), (v, u) in itertools.pairwise(cells))
        for i, region in enumerate(drawn.regions):
            if blocked >> i & 1:
                assert not swept & region
            elif swept & region:
                assert f"obstacle:r{i}" in plan.enters


def test_a_policy_cannot_write_into_its_task() -> None:
    task = policy_task(hall(1, shape=(10, 14)).free[None], (0, 1, 1))
    before = task.free.copy(), task.allowed.copy()
    Scribbler().q_values(PolicyState(task=task, cell=(0, 1, 1)))
    assert np.array_equal(task.free, before[0])
    assert np.array_equal(task.allowed, before[1])


def test_an_open_region_is_relied_on_whoever_enters_it() -> None:
    entered = 0
    for seed in range(40):
        drawn = hall(seed % 6, shape=(10, 14))
        plan = PolicyPlanner(Drunk(seed)).open(drawn.problem).optimistic(Assumptions())
        if plan is None:
            continue
        cells = {(int(y), int(x)) for x, y, _ in plan.path_m}
        for i, region in enumerate(drawn.regions):
            if cells & region:
                assert f"obstacle:r{i}" in plan.relies_on
                entered += 1
    assert entered


@pytest.mark.parametrize("policy", REFUSED)
def test_values_that_are_none_are_refused_by_name(policy) -> None:
    problem = hall(1, shape=(10, 14)).problem
    with pytest.raises(InputError, match=policy.__name__):
        PolicyPlanner(policy()).open(problem).optimistic(Assumptions())


def flown(policy, truth: tuple[str, str], *, metric: bool = False) -> tuple[Outcome, np.ndarray]:
    """The example's mission, planned by that policy: how it ended, and the path (n, 3) that was flown."""
    text = yaml.safe_load(EXAMPLE.read_text())
    for region, value in zip(text["world"]["regions"], truth, strict=True):
        region["truth"] = value
    file = MissionFile.model_validate(text)
    world = build_world(file, base=EXAMPLE.parent, seed=0)
    recorder = MemoryRecorder()
    operator = scripted_operator(world, file.operator)
    choices = Choices(vehicle=VehicleChoice.KINEMATIC)
    with components_for(world, choices, operators=(operator,), recorder=recorder) as components:
        parts = replace(components.parts, planner=PolicyPlanner(policy))
        parts = replace(parts, metric=QValueMetric(policy)) if metric else parts
        verdict = fly_mission(replace(components, parts=parts))
    legs = [event.log.position_m for event in recorder.events if isinstance(event, LegFlown)]
    return verdict.outcome, np.vstack(legs) if legs else np.zeros((0, 3))


def entered_smoke(path_m: np.ndarray, truth: tuple[str, str]) -> bool:
    """Whether the path comes into a gate of the example whose smoke is not passable."""
    for gate_x, value in zip((5.0, 12.0), truth, strict=True):
        inside = (abs(path_m[:, 0] - gate_x - 0.5) < 0.5) & (path_m[:, 1] > 5) & (path_m[:, 1] < 7)
        if value == BLOCKED and inside.any():
            return True
    return False


@pytest.mark.parametrize("truth", [(BLOCKED, BLOCKED), (PASSABLE, BLOCKED)])
@pytest.mark.parametrize("policy", HOSTILE)
def test_a_flight_by_a_hostile_policy_is_no_less_safe(policy, truth) -> None:
    outcome, path = flown(policy(), truth)
    assert outcome in (Outcome.SUCCESS, Outcome.NO_SAFE_PLAN)
    assert not entered_smoke(path, truth)
    assert policy not in REFUSED or (outcome, len(path)) == (Outcome.NO_SAFE_PLAN, 0)


@pytest.mark.parametrize("truth", [(BLOCKED, BLOCKED), (PASSABLE, BLOCKED), (PASSABLE, PASSABLE)])
def test_by_exact_values_it_arrives(truth) -> None:
    outcome, path = flown(None, truth, metric=True)
    assert outcome is Outcome.SUCCESS
    assert not entered_smoke(path, truth)
    assert entered_smoke(path, (BLOCKED, BLOCKED)) is (PASSABLE in truth)


@pytest.mark.parametrize("policy", [Drunk(3), Straight(), Nan()])
def test_a_metric_by_a_hostile_policy_is_no_less_safe(policy) -> None:
    outcome, path = flown(policy, (BLOCKED, BLOCKED), metric=True)
    assert outcome in (Outcome.SUCCESS, Outcome.NO_SAFE_PLAN)
    assert not entered_smoke(path, (BLOCKED, BLOCKED))
