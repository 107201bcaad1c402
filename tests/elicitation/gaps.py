"""Gaps to talk about."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.gap import Candidate, GapKind, KnowledgeGap
from mintpilot.core.observation import Attribute

START = (0.0, 0.0, 1.0)


def smoke(name: str, description: str) -> KnowledgeGap:
    return _gap(f"obstacle:{name}", GapKind.OBSTACLE, description, ("passable", "blocked"))


def room(name: str, description: str) -> KnowledgeGap:
    return _gap(f"presence:{name}", GapKind.PRESENCE, description, ("present", "absent"))


def figure() -> KnowledgeGap:
    words = "the chest-high grey thing on the floor"
    return replace(_gap("presence:figure", GapKind.PRESENCE, words, ("present", "absent")), is_thing=True)


def width() -> KnowledgeGap:
    return _gap("value:width", GapKind.VALUE, "the width of the gate in metres", ("1", "2", "3"))


def boxes() -> KnowledgeGap:
    things = (
        ("box-1", (5.0, 2.0, 0.0), "red", "large", 1.0),
        ("box-2", (5.0, -2.0, 0.0), "blue", "large", 1.0),
        ("box-3", (9.0, 0.5, 0.0), "red", "small", 0.4),
        ("box-4", (12.0, -1.0, 0.0), "green", "small", 0.4),
    )
    candidates = tuple(
        Candidate(
            id=name,
            position_m=place,
            attributes=(Attribute(name="colour", value=colour), Attribute(name="size", value=size)),
            size_m=(edge, edge, edge),
            description=f"the {size} {colour} box",
        )
        for name, place, colour, size, edge in things
    )
    return _gap("target:box", GapKind.TARGET, "the box", tuple(c.id for c in candidates), candidates)


def _gap(
    name: str, kind: GapKind, description: str, values: tuple[str, ...], candidates: tuple[Candidate, ...] = ()
) -> KnowledgeGap:
    return KnowledgeGap(
        id=name,
        kind=kind,
        subject=name,
        description=description,
        values=values,
        prior=tuple([1 / len(values)] * len(values)),
        position_m=(0.0, 0.0, 0.0),
        candidates=candidates,
    )


ALL = (
    smoke("a", "the grey smoke near the gate"),
    smoke("b", "the grey smoke by the rack"),
    smoke("c", "the grey smoke on the west side, the northern one"),
    room("r", "the closed room in the north corner"),
    room("s", "the closed room with the brown door"),
    boxes(),
    width(),
)
