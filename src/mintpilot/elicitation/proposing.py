"""Cuts that a language model proposes, in the predicate language only (method, section 4).

Each is parsed, type-checked and grounded in the tree's own gaps and candidates here; its real gain is scored where all
cuts are scored. A proposal can never be worth more than it is.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass

from pydantic import Field

from mintpilot.core.errors import MintPilotError
from mintpilot.core.gap import PASSABLE, PRESENT, GapKind, KnowledgeGap
from mintpilot.core.ports import LanguageModel
from mintpilot.core.query import Combine, Literal, Query, Saying, SayingKind
from mintpilot.core.tree import Mint
from mintpilot.models.forms import StrictForm, read_form

PROPOSING_S = 1.2
_MOST_CLASSES = 6
_ASKABLE = {GapKind.OBSTACLE: PASSABLE, GapKind.PRESENCE: PRESENT}

_PROMPT = """\
A drone does not know some things. Propose up to five yes/no cuts that tell its possible plans apart best.
What is open: {gaps}
Possible plans: {plans}
A cut has parts {{"gap": id, "value": value}}, or {{"gap": id, "attribute": name, "value": value}} for a property of \
the thing that is meant; several parts are combined by "all" or "any".
Answer with JSON only: {{"cuts": [{{"parts": [...], "combine": "all"}}]}}"""


class CutPart(StrictForm):
    """``gap`` has ``value``; with ``attribute``, what the gap's phrase means has that attribute."""

    gap: str = Field(max_length=200)
    value: str = Field(max_length=200)
    attribute: str = Field(default="", max_length=100)


class Cut(StrictForm):
    """One proposed cut."""

    parts: list[CutPart] = Field(min_length=1, max_length=3)
    combine: Combine = Combine.ALL


class Cuts(StrictForm):
    """What a model proposes to ask."""

    cuts: list[Cut] = Field(max_length=20)


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposals:
    """What a model proposed."""

    queries: tuple[Query, ...]
    """Sound cuts, none twice, in the model's order."""
    refused: tuple[str, ...]
    """A reason for each that was not."""
    model: str = ""
    seconds: float = 0.0


def propose_cuts(model: LanguageModel, mint: Mint, *, timeout_s: float = PROPOSING_S) -> Proposals:
    """Asks a model for cuts of the tree's joint hypotheses. Never raises for the model's sake: then there are none.

    Args:
        model: who is asked.
        mint: the tree; cuts may only speak of the gaps that it branches on.
        timeout_s: how long the model is waited for, seconds.
    """
    gaps = {gap.id: gap for gap in mint.belief.gaps}
    try:
        completion = model.complete(_prompt(mint, gaps), schema=Cuts, timeout_s=timeout_s)
    except MintPilotError as error:
        return Proposals(queries=(), refused=(str(error),))
    except Exception as error:  # a stranger's model may fail in any way
        return Proposals(queries=(), refused=(f"the language model failed ({type(error).__name__})",))
    cuts = read_form(completion.text, Cuts)
    if cuts is None:
        return Proposals(queries=(), refused=("no JSON of the form asked for",), model=completion.model)
    sound, refused = _ground(cuts, gaps)
    return Proposals(queries=sound, refused=refused, model=completion.model, seconds=completion.seconds)


def _ground(cuts: Cuts, gaps: Mapping[str, KnowledgeGap]) -> tuple[tuple[Query, ...], tuple[str, ...]]:
    sound: dict[str, Query] = {}
    refused: list[str] = []
    for cut in cuts.cuts:
        query = _query(cut, gaps)
        if isinstance(query, Query):
            sound.setdefault(query.id, query)
        else:
            refused.append(query)
    return tuple(sound.values()), tuple(refused)


def _query(cut: Cut, gaps: Mapping[str, KnowledgeGap]) -> Query | str:
    """The cut as a query, or why it is none."""
    literals = []
    for part in cut.parts:
        literal = _literal(part, gaps)
        if isinstance(literal, str):
            return literal
        literals.append(literal)
    if len(set(literals)) != len(literals):
        return "says the same twice"
    return Query(literals=tuple(literals), combine=cut.combine)


def _literal(part: CutPart, gaps: Mapping[str, KnowledgeGap]) -> Literal | str:
    gap = gaps.get(part.gap)
    if gap is None:
        return f"'{part.gap[:40]}' is no open gap"
    if part.attribute:
        having = frozenset(
            c.id for c in gap.candidates if any((a.name, a.value) == (part.attribute, part.value) for a in c.attributes)
        )
        if not having or len(having) == len(gap.values):
            return f"'{part.attribute[:40]}: {part.value[:40]}' tells nothing apart in '{gap.id}'"
        saying = Saying(kind=SayingKind.ATTRIBUTE, name=part.attribute, value=part.value)
        return Literal(gap=gap.id, values=having, saying=saying)
    if part.value not in gap.values or gap.kind is GapKind.VALUE:
        return f"'{part.value[:40]}' is no value of '{gap.id}'"
    if part.value != _ASKABLE.get(gap.kind, part.value):
        return f"'{part.value}' would be asked with a negation"
    saying = Saying(kind=SayingKind.VALUE, value=part.value)
    return Literal(gap=gap.id, values=frozenset({part.value}), saying=saying)


def _prompt(mint: Mint, gaps: Mapping[str, KnowledgeGap]) -> str:
    described = [
        {
            "gap": gap.id,
            "about": gap.description,
            "values": {v: round(mint.belief.probability_of(gap.id, v), 2) for v in gap.values},
            "attributes": {c.id: {a.name: a.value for a in c.attributes} for c in gap.candidates},
        }
        for gap in gaps.values()
    ]
    plans = [
        {
            "probability": round(c.probability, 2),
            "seconds": None if c.plan is None else round(c.plan.cost_s),
            "if": [{gap: sorted(values) for gap, values in given.items} for given in c.given[:3]],
        }
        for c in mint.classes[:_MOST_CLASSES]
    ]
    return _PROMPT.format(gaps=json.dumps(described), plans=json.dumps(plans))
