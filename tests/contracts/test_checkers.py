"""A plug-in that breaks its contract is found out, and told what it broke."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

from mintpilot.assembly.registry import load
from mintpilot.conformance import (
    check_language_model,
    check_metric,
    check_objective,
    check_operator,
    check_perception,
    check_planner,
    check_policy,
    check_recorder,
    check_strategy,
    check_vehicle,
)
from mintpilot.conformance.sample import sample_world
from mintpilot.core.errors import ConformanceError
from mintpilot.core.geometry import Box
from mintpilot.core.inputs import Answered
from mintpilot.core.observation import Detection
from mintpilot.core.ports import Ask, Completion, Fly
from mintpilot.core.query import Answer, Reply
from mintpilot.elicitation.objectives import InformationGain
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.reasoning.metrics import FrechetMetric
from mintpilot.simulation.kinematic import KinematicSimulator
from mintpilot.strategies.exhaustive import ExhaustiveStrategy
from mintpilot.strategies.mint import MintStrategy
from mintpilot.strategies.passive import RiskyStrategy


class OneWay:
    def divergence(self, a_m, b_m):
        return FrechetMetric().divergence(a_m, b_m) * (1 + a_m[-1, 1])


class CountsPoints:
    def divergence(self, a_m, b_m):
        return float(abs(len(a_m) - len(b_m)) + np.abs(a_m[0] - b_m[0]).sum() + np.abs(a_m[1:2] - b_m[1:2]).sum())


@pytest.mark.parametrize(("metric", "said"), [(OneWay, "symmetric"), (CountsPoints, "way-points added")])
def test_a_metric(metric, said):
    with pytest.raises(ConformanceError, match=said):
        check_metric(metric)


class Constant(InformationGain):
    def scores(self, situation):
        return np.ones(len(situation.parts))


class Short(InformationGain):
    def scores(self, situation):
        return super().scores(situation)[:1]


@pytest.mark.parametrize(("objective", "said"), [(Constant, "always answered yes"), (Short, "one number for each")])
def test_an_objective(objective, said):
    with pytest.raises(ConformanceError, match=said):
        check_objective(objective)


class Keen(MintStrategy):
    """Asks the best question over and over."""

    def decide(self, situation):
        decision = super().decide(replace(situation, asked=(), withdrawn=frozenset(), silent=False))
        return decision if isinstance(decision, Ask) else super().decide(situation)


class Reckless(RiskyStrategy):
    def decide(self, situation):
        decision = super().decide(situation)
        return replace(decision, unsafe=False) if isinstance(decision, Fly) else decision


class Pushy(ExhaustiveStrategy):
    def decide(self, situation):
        return super().decide(replace(situation, silent=False))


@pytest.mark.long
@pytest.mark.parametrize(
    ("strategy", "said"),
    [(Keen, "nobody answers|do not know"), (Reckless, "without saying `unsafe`"), (Pushy, "nobody")],
)
def test_a_strategy(strategy, said):
    with pytest.raises(ConformanceError, match=said):
        check_strategy(strategy)


class Blind(GridPlanner):
    """Takes every region for free space."""

    def open(self, problem):
        regions = tuple(replace(r, cells=r.cells[:0]) for r in problem.map.regions)
        return super().open(replace(problem, map=replace(problem.map, regions=regions)))


def test_a_planner():
    with pytest.raises(ConformanceError, match="leads through 'cloud'"):
        check_planner(Blind)


class Fickle:
    def __init__(self):
        self.rng = np.random.default_rng()

    def q_values(self, state):
        return self.rng.random(len(state.task.allowed[state.cell]))


class Lost:
    def q_values(self, state):
        return np.full(len(state.task.allowed[state.cell]), np.nan)


class Narrow:
    def q_values(self, state):
        return np.zeros(4)


class Brittle:
    def q_values(self, state):
        return {(1, 4, 5): np.zeros(8)}[state.task.free.shape]


@pytest.mark.parametrize(
    ("policy", "said"),
    [(Fickle, "asked again"), (Lost, "nan"), (Narrow, "shape"), (Brittle, "on another grid it fails with KeyError")],
)
def test_a_policy(policy, said):
    with pytest.raises(ConformanceError, match=said):
        check_policy(policy)


class Quiet:
    attended = False
    hears_once = False

    def show(self, question, patience_s):
        self.question = question

    def withdraw(self, question, why):
        self.question = None

    def tell(self, text):
        pass

    def poll(self, time_s):
        return ()


class Rude(Quiet):
    question = None

    def poll(self, time_s):
        if self.question is None:
            return ()
        answer = Answer(reply=Reply.YES, latency_s=float("nan"))
        answered = Answered(time_s=time_s, question=self.question.id, answer=answer)
        self.question = None
        return (answered,)


class Slow(Quiet):
    def poll(self, time_s):
        time.sleep(0.6)
        return ()


class Chatty(Rude):
    def poll(self, time_s):
        said = super().poll(time_s)
        return (replace(said[0], answer=Answer(reply=Reply.NO, latency_s=0.0)), *said) if said else ()


@pytest.mark.parametrize(
    ("operator", "said"), [(Rude, "latency_s"), (Slow, "no method may block"), (Chatty, "2 answers")]
)
def test_an_operator(operator, said):
    with pytest.raises(ConformanceError, match=said):
        check_operator(operator)


class Stubborn:
    def complete(self, prompt, *, schema, timeout_s):
        raise KeyError(prompt)


class Mumbling:
    def complete(self, prompt, *, schema, timeout_s):
        return "yes"


class Timeless:
    def complete(self, prompt, *, schema, timeout_s):
        return Completion(text="yes", model="timeless", seconds=float("inf"))


@pytest.mark.parametrize(
    ("model", "said"),
    [(Stubborn, "must be a DeviceError"), (Mumbling, "returned a str"), (Timeless, "seconds = inf")],
)
def test_a_language_model(model, said):
    with pytest.raises(ConformanceError, match=said):
        check_language_model(model)


class Dreamer:
    def detect(self, frame, index):
        return (Detection(label="box", score=2.0, box_m=Box(lo_m=(0, 0, 0), hi_m=(1, 1, 1)), frame_index=index),)


class Careless:
    def detect(self, frame, index):
        if not np.nan_to_num(frame.depth_m).any():
            return ()
        return (Detection(label="box", score=0.5, box_m=Box(lo_m=(0, 0, 0), hi_m=(1, 1, 1)), pixels=(0, 0, 999, 9)),)


@pytest.mark.parametrize(("perception", "said"), [(Dreamer, "without usable depth"), (Careless, "says frame -1")])
def test_a_perception(perception, said):
    with pytest.raises(ConformanceError, match=said):
        check_perception(perception)


class Deaf(KinematicSimulator):
    def brake(self):
        pass


class Hasty(KinematicSimulator):
    def advance(self, until_s):
        return super().advance(until_s + 2.0)


@pytest.mark.parametrize(("vehicle", "said"), [(Deaf, "told to brake"), (Hasty, "it went on|ended in half")])
def test_a_vehicle(vehicle, said):
    world = sample_world()
    with pytest.raises(ConformanceError, match=said):
        check_vehicle(lambda: vehicle(world.scene, world.rules, seed=0))


class Fussy:
    def record(self, event):
        if "<script>" in str(event):
            raise ValueError("I do not like this")


def test_a_recorder():
    with pytest.raises(ConformanceError, match="I do not like this"):
        check_recorder(Fussy)


def test_ours_pass_by_name():
    check_objective(load("objective", "information-gain"))
