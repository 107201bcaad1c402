"""A small room to fly in."""

import numpy as np

from mintpilot.core.geometry import Box, GridFrame
from mintpilot.vehicle.envelope import SafetyEnvelope

FRAME = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=(15, 50, 50))
PAD = (2.0, 2.0, 1.5)


def room(*, landable: bool | str = True, outdoors: bool = False, tallest_m: float | None = 2.0) -> SafetyEnvelope:
    """10 m by 10 m by 3 m, with the pad at (2, 2). ``landable="west"``: only where x is below 5."""
    cells = np.full(FRAME.shape, landable is not False)
    if landable == "west":
        cells[:, :, 25:] = False
    return SafetyEnvelope(
        volume=Box(lo_m=(0.0, 0.0, 0.0), hi_m=(10.0, 10.0, 3.0)),
        hover_m=PAD,
        ground_m=0.0,
        frame=FRAME,
        landable=cells,
        tallest_m=tallest_m,
        outdoors=outdoors,
    )
