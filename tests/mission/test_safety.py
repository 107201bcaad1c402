"""Safety is symbolic: whatever the planner, the strategy or the words say, unknown space and open regions stay shut."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mission.scenes import hall

from mintpilot.assembly.components import Choices, components_for
from mintpilot.assembly.worlds import build_world
from mintpilot.core.events import LegFlown
from mintpilot.core.mission import Outcome
from mintpilot.core.plan import Leg, Plan
from mintpilot.core.ports import Decision, Fly, Situation, Strategy
from mintpilot.core.query import Query, Question, Reply
from mintpilot.core.tree import Certificate, StopReason
from mintpilot.interaction.scripted import FunctionOperator
from mintpilot.mission.loop import fly_mission
from mintpilot.recording.recorders import MemoryRecorder

CERTIFICATE = Certificate(
    reason=StopReason.NEVER_ASKS,
    top_class_probability=1.0,
    entropy_bits=0.0,
    best_gain_bits=0.0,
    bound_s=0.0,
    text="trust me",
)


class Liar(Strategy):
    """Flies a way of its own choice and claims that all is well."""

    def __init__(self, way_m: np.ndarray, *, unsafe: bool = False) -> None:
        self._way, self._unsafe = way_m, unsafe

    def decide(self, situation: Situation) -> Decision:
        stop = situation.problem.stops[0]
        path = np.vstack([np.asarray([situation.problem.start_m]), self._way])
        leg = Leg(stop=stop, site=stop.sites[0], path_m=path, length_m=1.0, duration_s=1.0)
        entered = frozenset(gap.id for gap in situation.problem.gaps) if self._unsafe else frozenset()
        plan = Plan(legs=(leg,), cost_s=1.0, relies_on=frozenset(), enters=entered)
        return Fly(plan=plan, certificate=CERTIFICATE, unsafe=self._unsafe)


def fly(strategy: Strategy | None = None, *, simulated: bool = False, answer=lambda q, p: Reply.YES, word=None):
    world = build_world(hall(toxic=True), base=None, seed=0)
    recorder = MemoryRecorder()
    people = (FunctionOperator(answer),)
    with components_for(world, Choices(vehicle="kinematic"), operators=people, recorder=recorder) as made:
        parts = made.parts
        if strategy is not None:
            parts = replace(parts, strategy=strategy)
        if word is not None:
            parts = replace(parts, word=word)
        verdict = fly_mission(replace(made, parts=parts, simulated=simulated))
    legs = [e.log.position_m for e in recorder.events if isinstance(e, LegFlown)]
    return verdict, np.vstack(legs) if legs else np.zeros((0, 3))


THROUGH_CLOUD = np.array([[4.0, 2.0, 1.2], [9.0, 2.0, 1.2]])


@pytest.mark.parametrize("unsafe", [False, True])
def test_a_way_through_an_open_region_is_refused_outside_a_simulator(unsafe: bool) -> None:
    verdict, path = fly(Liar(THROUGH_CLOUD, unsafe=unsafe))
    assert verdict.outcome is Outcome.NO_SAFE_PLAN
    assert len(path) == 0


def test_an_unsafe_baseline_may_enter_an_open_region_in_a_simulator_only() -> None:
    for simulated in (True, False):
        verdict, path = fly(Liar(THROUGH_CLOUD, unsafe=True), simulated=simulated)
        entered = bool(len(path)) and bool((path[:, 0] > 4.9).any())  # the hull is in the cloud there
        assert entered is simulated
        assert (verdict.outcome is Outcome.TOXIC_SMOKE) is simulated


def test_a_way_through_a_wall_is_refused_even_in_a_simulator() -> None:
    verdict, path = fly(Liar(np.array([[5.0, 4.5, 1.2], [9.0, 4.5, 1.2]]), unsafe=True), simulated=True)
    assert verdict.outcome is Outcome.NO_SAFE_PLAN
    assert len(path) == 0


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(st.floats(-2, 14), st.floats(-2, 10), st.floats(-1, 4)).map(np.array), min_size=1, max_size=4)
)
def test_no_way_of_a_lying_strategy_enters_what_is_not_known_to_be_passable(points: list[np.ndarray]) -> None:
    verdict, path = fly(Liar(np.vstack(points)))
    assert verdict.outcome not in (Outcome.COLLISION, Outcome.TOXIC_SMOKE, Outcome.LEFT_VOLUME)
    cloud = (path[:, 0] > 5.2) & (path[:, 0] < 7.0) & (path[:, 1] > 0.2) & (path[:, 1] < 3.6) if len(path) else path
    assert not np.any(cloud)


@settings(max_examples=20, deadline=None)
@given(st.text(max_size=80), st.text(max_size=40), st.booleans())
def test_words_never_decide_meaning(text: str, consequence: str, yes: bool) -> None:
    def word(query: Query, gaps, mint, *, attempt: int = 1) -> Question:
        return Question(
            query=query, text=text, yes_means=consequence, no_means=consequence, gaps=tuple(gaps), attempt=attempt
        )

    verdict, path = fly(word=word, answer=lambda question, patience: Reply.NO, simulated=True)
    assert verdict.outcome is Outcome.SUCCESS
    assert not ((path[:, 0] > 5.2) & (path[:, 0] < 7.0) & (path[:, 1] < 3.6)).any()
