"""The stops that a choice under rules is made among, and which of them may come next."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from mintpilot.core.plan import Stop
from mintpilot.planning.itinerary import Itinerary
from mintpilot.planning.legs import Cell3
from mintpilot.planning.selection import picked_for


@dataclass(frozen=True, slots=True, kw_only=True)
class WantedStops:
    """The stops that are chosen among: n of them."""

    stops: tuple[Stop, ...]
    places: tuple[Cell3 | None, ...]
    before: tuple[int, ...]
    """(n,) bit sets of the stops that must come before each."""
    later: tuple[int, ...]
    """(n,) bit sets of those that must not."""

    def next(self, done: int) -> Iterator[tuple[int, Stop, Cell3]]:
        """The stops that may come after those: number, stop, place."""
        for i, (stop, place) in enumerate(zip(self.stops, self.places, strict=True)):
            ready = not self.before[i] & ~done and not done & (self.later[i] | 1 << i)
            if place is not None and ready:
                yield i, stop, place

    def left_s(self, done: int) -> float:
        """Prices of the others, those of optional stops by their chance."""
        return sum(stop.price_s * stop.chance for i, stop in enumerate(self.stops) if not done >> i & 1)


def wanted_stops(itinerary: Itinerary, values: Mapping[str, str], stops: tuple[Stop, ...]) -> WantedStops:
    """These stops, of which the first ones that are not optional keep their order, at the places of those values."""
    ids, ordered = [stop.id for stop in stops], sum(not stop.optional for stop in stops)
    picks = [picked_for(stop, itinerary.ordered) for stop in stops]
    return WantedStops(
        stops=stops,
        places=tuple(itinerary.place(stop, values) for stop in stops),
        before=tuple(0 if pick is None else 1 << ids.index(pick.id) for pick in picks),
        later=tuple((1 << ordered) - (2 << i) if i < ordered else 0 for i in range(len(stops))),
    )
