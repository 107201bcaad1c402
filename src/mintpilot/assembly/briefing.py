"""The briefing of a mission: what was understood, what is not known, and battery against need."""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import Final

from mintpilot.core.briefing import GO_GAP, GO_QUERY, Briefing
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.query import Question
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import step_lines
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.rehearsal import begin

_WORDS: Final = MappingProxyType(
    {
        "en": ("Shall I take off and fly this mission?", "I take off: {}", "I stay on the ground"),
        "de": ("Soll ich starten und diese Mission fliegen?", "ich starte: {}", "ich bleibe am Boden"),
        "fr": ("Dois-je décoller et faire cette mission ?", "je décolle : {}", "je reste au sol"),
        "es": ("¿Despego y hago esta misión?", "despego: {}", "me quedo en el suelo"),
    }
)
"""By language: the question, and what Yes and No mean."""


def briefing_of(parts: DeliberationParts, map: SemanticMap | None, *, lang: str = "en") -> Briefing:
    """The briefing of a mission.

    Args:
        parts: mission, task, planner and strategy.
        map: what is known before take-off; None where a survey makes the map.
        lang: in which the question is put: ``en``, ``de``, ``fr`` or ``es``.
    """
    steps = tuple(step_lines(parts.task))
    lines = [f"I understood '{parts.task.instruction}' as:", *(f"  {line}" for line in steps)]
    if parts.task.needs_confirmation:
        lines.append("A language model read this; check it.")
    lines += _without_map(parts) if map is None else _on_map(parts, map)
    question, yes, no = _WORDS[lang]
    return Briefing(
        lines=tuple(lines),
        question=Question(
            query=GO_QUERY, text=question, yes_means=yes.format("; ".join(steps)), no_means=no, gaps=(GO_GAP,)
        ),
    )


def _without_map(parts: DeliberationParts) -> list[str]:
    return ["Not known: the map; I look around first.", _battery(parts.mission.limits.endurance_s, None)]


def _on_map(parts: DeliberationParts, map: SemanticMap) -> list[str]:
    try:
        found = begin(parts, map).deliberated()
    except InfeasibleError as error:
        return [f"Nothing can be flown as it is: {error}"]
    unknown = [gap.description for gap in found.findings.gaps]
    mint = found.decision.mint
    optimistic = None if mint is None else mint.root.optimistic
    need_s = None if optimistic is None else optimistic.cost_s + optimistic.home_s
    return [
        f"Not known: {'; '.join(unknown)}." if unknown else "Everything that matters is known.",
        _battery(parts.mission.limits.endurance_s, need_s),
    ]


def _battery(endurance_s: float, need_s: float | None) -> str:
    has = (
        "without limit"
        if math.isinf(endurance_s)
        else f"for {endurance_s:.0f} s of planned flight (some is kept for braking, corners and gusts)"
    )
    need = "" if need_s is None else f"; the mission needs {need_s:.0f} s if all goes well"
    return f"Battery: {has}{need}."
