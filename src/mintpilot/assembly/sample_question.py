"""One question of each kind, to try answers on without a mission."""

from __future__ import annotations

from collections.abc import Sequence

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, Candidate, GapKind, KnowledgeGap
from mintpilot.core.observation import Attribute
from mintpilot.core.query import Literal, Query, Question, Saying, SayingKind
from mintpilot.elicitation.wording import word_question
from mintpilot.wording.translating import ENGLISH, wording_for


def sample_question(kind: GapKind, *, lang: str = ENGLISH, candidates: Sequence[Candidate] = ()) -> Question:
    """A question as the drone would ask it: grey smoke near the gate, a closed room, or which box is meant.

    Args:
        kind: obstacle, presence or target.
        lang: of its words.
        candidates: for a target, two or more things that may be meant; default: a small red, a large blue and a small
            blue box. The question is about the first attribute of the first one that tells it from another.

    Raises:
        UnknownNameError: the language is not known.
    """
    return question_about(target_gap(candidates or BOXES) if kind is GapKind.TARGET else _PLACES[kind], lang=lang)


def question_about(gap: KnowledgeGap, *, lang: str = ENGLISH) -> Question:
    """A yes/no question about that gap alone. Raises `UnknownNameError` where the language is not known."""
    literal = _first_attribute(gap) if gap.kind is GapKind.TARGET else _is(gap, gap.values[0])
    return wording_for(word_question, language=lang)(Query(literals=(literal,)), (gap,), None)


def target_gap(candidates: Sequence[Candidate]) -> KnowledgeGap:
    """The gap which of these things is meant, all equally likely."""
    return KnowledgeGap(
        id="target:sample", kind=GapKind.TARGET, subject="the thing", description="the thing",
        values=tuple(c.id for c in candidates), prior=(1 / len(candidates),) * len(candidates),
        position_m=(0.0, 0.0, 0.0), candidates=tuple(candidates),
    )  # fmt: skip


def _place(name: str, kind: GapKind, description: str, values: tuple[str, str]) -> KnowledgeGap:
    return KnowledgeGap(
        id=f"{kind}:{name}", kind=kind, subject=name, description=description, values=values, prior=(0.5, 0.5),
        position_m=(0.0, 0.0, 0.0),
    )  # fmt: skip


def _box(name: str, size: str, colour: str) -> Candidate:
    attributes = (Attribute(name="colour", value=colour), Attribute(name="size", value=size))
    return Candidate(id=name, position_m=(0.0, 0.0, 0.0), attributes=attributes, description=f"the {size} {colour} box")


def _is(gap: KnowledgeGap, value: str) -> Literal:
    return Literal(gap=gap.id, values=frozenset({value}), saying=Saying(kind=SayingKind.VALUE, value=value))


def _first_attribute(gap: KnowledgeGap) -> Literal:
    for attribute in gap.candidates[0].attributes:
        values = frozenset(c.id for c in gap.candidates if attribute in c.attributes)
        if len(values) < len(gap.values):
            saying = Saying(kind=SayingKind.ATTRIBUTE, name=attribute.name, value=attribute.value)
            return Literal(gap=gap.id, values=values, saying=saying)
    return _is(gap, gap.values[0])


BOXES = (_box("box-1", "small", "red"), _box("box-2", "large", "blue"), _box("box-3", "small", "blue"))
_PLACES = {
    GapKind.OBSTACLE: _place("smoke-1", GapKind.OBSTACLE, "the grey smoke near the gate", (PASSABLE, BLOCKED)),
    GapKind.PRESENCE: _place("room-1", GapKind.PRESENCE, "the closed room with the brown door", (PRESENT, ABSENT)),
}
