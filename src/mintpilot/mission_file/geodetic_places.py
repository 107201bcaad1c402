"""Places of a mission file that are written as latitude and longitude, made into metres on its map."""

from __future__ import annotations

from typing import Any, Final

from pydantic import ValidationError

from mintpilot.core.errors import MapError
from mintpilot.core.georeference import GeodeticPoint, Georeference
from mintpilot.mission_file.schema_world import GeodeticPlaceSpec, GeoreferenceSpec
from mintpilot.mission_file.yaml_places import Fault, Path_

_MARKS: Final = frozenset({"latitude", "longitude"})


def with_local_places(value: dict[str, Any]) -> tuple[dict[str, Any], list[Fault]]:
    """The contents of a mission file with every ``{latitude, longitude}`` as ``[x, y]`` or ``[x, y, z]``.

    Args:
        value: the file as YAML gives it.

    Returns:
        The same with places in metres, and a fault for each that cannot be turned into metres. A georeference of wrong
        form is left to the schema.
    """
    world = value.get("world")
    given = world.get("georeference") if isinstance(world, dict) else None
    reference = None
    if given is not None:
        try:
            reference = georeference_of(GeoreferenceSpec.model_validate(given))
        except (ValidationError, MapError):
            return value, []
    faults: list[Fault] = []
    made = _replaced(value, (), reference, faults)
    return made, faults


def georeference_of(spec: GeoreferenceSpec) -> Georeference:
    """The georeference as core knows it."""
    return Georeference(
        latitude_deg=spec.latitude,
        longitude_deg=spec.longitude,
        altitude_m=spec.altitude_m,
        heading_rad=spec.heading_rad,
    )


def _replaced(value: Any, place: Path_, reference: Georeference | None, faults: list[Fault]) -> Any:
    if isinstance(value, list):
        return [_replaced(entry, (*place, n), reference, faults) for n, entry in enumerate(value)]
    if not isinstance(value, dict):
        return value
    if _MARKS & value.keys() and place != ("world", "georeference"):
        return _metres(value, place, reference, faults)
    return {key: _replaced(entry, (*place, key), reference, faults) for key, entry in value.items()}


def _metres(value: dict[str, Any], place: Path_, reference: Georeference | None, faults: list[Fault]) -> list[float]:
    where = f"latitude {value.get('latitude')}, longitude {value.get('longitude')}"
    try:
        point = GeodeticPlaceSpec.model_validate(value)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(step) for step in first["loc"])
        faults.append(Fault(path=place, line=None, message=f"{where}: {key}: {first['msg']}; degrees, WGS 84"))
        return [0.0, 0.0]
    if reference is None:
        message = f"{where}: the map has no georeference; write metres, or add world.georeference"
        faults.append(Fault(path=place, line=None, message=message))
        return [0.0, 0.0]
    altitude_m = reference.altitude_m if point.altitude_m is None else point.altitude_m
    try:
        x_m, y_m, z_m = reference.local(
            GeodeticPoint(latitude_deg=point.latitude, longitude_deg=point.longitude, altitude_m=altitude_m)
        )
    except MapError as error:
        faults.append(Fault(path=place, line=None, message=str(error)))
        return [0.0, 0.0]
    return [x_m, y_m] if point.altitude_m is None else [x_m, y_m, z_m]
