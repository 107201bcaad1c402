"""What was told, as a monitor reads it: which yes still opens a region, which no and which outline still bars."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from mintpilot.conformance.faults.ledger import Commanded, Ledger, Told
from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.inputs import FactConfirmed, FactUndone
from mintpilot.core.told import KeepOut, RegionBlocked, RegionPassable, Standing, ToldFact

READ_BACK_S: Final = 30.0
"""What is read back counts only if it is confirmed within this time, seconds (method, section 12)."""
SLACK_S: Final = 1.0
"""Between when something was said and when the mission's clock says that it was told, seconds."""
EDGE_M: Final = 1e-6


def blocked(region: str, order: Commanded, ledger: Ledger) -> bool:
    """Whether somebody's word that a region must not be entered still stands when that was commanded."""
    return any(
        isinstance(known.fact, RegionBlocked) and known.fact.region == region and _stands(known, order, ledger)
        for known in ledger.facts.values()
        if known.standing is not Standing.REFUSED
    )


def opened(region: str, order: Commanded, ledger: Ledger, valid_s: float) -> Iterator[float]:
    """When the facts were told that open a region for that command: each confirmed, not taken back and not too old."""
    for known in ledger.facts.values():
        if not isinstance(known.fact, RegionPassable) or known.fact.region != region:
            continue
        events = list(_about(known.id, order, ledger))
        confirmed = [one.time_s for one in events if isinstance(one.event, FactConfirmed)]
        undone = any(isinstance(one.event, FactUndone) for one in events)
        in_time = [at for at in confirmed if known.told_s - SLACK_S <= at <= known.told_s + READ_BACK_S + SLACK_S]
        if in_time and not undone and order.time_s < in_time[0] + valid_s + SLACK_S:
            yield known.told_s


def drawn_over(points: Floats, order: Commanded, ledger: Ledger) -> Bools:
    """Which points (n, 3) of a commanded flight lie in an outline that stands, once the flight is out of it."""
    inside = np.zeros(len(points), bool)
    for known in ledger.facts.values():
        if isinstance(known.fact, KeepOut) and _stands(known, order, ledger):
            here = _within(points[:, :2], np.asarray(known.fact.corners_m, float))
            outside = np.flatnonzero(~here)
            if len(outside):
                here[: outside[0]] = False  # it may leave an outline that was drawn around it
                inside |= here
    return inside


def _stands(known: ToldFact, order: Commanded, ledger: Ledger) -> bool:
    """Whether a fact that adds caution was told before a command, and not taken back and confirmed before it."""
    if known.told_s >= order.time_s:
        return False
    undone_s = None
    for one in _about(known.id, order, ledger):
        if isinstance(one.event, FactUndone) and undone_s is None:
            undone_s = one.time_s
        elif undone_s is not None and isinstance(one.event, FactConfirmed):
            return False
    return True


def _about(name: str, order: Commanded, ledger: Ledger) -> Iterator[Told]:
    for one in ledger.told[: order.told]:
        if one.time_s <= order.time_s and not hasattr(one.event, "fact") and one.event.told == name:
            yield one


def _within(places: Floats, corners: Floats) -> Bools:
    """Which places (n, 2) lie inside of an outline, by the even-odd rule; its edge does not count."""
    odd = np.zeros(len(places), bool)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if ay == by:
            continue
        crosses = (ay > places[:, 1]) != (by > places[:, 1])
        at = ax + (places[:, 1] - ay) / (by - ay) * (bx - ax)
        odd ^= crosses & (places[:, 0] < at - EDGE_M)
    return odd
