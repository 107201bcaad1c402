"""Camera pictures for browsers: the latest one, and those that show what a question is about."""

from __future__ import annotations

import io
from collections import OrderedDict
from collections.abc import Callable

import numpy as np

from mintpilot.console.board import Panes
from mintpilot.console.protocol import PictureBox, PicturePane
from mintpilot.core.events import FrameSeen, ViewTaken
from mintpilot.core.geometry import Floats
from mintpilot.core.query import Question
from mintpilot.core.semantic_map import SemanticMap

MOST_KEPT = 1000
"""Pictures kept as JPEG; the oldest are thrown away first."""
MOST_SHOWN = 4
"""Pictures shown beside one question."""
STILL = 0.05
"""A camera that has moved by less than this, metres, or turned by about as many radians, shows the same."""
_QUALITY = 80


def as_jpeg(event: FrameSeen | ViewTaken) -> bytes:
    """The picture that was just taken."""
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(event.frame.rgb).save(out, "JPEG", quality=_QUALITY)
    return out.getvalue()


class Pictures:
    """Keeps the pictures of one mission as JPEG.

    Args:
        board: where they are shown.
        jpeg_of: the picture of an event; None: there is none any more.
    """

    def __init__(self, board: Panes, jpeg_of: Callable[[FrameSeen], bytes | None] = as_jpeg) -> None:
        self._board, self._jpeg_of = board, jpeg_of
        self._kept: OrderedDict[int, tuple[float, bytes]] = OrderedDict()
        self._last: tuple[Floats, PicturePane] | None = None

    def seen(self, event: FrameSeen) -> None:
        """A new picture, with what was found in it."""
        jpeg = self._jpeg_of(event)
        if jpeg is None:
            return
        self._kept[event.index] = (event.frame.time_s, jpeg)
        if len(self._kept) > MOST_KEPT:
            self._kept.popitem(last=False)
        boxes = tuple(
            PictureBox(id="", words=d.label, box=_box(d.pixels)) for d in event.detections if d.pixels[2] > d.pixels[0]
        )
        pane = PicturePane(frame=event.index, time_s=round(event.frame.time_s, 2), boxes=boxes)
        self._last = (event.frame.world_from_camera, pane)
        self._board.put("camera", pane, jpeg)

    def viewed(self, event: ViewTaken) -> None:
        """A picture between two of those; what was found is still outlined while the camera is where it was."""
        frame, index = event.frame, -1
        boxes: tuple[PictureBox, ...] = ()
        if self._last is not None:
            where, pane = self._last
            index = pane.frame
            if float(np.abs(frame.world_from_camera - where).max()) < STILL:
                boxes = pane.boxes
        pane = PicturePane(frame=index, time_s=round(frame.time_s, 2), boxes=boxes)
        self._board.put("camera", pane, as_jpeg(event))

    def about(self, question: Question, map: SemanticMap | None) -> None:
        """The pictures in which the things are that the question is about, with their outlines."""
        by_frame: dict[int, list[PictureBox]] = {}
        for gap in question.gaps if map is not None else ():
            for name, words, _ in gap.spots:
                view = map.best_view(name) if map is not None else None
                if view is not None and view[0] in self._kept:
                    box = PictureBox(id=name, words=words, box=_box(view[1:]))
                    by_frame.setdefault(view[0], []).append(box)
        shown = sorted(by_frame.items(), key=lambda item: -len(item[1]))[:MOST_SHOWN]
        for number in range(MOST_SHOWN):
            if number < len(shown):
                frame, boxes = shown[number]
                time_s, jpeg = self._kept[frame]
                pane = PicturePane(frame=frame, time_s=round(time_s, 2), boxes=tuple(boxes), question=question.id)
                self._board.put(f"evidence-{number}", pane, jpeg)
            else:
                self._board.put(f"evidence-{number}", PicturePane(frame=-1, time_s=0.0))

    def clear(self) -> None:
        """Nothing is asked about."""
        for number in range(MOST_SHOWN):
            self._board.put(f"evidence-{number}", PicturePane(frame=-1, time_s=0.0))


def _box(pixels: tuple[int, ...]) -> tuple[float, float, float, float]:
    left, top, right, bottom = (float(x) for x in pixels)
    return (left, top, right, bottom)
