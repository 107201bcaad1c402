"""Three questions as the drone would ask them."""

from __future__ import annotations

from mintpilot.benchmark.language_cases import QUESTIONS

SMOKE, ROOM, BOX = QUESTIONS["smoke"], QUESTIONS["room"], QUESTIONS["box"]
SMOKE_GAP, ROOM_GAP, BOX_GAP = SMOKE.gaps[0], ROOM.gaps[0], BOX.gaps[0]
