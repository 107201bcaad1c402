"""A wish to keep out of smoke is given up where the task cannot be done otherwise; a strict one is not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.observation import RegionKind
from mintpilot.core.ports import Ask, Fly
from mintpilot.core.rule import Rule
from mintpilot.mission.rehearsal import begin

from .scenes import hall


def deliberated(*, strict: bool, detour: bool):
    world = build_world(hall(detour=detour), base=Path(), seed=0)
    parts = deliberation_parts(world, Choices())
    rule = Rule(text="never enter the smoke", formula="G !touches(smoke)")
    kept = {"rules": (rule,)} if strict else {"avoid": (RegionKind.SMOKE,)}
    return begin(replace(parts, task=replace(parts.task, **kept)), world.map).deliberated()


def test_without_another_way_a_wish_is_given_up_and_asked_about() -> None:
    decision = deliberated(strict=False, detour=False).decision
    assert isinstance(decision, Ask)
    assert decision.scored.query.gap_ids == ("obstacle:cloud",)


def test_with_another_way_a_wish_is_kept_without_a_question() -> None:
    decision = deliberated(strict=False, detour=True).decision
    assert isinstance(decision, Fly)
    assert decision.plan is not None
    assert decision.plan.enters == frozenset()


def test_what_is_strict_is_never_given_up() -> None:
    with pytest.raises(InfeasibleError):
        deliberated(strict=True, detour=False)
