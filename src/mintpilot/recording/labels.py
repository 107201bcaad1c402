"""Labels on a plot that do not lie on each other."""

from __future__ import annotations

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patheffects import withStroke
from matplotlib.transforms import Bbox

_OFFSETS = [
    (9, 7),
    (-9, 7),
    (9, -7),
    (-9, -7),
    (0, 15),
    (0, -15),
    (16, 0),
    (-16, 0),
    (12, 20),
    (-12, 20),
    (12, -20),
    (-12, -20),
]
"""Places tried around a point, in points of 1/72 inch; the first free one is taken."""
_LETTERS = 30


@dataclass(frozen=True, slots=True, kw_only=True)
class _Label:
    x_m: float
    y_m: float
    text: str
    strong: bool


class Labels:
    """Collects labels and puts each beside its point, where there is room.

    Args:
        axes: the plot; its limits must be set before `draw`.
    """

    def __init__(self, axes: Axes) -> None:
        self._axes = axes
        self._labels: list[_Label] = []

    def add(self, x_m: float, y_m: float, text: str, *, strong: bool) -> None:
        """A label for that point; strong ones are bold and come first."""
        short = text if len(text) <= _LETTERS else text[: _LETTERS - 1] + "…"
        self._labels.append(_Label(x_m=x_m, y_m=y_m, text=short, strong=strong))

    def draw(self) -> None:
        """Puts all labels. Where no place is free a strong label takes the first one; a weak one is left out."""
        canvas = self._axes.figure.canvas
        assert isinstance(canvas, FigureCanvasAgg)
        renderer = canvas.get_renderer()  # type: ignore[no-untyped-call]
        inside = self._axes.get_window_extent(renderer)
        taken: list[Bbox] = []
        for label in sorted(self._labels, key=lambda each: not each.strong):
            text = self._axes.annotate(
                label.text, (label.x_m, label.y_m), xytext=_OFFSETS[0], textcoords="offset points", fontsize=8,
                fontweight="bold" if label.strong else "normal", color="#16202b", zorder=12,
                path_effects=[withStroke(linewidth=2.6, foreground="white")],
            )  # fmt: skip
            for dx, dy in _OFFSETS:
                text.set_position((dx, dy))
                text.set_horizontalalignment("left" if dx > 0 else "right" if dx < 0 else "center")
                text.set_verticalalignment("bottom" if dy > 0 else "top" if dy < 0 else "center")
                place = text.get_window_extent(renderer)
                fits = (
                    inside.x0 <= place.x0 and place.x1 <= inside.x1 and inside.y0 <= place.y0 and place.y1 <= inside.y1
                )
                if fits and not any(place.overlaps(other) for other in taken):
                    taken.append(place)
                    break
            else:
                if label.strong:
                    dx, dy = _OFFSETS[0]
                    text.set(position=(dx, dy), ha="left", va="bottom")
                else:
                    text.remove()


def _within(inner: Bbox, outer: Bbox) -> bool:
    return bool(outer.x0 <= inner.x0 and inner.x1 <= outer.x1 and outer.y0 <= inner.y0 and inner.y1 <= outer.y1)
