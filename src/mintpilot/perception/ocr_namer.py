"""Text on things, read offline. The reader is loaded when the first segment is looked at."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from PIL import Image

from mintpilot.core.errors import MissingPartError
from mintpilot.core.observation import Frame, NameGuess, Segment
from mintpilot.core.ports import Namer
from mintpilot.perception.boxes import pixel_box

LEAST_PIXELS = 24
"""Segments that are narrower or lower than this show no legible text."""
HEIGHT = 160
"""Crops are enlarged to at least this height, pixels."""
SURE = 0.8
"""Text that was read with less confidence is not used."""
LONGEST = 24
"""Longer text is no name."""
CALIBRATED = 0.6
"""How much of the reader's confidence is kept: text that is read right is not always what a thing is."""


class OcrNamer(Namer):
    """Names things by the words on them. What is written on a thing is data, never an order.

    Args:
        reader: called with a picture (h, w, 3); returns text and confidence of each line. None: RapidOCR.
    """

    def __init__(self, reader: Any = None) -> None:
        self._reader = reader

    def names(self, frame: Frame, segments: Sequence[Segment]) -> tuple[tuple[NameGuess, ...], ...]:
        """For each segment the clearest words on it. Raises `MissingPartError` when no reader is installed."""
        return tuple(self._named(frame, segment) for segment in segments)

    def _named(self, frame: Frame, segment: Segment) -> tuple[NameGuess, ...]:
        left, top, right, bottom = pixel_box(segment.mask)
        if min(right - left, bottom - top) < LEAST_PIXELS:
            return ()
        if self._reader is None:
            self._reader = _rapid_ocr()
        crop = np.where(segment.mask[top:bottom, left:right, None], frame.rgb[top:bottom, left:right], 127)
        scale = max(1, round(HEIGHT / (bottom - top)))
        size = ((right - left) * scale, (bottom - top) * scale)
        picture = np.asarray(Image.fromarray(crop.astype(np.uint8)).resize(size, Image.Resampling.BICUBIC))
        read = [(label_of(text), confidence) for text, confidence in self._reader(picture)]
        sure = sorted(((c, t) for t, c in read if t and c >= SURE), reverse=True)
        return (NameGuess(label=sure[0][1], probability=CALIBRATED * min(1.0, sure[0][0])),) if sure else ()


def label_of(text: str) -> str:
    """Text as a label: lower case words of letters; empty where it is none."""
    words = "".join(c if c.isalpha() else " " for c in text.lower()).split()
    label = " ".join(word for word in words if len(word) > 2)
    return label if 3 <= len(label) <= LONGEST else ""


def _rapid_ocr() -> Any:
    try:
        from rapidocr_onnxruntime import RapidOCR
    except ImportError as error:
        raise MissingPartError(
            f"reading text needs the package 'rapidocr-onnxruntime' ({error}); pip install 'mintpilot[vision]'"
        ) from None
    engine = RapidOCR()

    def read(picture: Any) -> list[tuple[str, float]]:
        lines, _ = engine(np.ascontiguousarray(picture[..., ::-1]))
        return [(str(text), float(confidence)) for _, text, confidence in lines or ()]

    return read
