"""Large maps cut to what can be reached."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from mintpilot.core.errors import LimitError
from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.mapping import reachable
from mintpilot.mapping.reachable import cropped, in_part


@pytest.fixture(autouse=True)
def nothing_is_small(monkeypatch):
    monkeypatch.setattr(reachable, "SMALL_CELLS", 0)


def world(seed: int, shape: tuple[int, int, int]) -> SemanticMap:
    rng = np.random.default_rng(seed)
    cells = rng.choice([Cell.FREE, Cell.OCCUPIED, Cell.UNKNOWN], p=[0.6, 0.3, 0.1], size=shape).astype(np.uint8)
    return SemanticMap(frame=GridFrame(origin_m=(-3.0, 5.0, 0.0), resolution_m=0.5, shape=shape), cells=cells)


@pytest.mark.long
@settings(deadline=None, max_examples=50)
@given(seed=st.integers(0, 10**6), flat=st.booleans(), spare=st.floats(0.0, 2.0))
def test_all_that_can_be_reached_is_kept_with_its_rim(seed, flat, spare):
    map = world(seed, (1, 25, 30) if flat else (6, 12, 14))
    free = np.argwhere(map.cells == Cell.FREE)
    start = free[seed % len(free)]
    part = cropped(map, [tuple(map.frame.centres_of(start)[0])], spare)
    labels, _ = ndimage.label(map.cells == Cell.FREE)
    joined = np.argwhere(labels == labels[tuple(start)])
    centres = map.frame.centres_of(joined)
    inside = part.frame.cells_of(centres)
    assert part.frame.contains(inside).all()
    assert (part.cells[tuple(inside.T)] == Cell.FREE).all()
    rim = np.array([-1, 1])[:, None] * np.array([spare, spare, 0 if flat else spare])
    around = np.concatenate([centres + off for off in rim])
    known = map.frame.contains(map.frame.cells_of(around))
    assert part.frame.contains(part.frame.cells_of(around[known])).all()
    everywhere = part.frame.centres_of(np.argwhere(np.ones(part.frame.shape, bool)))
    assert (part.cells.ravel() == map.cells[tuple(map.frame.cells_of(everywhere).T)]).all()


def test_regions_keep_their_places():
    map = world(1, (1, 20, 20))
    block = np.zeros(map.frame.shape, bool)
    block[0, 4:9, 5:7] = True
    region = Region(id="r", kind=RegionKind.AREA, cells=np.flatnonzero(block))
    part = reachable._part(map, np.array([0, 6, 3]), np.array([1, 20, 6]))
    centres = part.frame.centres_of(
        np.stack(np.unravel_index(in_part(region, map, part).cells, part.frame.shape), axis=1)
    )
    expected = map.frame.centres_of(np.argwhere(block[:, 6:9, 5:6]) + np.array([0, 6, 5]))
    assert centres == pytest.approx(expected)


def test_too_much_that_can_be_reached_is_cut_around_the_places(monkeypatch):
    monkeypatch.setattr(reachable, "MAX_CELLS", 400)
    cells = np.full((1, 100, 100), Cell.FREE, np.uint8)
    map = SemanticMap(frame=GridFrame(origin_m=(0, 0, 0), resolution_m=1.0, shape=cells.shape), cells=cells)
    places = [(50.5, 50.5, 0.5), (55.5, 52.5, 0.5)]
    part = cropped(map, places, 0.0)
    assert 300 < part.frame.size <= 400
    assert part.frame.contains(part.frame.cells_of(np.array(places))).all()
    with pytest.raises(LimitError, match="more than the 400 that are planned on; cut the map"):
        cropped(map, [*places, (5.5, 5.5, 0.5)], 0.0)
