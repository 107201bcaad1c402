"""What waiting for an answer may lose: the battery runs while a person thinks (method, section 10)."""

from __future__ import annotations

import math

from mintpilot.core.mission import AskingSettings
from mintpilot.core.plan import Plan, VehicleLimits

SETTLING_S = 0.5
"""Besides braking, so much is kept for setting out anew from between two cells, seconds."""


def spare_s(plan: Plan, limits: VehicleLimits) -> float:
    """How much later a plan may begin and still fit the battery with reserve and way home; below 0: it never fits.

    Args:
        plan: from where the drone is.
        limits: of the vehicle, its endurance that which is left.
    """
    return limits.endurance_s - limits.reserve_s - plan.cost_s - plan.home_s


def longest_wait_s(cautious: Plan | None, limits: VehicleLimits) -> float:
    """How long the drone may wait until the cautious plan must begin, seconds.

    Braking is taken off: it may be under way when the time is over. Infinite where there is no such plan.
    """
    if cautious is None:
        return math.inf
    return max(0.0, spare_s(cautious, limits) - braking_s(limits) - SETTLING_S)


def braking_s(limits: VehicleLimits) -> float:
    """From cruise speed to rest, seconds."""
    return limits.cruise_mps / limits.max_acceleration_mps2


def in_time(wait_s: float, settings: AskingSettings) -> float:
    """Probability that an answer is there after so long, of one that comes within the patience at all.

    The delay is not known but for its mean ``settings.reply_s``: exponential.
    """
    if settings.reply_s == 0 or wait_s >= settings.patience_s:
        return 1.0
    return -math.expm1(-max(0.0, wait_s) / settings.reply_s) / -math.expm1(-settings.patience_s / settings.reply_s)
