"""The map of an earlier mission, to begin another one with: no permission is taken over (method, section 12)."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from mintpilot.assembly.retelling import retold
from mintpilot.core.errors import RecordError
from mintpilot.core.events import Event
from mintpilot.core.message import Message, message
from mintpilot.core.query import Question
from mintpilot.core.semantic_map import Knowledge, Region, SemanticMap
from mintpilot.core.told import PREFIX
from mintpilot.recording.event_log import read_event_log

_DRAWN = "drawn-earlier-"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EarlierMap:
    """What an earlier mission knew of the place."""

    map: SemanticMap
    """Everything uncertain in it is open again."""
    run: Path
    age_s: float
    """Since it was last drawn, seconds."""

    @property
    def words(self) -> Message:
        """For whoever watches."""
        return message(
            "It begins with the map of {run}, which is {age} old. What was free then is looked at again as it comes "
            "into view; what was permitted then is asked about again.",
            run=self.run.name,
            age=in_words(self.age_s),
        )


def earlier_map(run: Path, *, now_s: float | None = None) -> EarlierMap:
    """The last map of a recorded mission.

    Args:
        run: the run folder.
        now_s: seconds since 1970; default: the present time.

    Raises:
        RecordError: it cannot be read, is damaged, is of another version, or holds no map.
    """
    log, last = read_event_log(run), [0.0]

    def events() -> Iterator[Event]:
        for logged in log:
            last[0] = logged.at_s
            yield logged.event

    found, at_s = None, 0.0
    for state in retold(events(), _Nobody()):
        if state.beliefs is not None and state.beliefs.map is not found:
            found, at_s = state.beliefs.map, last[0]
    if found is None:
        raise RecordError(f"{run}: that mission was over before it had a map: give another run folder")
    age_s = max(0.0, (time.time() if now_s is None else now_s) - at_s)
    return EarlierMap(map=without_permissions(found), run=run, age_s=age_s)


def without_permissions(map: SemanticMap) -> SemanticMap:
    """The map with everything open again that somebody has said of its regions and rooms.

    What was drawn to keep out of stays a region: it is entered only after an explicit yes.
    """
    rooms = tuple(replace(room, occupied=Knowledge.OPEN, searched=False, best_view=None) for room in map.rooms)
    objects = tuple(replace(thing, best_view=None) for thing in map.objects)
    numbers = [int(r.id.removeprefix(_DRAWN)) for r in map.regions if r.id.startswith(_DRAWN)]
    regions, last = [], max(numbers, default=0)
    for region in map.regions:
        last += region.id.startswith(PREFIX)
        regions.append(_open(region, f"{_DRAWN}{last}"))
    return replace(map, objects=objects, regions=tuple(regions), rooms=rooms)


def in_words(age_s: float) -> Message:
    """An age as people say it: ``18 hours``."""
    days, hours, minutes = (int(age_s // unit_s) for unit_s in (86400.0, 3600.0, 60.0))
    if days:
        return message("1 day") if days == 1 else message("{count} days", count=days)
    if hours:
        return message("1 hour") if hours == 1 else message("{count} hours", count=hours)
    if minutes:
        return message("1 minute") if minutes == 1 else message("{count} minutes", count=minutes)
    return message("less than a minute")


def _open(region: Region, drawn_name: str) -> Region:
    drawn = region.id.startswith(PREFIX)
    name = drawn_name if drawn else region.id
    words = "the region that was drawn earlier" if drawn else region.description
    return replace(region, id=name, passable=Knowledge.OPEN, description=words, best_view=None)


class _Nobody:
    """Watches nothing."""

    def record(self, event: Event) -> None: ...

    def show(self, question: Question, patience_s: float) -> None: ...

    def withdraw(self, question: str, why: str) -> None: ...

    def tell(self, text: str) -> None: ...
