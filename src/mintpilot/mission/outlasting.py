"""Flights that would outlast the yes that they count on (method, section 12)."""

from __future__ import annotations

from mintpilot.core.message import message
from mintpilot.core.trajectory import Trajectory
from mintpilot.mission.grants import SPARE_S, leaves_s, without
from mintpilot.mission.transition import Transition


def outlasted(t: Transition, trajectory: Trajectory) -> bool:
    """Whether a flight would still be in a region when the yes for it has run out; then it must not set out.

    Such a region is open again, to be asked about anew; where a new yes would not last either, it counts as blocked.
    """
    mission, beliefs = t.state.setup.mission, t.beliefs
    valid_s, outlived, hopeless = mission.asking.answer_valid_s, set[str](), set[str]()
    leaves = {g.gap: leaves_s(trajectory, beliefs.map, g.gap, mission.limits) for g in beliefs.grants}
    for grant in beliefs.grants:
        left_s = leaves[grant.gap] + SPARE_S
        if leaves[grant.gap] > 0 and t.state.clock_s + left_s > grant.given_s + valid_s:
            (hopeless if left_s > valid_s else outlived).add(grant.gap)
    if not outlived and not hopeless:
        return False
    t.set(beliefs=without(beliefs, frozenset(outlived), blocked=frozenset(hopeless)), fallback=None)
    why = message("The yes counts for {valid_s:.0f} s, and that runs out before the drone is through", valid_s=valid_s)
    then = message("it keeps out") if hopeless else message("it is asked about again")
    t.note("permission", message("{why}: {then}.", why=why, then=then))
    return True
