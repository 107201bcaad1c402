"""How far a yes for a region reaches: the outline that was shown, for so long (method, section 12)."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np
from scipy import ndimage

from mintpilot.core.gap import Belief, obstacle_id
from mintpilot.core.geometry import Bools, GridFrame, Ints
from mintpilot.core.mission import AskingSettings
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.core.trajectory import Trajectory
from mintpilot.mission.belief_state import BeliefState, Grant
from mintpilot.planning.flyable import region_reach

SPARE_S = 1.0
"""A flight must be out of a region so long before the yes for it runs out, seconds."""
MARGIN_VOXELS = 1
"""A permission covers the outline that was shown, grown by this many voxels."""


def granted(state: BeliefState, gaps: Collection[str], shown: SemanticMap, now_s: float) -> BeliefState:
    """The state after an explicit yes for these obstacle gaps, or after a look that saw them passable.

    Args:
        state: with the gaps among ``confirmed``, or known to be passable on its map.
        gaps: ids of obstacle gaps.
        shown: the map of which the question spoke, or that the look drew.
        now_s: mission clock.
    """
    outlines = {obstacle_id(region.id): region.cells for region in shown.regions}
    fresh = [Grant(gap=gap, cells=outlines[gap], given_s=now_s) for gap in gaps if gap in outlines]
    kept = [grant for grant in state.grants if grant.gap not in gaps]
    return replace(state, grants=tuple(sorted([*kept, *fresh], key=lambda grant: grant.gap)))


def reopened(
    state: BeliefState, settings: AskingSettings, now_s: float, *, known: frozenset[str] = frozenset()
) -> BeliefState:
    """The state without the permissions that have aged or whose regions have outgrown what was shown.

    Their gaps are open again with their prior, and so is every region that a map calls passable though nobody has said
    so of it. The same state where nothing changes.

    Args:
        state: of the beliefs.
        settings: how long answers count.
        now_s: mission clock.
        known: obstacle gaps of regions that were known to be passable before anybody was asked.
    """
    grants = {grant.gap: grant for grant in state.grants}
    void: set[str] = set()
    for region in state.map.regions:
        gap = obstacle_id(region.id)
        grant = grants.get(gap)
        if grant is None:
            unfounded = region.passable is Knowledge.YES and gap not in known
        else:
            unfounded = not covers(grant.cells, region.cells, state.map.frame)
        if unfounded:
            void.add(gap)
    void |= {gap for gap, grant in grants.items() if now_s >= grant.given_s + settings.answer_valid_s}
    return without(state, frozenset(void)) if void else state


def leaves_s(trajectory: Trajectory, map: SemanticMap, gap: str, limits: VehicleLimits) -> float:
    """When the body is last in a region on a flight, seconds from its beginning; 0 where it never is."""
    cells = map.frame.cells_of(trajectory.position_m)
    if map.frame.is_flat:
        cells[:, 0] = 0
    flat = np.ravel_multi_index(tuple(np.clip(cells, 0, np.array(map.frame.shape) - 1).T), map.frame.shape)
    for region in map.regions:
        if obstacle_id(region.id) == gap:
            inside = np.flatnonzero(np.isin(flat, region_reach(map, region, limits)))
            return float(trajectory.time_s[inside[-1]]) if len(inside) else 0.0
    return 0.0


def covers(outline: Ints, cells: Ints, frame: GridFrame) -> bool:
    """Whether all cells lie within the outline, grown by `MARGIN_VOXELS`."""
    if np.array_equal(outline, cells):
        return True
    allowed: Bools = np.zeros(frame.shape, bool)
    allowed.ravel()[outline] = True
    grown = ndimage.binary_dilation(allowed, np.ones((3, 3, 3), bool), MARGIN_VOXELS)
    return bool(grown.ravel()[cells].all())


def without(state: BeliefState, gaps: frozenset[str], *, blocked: frozenset[str] = frozenset()) -> BeliefState:
    """The state without the permissions for these gaps: they are open again, or count as blocked."""
    map = state.map
    for region in map.regions:
        if obstacle_id(region.id) in blocked:
            map = map.with_region(region.id, Knowledge.NO)
        elif obstacle_id(region.id) in gaps and region.passable is Knowledge.YES:
            map = map.with_region(region.id, Knowledge.OPEN)
    gaps |= blocked
    factors = tuple(f for f in state.belief.factors if not any(gap.id in gaps for gap in f.gaps))
    return replace(
        state,
        map=map,
        belief=Belief(factors=factors),
        confirmed=state.confirmed - gaps,
        grants=tuple(grant for grant in state.grants if grant.gap not in gaps),
        asked=tuple(one for one in state.asked if not gaps & set(one.query.gap_ids)),
    )
