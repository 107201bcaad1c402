"""Colours and sizes in plain words."""

from __future__ import annotations

import numpy as np

from mintpilot.perception.view import Singles

_HUES = (
    (12.0, "red"),
    (40.0, "orange"),
    (72.0, "yellow"),
    (170.0, "green"),
    (258.0, "blue"),
    (325.0, "purple"),
    (361.0, "red"),
)
"""Upper ends of the hues, degrees."""
BLACK_BELOW = 48.0
"""Value below which everything is black."""
GREY_BELOW = 0.17
"""Saturation below which a colour has no hue."""
WHITE_ABOVE = 150.0
"""Value above which what has no hue is white …"""
WHITE_FROM = 1.3
"""… as it is in a dim hall from this multiple of the floor's value on …"""
WHITE_LEAST = 90.0
"""… if not below this value."""
BROWN_BELOW = 175.0
"""Value below which orange is brown."""
SMALL_BELOW_M = 0.4
LARGE_FROM_M = 0.65


def colour_word(hue: Singles, saturation: Singles, value: Singles, *, floor_value: float = np.inf) -> str:
    """What most people would call the colour of these pixels (n,): the most frequent of the lit half of them.

    Args:
        hue: degrees.
        saturation: 0 to 1.
        value: 0 to 255.
        floor_value: median value of the grey floor in the same light; infinite where it is not in view.
    """
    lit = value >= np.median(value)
    white_above = min(WHITE_ABOVE, max(WHITE_LEAST, WHITE_FROM * floor_value))
    words = colour_words(hue[lit], saturation[lit], value[lit], white_above=white_above)
    words, counts = np.unique(words, return_counts=True)
    return str(words[int(np.argmax(counts))])


def colour_words(
    hue: Singles, saturation: Singles, value: Singles, *, white_above: float = WHITE_ABOVE
) -> np.ndarray[tuple[int, ...], np.dtype[np.str_]]:
    """The colour word of each pixel, in the shape of the input."""
    ends = np.array([end for end, _ in _HUES])
    names = np.array([name for _, name in _HUES])
    words = names[np.minimum(np.searchsorted(ends, hue, side="right"), len(names) - 1)]
    words = np.where((words == "orange") & ((value < BROWN_BELOW) | (saturation < 0.6)), "brown", words)
    no_hue = saturation < GREY_BELOW
    words = np.where(no_hue, np.where(value > white_above, "white", "grey"), words)
    return np.where((value < BLACK_BELOW) & (saturation < 0.55), "black", words)


def size_word(longest_m: float) -> str:
    """``small``, ``medium`` or ``large`` by the longest edge."""
    if longest_m < SMALL_BELOW_M:
        return "small"
    return "medium" if longest_m < LARGE_FROM_M else "large"
