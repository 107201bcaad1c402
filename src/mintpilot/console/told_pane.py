"""What operators told the drone of their own accord, for the page."""

from __future__ import annotations

from typing import Final

from mintpilot.console.protocol import ToldLine, ToldPane
from mintpilot.core.events import FactsChanged
from mintpilot.core.told import Fact, KeepOut, RegionBlocked, RegionPassable, RoomSearched, ThisOne
from mintpilot.wording.speech import Speech

_NAMES: Final[dict[type[Fact], str]] = {
    KeepOut: "keep-out",
    RegionBlocked: "blocked",
    RegionPassable: "passable",
    RoomSearched: "searched",
    ThisOne: "this-one",
}


def told_pane(event: FactsChanged, speech: Speech) -> ToldPane:
    """All facts with their standing; what they speak of in that language."""
    return ToldPane(
        told=tuple(
            ToldLine.model_validate(
                {
                    "id": known.id,
                    "fact": _NAMES[type(known.fact)],
                    "words": speech.thing(known.words),
                    "who": known.operator,
                    "time_s": round(known.told_s, 1),
                    "standing": known.standing.value,
                    "why": speech(known.why),
                    "corners": known.fact.corners_m if isinstance(known.fact, KeepOut) else (),
                }
            )
            for known in event.told
        )
    )
