"""The lattice of voxels, at its edges and far beyond."""

from __future__ import annotations

import numpy as np
import pytest

from mintpilot.core.geometry import GridFrame

FRAME = GridFrame(origin_m=(-1.0, 0.0, 0.0), resolution_m=0.2, shape=(3, 5, 10))


@pytest.mark.parametrize("far_m", [1e9, 9.3e18, 1e300, np.inf])
def test_places_however_far_are_outside(far_m: float) -> None:
    cells = FRAME.cells_of(
        [(far_m, 0.1, 0.1), (-far_m, 0.1, 0.1), (0.1, far_m, 0.1), (0.1, 0.1, -far_m), (-0.9, 0.1, 0.1)]
    )
    assert FRAME.contains(cells).tolist() == [False, False, False, False, True]


def test_cells_and_centres_are_inverse() -> None:
    cells = np.argwhere(np.ones(FRAME.shape, bool))
    assert (FRAME.cells_of(FRAME.centres_of(cells)) == cells).all()
