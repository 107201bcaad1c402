"""The briefing of a mission: what was understood, what is not known, and battery against need."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from mintpilot.core.briefing import GO_GAP, GO_QUERY, Briefing
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.message import Message, Named, joined, message
from mintpilot.core.query import Question
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import step_lines
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.rehearsal import begin
from mintpilot.wording.speech import Speech

_WORDS: Final = MappingProxyType(
    {
        "en": ("Shall I take off and fly this mission?", "I take off: {}", "I stay on the ground"),
        "de": ("Soll ich starten und diese Mission fliegen?", "ich starte: {}", "ich bleibe am Boden"),
        "fr": ("Dois-je décoller et faire cette mission ?", "je décolle : {}", "je reste au sol"),
        "es": ("¿Despego y hago esta misión?", "despego: {}", "me quedo en el suelo"),
    }
)
"""By language: the question, and what Yes and No mean."""


def briefing_of(
    parts: DeliberationParts, map: SemanticMap | None, *, lang: str = "en", names: Mapping[str, str] | None = None
) -> Briefing:
    """The briefing of a mission.

    Args:
        parts: mission, task, planner and strategy.
        map: what is known before take-off; None where a survey makes the map.
        lang: in which the question is put: ``en``, ``de``, ``fr`` or ``es``.
        names: what the mission itself calls things there, by their English words.
    """
    steps = tuple(step_lines(parts.task))
    lines = [
        message("I understood '{instruction}' as:", instruction=parts.task.instruction),
        *(message("  {step}", step=step) for step in steps),
    ]
    if parts.task.needs_confirmation:
        lines.append(message("A language model read this; check it."))
    lines += _without_map(parts) if map is None else _on_map(parts, map)
    question, yes, no = _WORDS[lang]
    return Briefing(
        lines=tuple(lines),
        question=Question(
            query=GO_QUERY,
            text=question,
            yes_means=yes.format(Speech(lang, names or {})(joined(steps, "; "))),
            no_means=no,
            gaps=(GO_GAP,),
        ),
    )


def _without_map(parts: DeliberationParts) -> list[Message]:
    return [message("Not known: the map; I look around first."), _battery(parts.mission.limits.endurance_s, None)]


def _on_map(parts: DeliberationParts, map: SemanticMap) -> list[Message]:
    try:
        found = begin(parts, map).deliberated()
    except InfeasibleError as error:
        return [message("Nothing can be flown as it is: {why}", why=error.said)]
    unknown = [Named(gap.description) for gap in found.findings.gaps]
    mint = found.decision.mint
    optimistic = None if mint is None else mint.root.optimistic
    need_s = None if optimistic is None else optimistic.cost_s + optimistic.home_s
    return [
        message("Not known: {what}.", what=joined(unknown, "; "))
        if unknown
        else message("Everything that matters is known."),
        _battery(parts.mission.limits.endurance_s, need_s),
    ]


def _battery(endurance_s: float, need_s: float | None) -> Message:
    has = (
        message("Battery: without limit")
        if math.isinf(endurance_s)
        else message(
            "Battery: for {endurance_s:.0f} s of planned flight (some is kept for braking, corners and gusts)",
            endurance_s=endurance_s,
        )
    )
    if need_s is None:
        return message("{battery}.", battery=has)
    return message("{battery}; the mission needs {need_s:.0f} s if all goes well.", battery=has, need_s=need_s)
