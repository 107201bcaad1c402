"""Expert knowledge into a new map: what the answers have made known of regions and rooms (method, section 6)."""

from __future__ import annotations

from mintpilot.core.gap import PASSABLE, PRESENT, Belief, obstacle_id, presence_id
from mintpilot.core.mission import AskingSettings
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.core.tolerances import ROUNDING


def apply_knowledge(
    map: SemanticMap, belief: Belief, confirmed: frozenset[str], settings: AskingSettings
) -> SemanticMap:
    """The map with every open region and room settled of which the belief is sure enough.

    A region becomes ``YES`` only when its posterior of being passable is at least ``1 - alpha_safe`` *and* an explicit
    yes was given for it, and ``NO`` when that posterior is at most ``alpha_safe``; a room becomes ``YES`` or ``NO``
    from a posterior of ``1 - alpha`` on. All else stays as it was. This is the only function that grants ``YES`` to a
    region (method, section 6).

    Args:
        map: what is known so far.
        belief: joint distribution over the open gaps; regions and rooms without a gap in it stay as they are.
        confirmed: ids of obstacle gaps that got an explicit yes.
        settings: gives ``alpha_safe`` and ``alpha``.
    """
    known = {gap.id for gap in belief.gaps}
    for region in map.regions:
        gap_id = obstacle_id(region.id)
        if region.passable is not Knowledge.OPEN or gap_id not in known:
            continue
        passable = belief.probability_of(gap_id, PASSABLE)
        # Sums of many terms: a posterior that is 1 but for rounding must count as 1, also with alpha_safe = 0.
        if passable >= 1 - settings.alpha_safe - ROUNDING and gap_id in confirmed:
            map = map.with_region(region.id, Knowledge.YES)
        elif passable <= settings.alpha_safe + ROUNDING:
            map = map.with_region(region.id, Knowledge.NO)
    for room in map.rooms:
        gap_id = presence_id(room.id)
        if room.occupied is not Knowledge.OPEN or gap_id not in known:
            continue
        present = belief.probability_of(gap_id, PRESENT)
        if present >= 1 - settings.alpha - ROUNDING:
            map = map.with_room(room.id, occupied=Knowledge.YES)
        elif present <= settings.alpha + ROUNDING:
            map = map.with_room(room.id, occupied=Knowledge.NO)
    return map
