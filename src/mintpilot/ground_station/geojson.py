"""A flight plan as GeoJSON (RFC 7946), for maps of any kind."""

from __future__ import annotations

import json

from mintpilot.core.georeference import GeodeticPoint
from mintpilot.ground_station.flight_plan import FlightPlan


def geojson_text(plan: FlightPlan) -> str:
    """The way as a line, its items as points, the fence as a polygon; altitudes are metres above home."""
    flown = [item.place for item in plan.items if item.place is not None]
    features: list[dict[str, object]] = [
        _feature({"type": "LineString", "coordinates": [_position(place) for place in flown]}, {"what": "way"})
    ]
    place = plan.home
    for number, item in enumerate(plan.items, start=1):
        place = item.place or place
        properties: dict[str, object] = {
            "what": item.kind.value,
            "number": number,
            "hold_s": item.hold_s,
            "altitude_m": place.altitude_m,
        }
        features.append(_feature({"type": "Point", "coordinates": _position(place)}, properties))
    if plan.fence:
        ring = [[longitude, latitude] for latitude, longitude in (*plan.fence, plan.fence[0])]
        features.append(_feature({"type": "Polygon", "coordinates": [ring]}, {"what": "fence"}))
    return json.dumps({"type": "FeatureCollection", "features": features}, indent=1) + "\n"


def _position(place: GeodeticPoint) -> list[float]:
    return [place.longitude_deg, place.latitude_deg, place.altitude_m]


def _feature(geometry: dict[str, object], properties: dict[str, object]) -> dict[str, object]:
    return {"type": "Feature", "geometry": geometry, "properties": properties}
