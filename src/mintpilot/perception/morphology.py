"""Growing and shrinking of masks by steps to the four neighbours: scipy's binary morphology, ten times as fast.

Beyond the picture nothing is set, as in scipy: what touches the border shrinks there too.
"""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Bools


def dilated(mask: Bools, steps: int) -> Bools:
    """The mask (h, w) grown by so many steps."""
    grown = mask
    for _ in range(steps):
        before, grown = grown, grown.copy()
        grown[1:] |= before[:-1]
        grown[:-1] |= before[1:]
        grown[:, 1:] |= before[:, :-1]
        grown[:, :-1] |= before[:, 1:]
    return grown


def eroded(mask: Bools, steps: int) -> Bools:
    """The mask (h, w) shrunk by so many steps."""
    grown = dilated(~np.pad(mask, steps), steps)
    inside = slice(steps, -steps or None)
    return ~grown[inside, inside]


def closed(mask: Bools, steps: int) -> Bools:
    """Grown, then shrunk: narrow gaps are filled."""
    return eroded(dilated(mask, steps), steps)


def opened(mask: Bools, steps: int) -> Bools:
    """Shrunk, then grown: narrow parts are gone."""
    return dilated(eroded(mask, steps), steps)
