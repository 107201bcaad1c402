"""Pictures with a numbered mark on each segment, for models that are asked about segments by number."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from scipy import ndimage

from mintpilot.core.observation import Frame, Segment
from mintpilot.perception.morphology import eroded

WIDTH = 960
"""Smaller pictures are enlarged to about this width, pixels: marks must not cover small things."""
_INKS = ((230, 25, 75), (0, 130, 200), (60, 180, 75), (245, 130, 48), (145, 30, 180), (0, 128, 128))


def marked_png(frame: Frame, segments: Sequence[Segment]) -> bytes:
    """The picture as PNG with the outline of each segment and its number, from 1, at its middle.

    Args:
        frame: the picture.
        segments: what is marked, in the order of the numbers.
    """
    scale = max(1, round(WIDTH / frame.camera.width))
    picture = np.kron(frame.rgb, np.ones((scale, scale, 1), np.uint8))
    for number, segment in enumerate(segments):
        mask = np.kron(segment.mask, np.ones((scale, scale), bool))
        picture[mask & ~eroded(mask, 2)] = _INKS[number % len(_INKS)]
    image = Image.fromarray(picture)
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(size=18)
    for number, segment in enumerate(segments, start=1):
        distance = ndimage.distance_transform_edt(np.pad(segment.mask, 1))[1:-1, 1:-1]
        row, column = np.unravel_index(int(np.argmax(distance)), distance.shape)
        x, y = (int(column) + 0.5) * scale, (int(row) + 0.5) * scale
        left, top, right, bottom = draw.textbbox((x, y), str(number), font=font, anchor="mm")
        draw.rectangle((left - 3, top - 2, right + 3, bottom + 2), fill=_INKS[(number - 1) % len(_INKS)])
        draw.text((x, y), str(number), font=font, anchor="mm", fill=(255, 255, 255))
    data = io.BytesIO()
    image.save(data, "PNG")
    return data.getvalue()
