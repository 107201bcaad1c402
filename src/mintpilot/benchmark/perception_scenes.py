"""Furnished rooms looked at, perceived and mapped, with the truth about what could be seen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mintpilot.assembly.mapping_frames import mapped
from mintpilot.core.geometry import Box
from mintpilot.core.observation import Frame
from mintpilot.core.ports import Perception
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.furnished.room import HEIGHT_M, FurnishedRoom, furnished_room, world_of
from mintpilot.simulation.furnished.shapes import Shown
from mintpilot.simulation.furnished.style import Style
from mintpilot.simulation.render import SceneRenderer
from mintpilot.simulation.scene import Scene

LEAST_PIXELS = 300
"""What no picture shows with so many pixels, whole, is not counted: it could not be seen."""
DOOR_PIXELS = 900
NEAR_EDGE = 2
"""What reaches so near to the picture's edge is not whole, pixels."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SeenRoom:
    """One room with what was made of it."""

    room: FurnishedRoom
    map: SemanticMap
    visible: tuple[Shown, ...]
    """What could be seen."""
    hidden: tuple[Shown, ...]
    """What is there as well: whether it is found does not count, and it is no mistake."""


def seen_rooms(style: Style, seeds: Sequence[int], perception: Perception) -> Iterator[SeenRoom]:
    """Draws rooms of a style, takes their pictures, perceives and maps them.

    Args:
        style: of the rooms.
        seeds: one for each room.
        perception: makes objects of pictures.

    Raises:
        MissingPartError: MuJoCo is not installed.
    """
    for seed in seeds:
        room = furnished_room(style, seed)
        frames, pixels = pictures_of(room, seed)
        visible = tuple(one for one, seen in zip(room.shown, pixels, strict=True) if seen)
        hidden = tuple(one for one, seen in zip(room.shown, pixels, strict=True) if not seen)
        yield SeenRoom(room=room, map=mapped(frames, perception, 0.0), visible=visible, hidden=hidden)


def pictures_of(room: FurnishedRoom, seed: int) -> tuple[list[Frame], list[bool]]:
    """The pictures of a room, and whether each thing in it is seen well in one of them."""
    frames, seen = [], [False] * len(room.shown)
    for frame, owner in looks_at(room, seed):
        frames.append(frame)
        for number, one in enumerate(room.shown):
            seen[number] = seen[number] or _is_whole(owner == number, one)
    return frames, seen


def looks_at(room: FurnishedRoom, seed: int) -> Iterator[tuple[Frame, Any]]:
    """Each picture of a room, with the number of the thing that each pixel (h, w) shows; -1 for the room itself."""
    mujoco = load_mujoco()
    model = world_of(room, mujoco).compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    volume = Box(lo_m=(0.0, 0.0, 0.0), hi_m=(*room.size_m, HEIGHT_M))
    scene = Scene(name="furnished", volume=volume, start_m=volume.centre_m)
    owner = _owners(model)
    with SceneRenderer(model, scene, seed=seed) as renderer:
        for i in range(len(room.looks)):
            frame = renderer.capture(data, float(i), f"look-{i}")
            yield frame, owner[renderer.geoms_seen(data, f"look-{i}")]


def _owners(model: Any) -> Any:
    """For each geom, and at the end for none, the number of the thing that it is part of; -1 for the room itself."""
    owner = np.full(model.ngeom + 1, -1, int)
    for i in range(model.ngeom):
        kind, number, *_ = model.geom(i).name.split(":")
        if kind == "shown":
            owner[i] = int(number)
    return owner


def _is_whole(mask: Any, one: Shown) -> bool:
    if int(mask.sum()) < (DOOR_PIXELS if one.kind == "door" else LEAST_PIXELS):
        return False
    inner = mask[NEAR_EDGE:-NEAR_EDGE, NEAR_EDGE:-NEAR_EDGE]
    return bool(inner.sum() == mask.sum())
