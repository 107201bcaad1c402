"""Real pictures that somebody labelled pixel by pixel: things found, split, merged and false on them.

A folder holds ``NAME_color.jpg`` (or ``.png``), ``NAME_depth.png`` (16 bit, millimetres) and ``NAME_label.png``: 0 for
the background, below 10 for what things stand on, and one number for each ten for a thing (10 to 19 are parts of one).
``names.tsv`` may say what the things are: name of the picture, number of the thing (1 for 10 to 19), its names with
commas between them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mintpilot.assembly.sources import open_source
from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Floats
from mintpilot.core.observation import Frame
from mintpilot.core.ports import SourceOptions
from mintpilot.frames.aligned import AlignedFrames
from mintpilot.perception.bodies import bodies_of
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import look_at

FOUND = 0.5
"""A thing is found by a body that overlaps it (intersection over union) by more."""
PART = 0.2
"""Two bodies with more than this share of one thing split it; one with so much of itself in two things merges them."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LabelledFrame:
    """One picture."""

    name: str
    frame: Frame
    things: NDArray[np.int64]
    """Number of the thing that each pixel shows (height, width); 0 for none."""
    names: dict[int, frozenset[str]]
    """Right names of the things, as far as they are given."""

    def names_at(self, pixels: tuple[int, int, int, int]) -> frozenset[str]:
        """Right names of the thing that fills most of a rectangle (left, top, right, bottom); none for background."""
        left, top, right, bottom = pixels
        inside = self.things[top:bottom, left:right]
        counts = np.bincount(inside[inside > 0], minlength=1)
        return (
            self.names.get(int(np.argmax(counts)), frozenset()) if counts.sum() > FOUND * inside.size else frozenset()
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameCounts:
    """What became of the things in some labelled frames."""

    frames: int
    things: int
    found: int
    split: int
    merged: int
    false: int
    mean_iou: float
    overlap_recall: float
    overlap_precision: float


def labelled_frames(folder: Path, only: frozenset[str] | None = None) -> Iterator[LabelledFrame]:
    """The pictures of a folder, by name.

    Args:
        folder: with pictures, depth and labels.
        only: names of the pictures that are wanted; None: all.

    Raises:
        InputError: there is none, or the names cannot be read.
    """
    from PIL import Image

    names = _names(folder / "names.tsv")
    found = sorted(folder.glob("*_label.png"))
    if not found:
        raise InputError(f"'{folder}' has no *_label.png: give a folder of labelled pictures (docs/benchmark.md)")
    for path in found:
        name = path.name.removesuffix("_label.png")
        if only is not None and name not in only:
            continue
        color = next((p for e in ("jpg", "png") if (p := folder / f"{name}_color.{e}").is_file()), None)
        if color is None:
            raise InputError(f"'{path}' has no picture beside it: add {name}_color.jpg")
        options = SourceOptions(color=color, depth=folder / f"{name}_depth.png")
        for frame in AlignedFrames(open_source("", options)):
            label = np.asarray(Image.open(path)).astype(np.int64)
            if label.shape != frame.depth_m.shape:
                raise InputError(
                    f"'{path}' is {label.shape}, its depth {frame.depth_m.shape}: they must be of one size"
                )
            yield LabelledFrame(
                name=name, frame=frame, things=np.where(label >= 10, label // 10, 0), names=names.get(name, {})
            )


def count_frames(frames: Iterator[LabelledFrame]) -> FrameCounts:
    """Counts over labelled frames, by the bodies that perception parts them into."""
    total = Counter[str]()
    overlaps: list[float] = []
    recalls: list[float] = []
    precisions: list[float] = []
    for one in frames:
        masks = [b.mask for b in bodies_of(look_at(one.frame, PerceptionSettings()), 0.0).things]
        kinds = [k for k in np.unique(one.things) if k]
        total["frames"] += 1
        total["things"] += len(kinds)
        if not masks or not kinds:
            total["false"] += len(masks)
            overlaps += [0.0] * len(kinds)
            recalls += [0.0] * len(kinds)
            continue
        shares = np.array([[(m & (one.things == k)).sum() for m in masks] for k in kinds], float)
        areas = np.array([(one.things == k).sum() for k in kinds], float)
        sizes = np.array([m.sum() for m in masks], float)
        iou = shares / (areas[:, None] + sizes[None] - shares)
        total["found"] += int((iou.max(axis=1) > FOUND).sum())
        total["split"] += int(((shares > PART * areas[:, None]).sum(axis=1) > 1).sum())
        total["merged"] += int(((shares > PART * sizes[None]).sum(axis=0) > 1).sum())
        total["false"] += int((iou.max(axis=0) <= FOUND).sum())
        overlaps += iou.max(axis=1).tolist()
        picked, rows = iou.argmax(axis=1), np.arange(len(areas))
        recalls += (shares[rows, picked] / areas).tolist()
        precisions += (shares[rows, picked] / sizes[picked]).tolist()
    return FrameCounts(
        frames=total["frames"],
        things=total["things"],
        found=total["found"],
        split=total["split"],
        merged=total["merged"],
        false=total["false"],
        mean_iou=_mean(overlaps),
        overlap_recall=_mean(recalls),
        overlap_precision=_mean(precisions),
    )


def _mean(values: Floats | list[float]) -> float:
    return float(np.mean(values)) if len(values) else 0.0


def _names(path: Path) -> dict[str, dict[int, frozenset[str]]]:
    if not path.is_file():
        return {}
    found: dict[str, dict[int, frozenset[str]]] = {}
    for number, line in enumerate(path.read_text("utf-8").splitlines(), start=1):
        if not line.strip() or line.startswith("#"):
            continue
        parts = line.split("\t")
        if len(parts) != 3 or not parts[1].strip().isdigit():
            raise InputError(
                f"{path}:{number}: '{line}' must be picture, number of the thing and names, with tabs between"
            )
        labels = frozenset(name.strip().lower() for name in parts[2].split(",") if name.strip())
        found.setdefault(parts[0].strip(), {})[int(parts[1])] = labels
    return found
