"""Every form of question in words, and what is thought in small random worlds, are what they were (`kept`).

`sentences.txt` is for people to read as well: who rewords a question changes it there.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from drivers.play import open_situation
from kept import plain, same_as_kept
from mintpilot.assembly.registry import BUILT_IN, load
from mintpilot.core.digest import digest
from mintpilot.core.errors import LimitError
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.mission import AskingSettings, QueryKinds
from mintpilot.core.ports import Ask, Situation
from mintpilot.core.query import Combine, Query
from mintpilot.core.tree import Mint, StopReason
from mintpilot.elicitation.candidates import candidate_queries, gap_literals
from mintpilot.elicitation.choices import choices_about
from mintpilot.elicitation.choose import choose
from mintpilot.elicitation.sentences import is_sayable
from mintpilot.elicitation.wording import word_question
from mintpilot.reasoning.belief import condition
from mintpilot.reasoning.certificate import certify
from mintpilot.reasoning.explain import explain_gaps
from mintpilot.reasoning.safety import taken_for_granted
from mintpilot.reasoning.situation import regret_matrix
from mintpilot.strategies.flying import tree_of
from mintpilot.strategies.mint import MintStrategy
from oracles.worlds import random_world

from .gaps import ALL, START, figure, room, smoke

FOLDER = Path(__file__).parent
MORE = (
    *ALL,
    smoke(
        "long", "the grey smoke between the tall rack with the yellow boxes on it and the door in the far wall of it"
    ),
    room("t", "the closed room behind the rack"),
    figure(),
    replace(figure(), id="presence:other", subject="presence:other", description="the flat green thing by the door"),
)


def queries() -> Iterator[Query]:
    literals = {gap.id: gap_literals(gap, START) for gap in MORE}
    for gap in MORE:
        yield from (Query(literals=(one,)) for one in literals[gap.id])
        for pair in combinations(literals[gap.id], 2):
            yield from (Query(literals=pair, combine=combine) for combine in Combine)
    for size in (2, 3):
        for some in combinations(MORE, size):
            if size == 2 or len({gap.kind for gap in some}) == 1:
                chosen = tuple(literals[gap.id][0] for gap in some)
                yield from (Query(literals=chosen, combine=combine) for combine in Combine)
    yield from choices_about((ALL[0], ALL[1], *ALL[3:], *MORE[-2:]))


def said(query: Query, gaps: tuple[KnowledgeGap, ...], mint: Mint | None, attempt: int = 1) -> str:
    question = word_question(query, gaps, mint, attempt=attempt)
    short = "" if is_sayable(query, {gap.id: gap for gap in gaps}) else " (too long)"
    follows = (*question.option_means, question.yes_means, question.no_means)
    return f"{question.text}{short} {'; '.join(one for one in follows if one)}."


def test_questions_are_worded_as_they_were() -> None:
    found = {f"{digest(query)[:6]} {attempt}": said(query, MORE, None, attempt)
             for query in queries() for attempt in (1, 2)}  # fmt: skip
    same_as_kept(FOLDER / "sentences.txt", found)


@pytest.mark.parametrize("seed", range(10))
def test_what_is_thought_is_what_was_thought(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shape = {"regions": seed % 3, "goals": (1, 3)[seed % 2], "rooms": seed % 2, "uneven": seed % 5 > 0}
    world = random_world(rng, **shape)
    settings = AskingSettings(delta_c_s=0.5 * (seed % 3), answer_error=0.05 * (seed % 4 == 3), alpha=0.02 * (seed % 2))
    situation = open_situation(world, settings)
    found = {f"{seed} {name}": text for name, text in thought(situation, world.gaps)}
    same_as_kept(FOLDER / "thoughts.txt", found)


def thought(situation: Situation, gaps: tuple[KnowledgeGap, ...]) -> Iterator[tuple[str, str]]:
    """What each part of the reasoning comes to, in a line each."""
    mint = tree_of(situation)
    yield "tree", marked(mint)
    settings, belief = situation.settings, situation.belief
    yield "explained", marked(explain_gaps(situation.space, belief, mint, settings, situation.metric))
    for reason in StopReason:
        yield f"certificate {reason}", marked(certify(reason, mint.classes[0].plan, mint, belief, settings))
    yield "granted", marked(taken_for_granted(belief, (), settings))
    regret_s = regret_matrix(mint, settings)
    found = candidate_queries(mint, start_m=START, kinds=QueryKinds.ANY)[:25]
    for number, query in enumerate(found):
        yield f"query {number}", f"{query.id} {said(query, gaps, mint)}"
        for part in range(query.part_count):
            update = condition(belief, query, part, settings.answer_error)
            yield f"query {number} part {part}", marked(update)
    for name in sorted(BUILT_IN["objective"]):
        try:
            yield f"objective {name}", marked(choose(found, mint, regret_s, load("objective", name)(), settings))
        except LimitError as error:
            yield f"objective {name}", str(error)
    decision = MintStrategy().decide(situation)
    yield "decision", decision.scored.query.id if isinstance(decision, Ask) else marked(decision.plan)


def marked(value: object) -> str:
    """The first words, and a digest of all."""
    lines = list(plain(value, digits=4))
    return f"{' '.join(lines[:6])[:120]} {hashlib.sha256(chr(10).join(lines).encode()).hexdigest()[:8]}"
