"""Counts how often names are right, and makes the confidences of namers true by it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from mintpilot.benchmark.labelled_frames import LabelledFrame
from mintpilot.benchmark.perception import owner_of
from mintpilot.benchmark.perception_scenes import pictures_of
from mintpilot.core.observation import Detection
from mintpilot.core.ports import Namer
from mintpilot.perception.calibration import Calibration, LabelScale, fit
from mintpilot.perception.segments import SegmentPerception
from mintpilot.simulation.furnished.room import furnished_room
from mintpilot.simulation.furnished.style import Style


@dataclass(frozen=True, slots=True, kw_only=True)
class NamePair:
    """One name that a namer gave, and whether it was right."""

    label: str
    said: float
    right: bool


def calibrated(namers: Mapping[str, Iterable[NamePair]], made_by: str, *, drawn: bool) -> Calibration:
    """The calibration that makes the confidences of namers true.

    Args:
        namers: by registered name: the names that each gave.
        made_by: the command, for whoever reads the file.
        drawn: in drawn rooms, which lack the look-alikes of real places: no confidence is raised by them.
    """
    found: dict[str, dict[str, LabelScale]] = {}
    for name, pairs in namers.items():
        listed = list(pairs)
        for label in sorted({pair.label for pair in listed}):
            mine = [pair for pair in listed if pair.label == label]
            scale = fit([pair.said for pair in mine], [pair.right for pair in mine])
            if scale is not None:
                found.setdefault(name, {})[label] = scale
    return Calibration(made_by=made_by, only_lowers=drawn, namers=found)


def pairs_in_rooms(namer: Namer, styles: Sequence[Style], scenes: int, seed: int) -> Iterator[NamePair]:
    """What a namer says in furnished rooms, picture by picture.

    Args:
        namer: whose confidences are to be measured, not calibrated yet.
        styles: of the rooms.
        scenes: rooms of each style.
        seed: of the first one; the others follow.
    """
    perception = SegmentPerception(namers=(namer,))
    for style in styles:
        for number in range(seed, seed + scenes):
            room = furnished_room(style, number)
            frames, _ = pictures_of(room, number)
            for index, frame in enumerate(frames):
                for one in perception.detect(frame, index):
                    truth = owner_of(one.position_m, room.shown)
                    yield from _pairs(one, truth.labels if truth is not None else frozenset())


def pairs_in_frames(namer: Namer, frames: Iterable[LabelledFrame]) -> Iterator[NamePair]:
    """What a namer says of a person's own labelled pictures; frames without names are left out."""
    perception = SegmentPerception(namers=(namer,))
    for index, labelled in enumerate(frames):
        if labelled.names:
            for one in perception.detect(labelled.frame, index):
                yield from _pairs(one, labelled.names_at(one.pixels))


def _pairs(one: Detection, right: frozenset[str]) -> Iterator[NamePair]:
    for guess in one.names:
        yield NamePair(label=guess.label, said=guess.probability, right=guess.label in right)
