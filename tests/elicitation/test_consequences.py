"""The two consequences tell what is flown: they differ where the flights differ, and each belongs to its answer."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivers.play import open_situation, told
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Ask
from mintpilot.core.query import Reply
from mintpilot.elicitation.wording import word_question
from mintpilot.strategies.mint import MintStrategy
from mintpilot.wording.tongues import TONGUES
from mintpilot.wording.translating import consequence
from oracles.worlds import random_world

EXACT = AskingSettings(delta_c_s=0.0, alpha=0.0, floor=0.0, goal_entropy_bits=0.0, max_questions=60)


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 100_000), regions=st.integers(0, 3), goals=st.sampled_from([1, 3, 6]))
def test_texts_are_the_same_only_where_the_same_is_flown(seed: int, regions: int, goals: int) -> None:
    world = random_world(np.random.default_rng(seed), regions=regions, goals=goals)
    situation = open_situation(world, EXACT)
    decision = MintStrategy().decide(situation)
    if not isinstance(decision, Ask):
        return
    query = decision.scored.query
    gaps = [gap for gap in world.gaps if gap.id in query.gap_ids]
    question = word_question(query, gaps, decision.mint)
    after = [MintStrategy().decide(told(situation, query, reply)) for reply in (Reply.YES, Reply.NO)]
    flights = [None if isinstance(one, Ask) or one.plan is None else one.plan.signature for one in after]
    if question.yes_means == question.no_means:
        assert flights[0] == flights[1]


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 100_000))
def test_through_goes_with_the_answer_that_opens(seed: int) -> None:
    world = random_world(np.random.default_rng(seed), regions=1)
    situation = open_situation(world, EXACT)
    decision = MintStrategy().decide(situation)
    if not isinstance(decision, Ask):
        return
    query = decision.scored.query
    question = word_question(query, [g for g in world.gaps if g.id in query.gap_ids], decision.mint)
    assert "through" in question.yes_means
    assert "through" not in question.no_means


@pytest.mark.parametrize("tongue", TONGUES.values(), ids=list(TONGUES))
def test_what_is_asked_further_is_said_in_every_language(tongue) -> None:  # type: ignore[no-untyped-def]
    for english in ("I ask further: 3 of them are left", "I ask further: 4 others are left",
                    "I ask further: the small red box or the large blue box"):  # fmt: skip
        said = consequence(english, tongue)
        assert said != english
        assert "left" not in said
