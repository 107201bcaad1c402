"""Worlds of a mission file: a scenario by name, an explicit scene, or a map that others made."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Discriminator, Field, Tag

from mintpilot.mission_file.schema_base import (
    Attributes,
    BoxSpec,
    Described,
    Name,
    NotNegative,
    Place,
    Point2,
    Point3,
    Positive,
    Probability,
    Several,
    Spec,
    Words,
    in_english,
)
from mintpilot.mission_file.schema_scene import SceneSpec

Passability: TypeAlias = Literal["passable", "blocked"]
Occupancy: TypeAlias = Literal["present", "absent"]


class GeoreferenceSpec(Spec):
    """Where the map lies on the earth (WGS 84). Places may then be written as `{latitude, longitude, altitude_m}`."""

    latitude: Annotated[float, Field(ge=-90, le=90)]
    """Of the map's origin, degrees."""
    longitude: Annotated[float, Field(ge=-180, le=180)]
    """Of the map's origin, degrees."""
    altitude_m: float = 0.0
    """Of z = 0, metres above mean sea level."""
    heading_rad: float = 0.0
    """Compass direction of the map's y axis, radians clockwise from true north."""


class GeodeticPlaceSpec(Spec):
    """A place on the earth (WGS 84)."""

    latitude: Annotated[float, Field(ge=-90, le=90)]
    """Degrees."""
    longitude: Annotated[float, Field(ge=-180, le=180)]
    """Degrees."""
    altitude_m: float | None = None
    """Metres above mean sea level. Default: as with `[x, y]`."""


class ScenarioWorld(Spec):
    """A world drawn by one of the built-in generators."""

    scenario: Literal["fire-warehouse", "medicine-boxes"]
    """Name of the generator."""
    parameters: dict[Name, bool | int | float | str] = Field(default_factory=dict)
    """The generator's own settings; those not named keep their defaults."""
    seed: Annotated[int, Field(ge=0)] | None = None
    """Draws the same world again; `--seed` overrides it. Default: 0."""
    georeference: GeoreferenceSpec | None = None
    """Where it lies on the earth; default: nowhere, all places are metres."""


class SceneWorld(Spec):
    """A world that is written down solid by solid, for the simulators."""

    scene: SceneSpec
    """What is really there."""
    seed: Annotated[int, Field(ge=0)] | None = None
    """For the looks, the sensor noise and the scripted operator; `--seed` overrides it. Default: 0."""
    georeference: GeoreferenceSpec | None = None
    """Where it lies on the earth; default: nowhere, all places are metres."""


class RegionSpec(Spec):
    """A place that is passable or not as a whole. Give its outline as exactly one of `box`, `polygon` and `mask`."""

    id: Name
    """Unique name, e.g. `smoke-1`. With a mask of several areas: `NAME-1`, `NAME-2` and so on."""
    description: Described
    """What the operator can see, with its article: `the grey smoke near the gate`."""
    kind: Literal["smoke", "door", "area"] = "area"
    """What it is."""
    box: BoxSpec | None = None
    """Outline as a box."""
    polygon: Annotated[Several[Point2], Field(min_length=3)] | None = None
    """Outline as corners [x, y] in order, at all heights unless `heights_m` says otherwise."""
    heights_m: Point2 | None = None
    """Lowest and highest z of the polygon, metres."""
    mask: Words | None = None
    """Outline as a picture, such as a keep-out mask: dark pixels are in it; each connected area is a region."""
    prior_passable: Probability | None = None
    """Probability that it is passable, before any answer. Default: `priors.passable`."""
    passable: bool | None = None
    """A known fact: true or false. Without it the region is a knowledge gap."""
    truth: Passability | None = None
    """What a scripted operator knows; never used to plan."""


class NormalSpec(Spec):
    """A normal distribution, cut off at the ends of the range."""

    mean: NotNegative
    """Metres."""
    sigma: Positive
    """Standard deviation, metres."""


class ValueSpec(Spec):
    """An ordered value of a region that decides where it can be flown through."""

    id: Name
    """Unique name, e.g. `gap-width`."""
    of: Name
    """Id of the region that is measured. That region gives no fact, prior or truth of its own."""
    what: Literal["clearance_m", "ceiling_m"]
    """`clearance_m`: how wide the passage is. `ceiling_m`: how high the lower edge of the smoke is above the map's
    zero, so that it may be flown under."""
    range: Point2
    """Least and largest value that are possible, metres."""
    prior: Annotated[Several[Point2], Field(min_length=1)] | NormalSpec
    """What is believed of it: `[[value, probability], ...]`, or `{mean: 1.2, sigma: 0.2}`; metres."""
    truth: NotNegative | None = None
    """What a scripted operator knows, metres; never used to plan."""


class RoomSpec(Spec):
    """A place that cannot be looked into from outside."""

    id: Name
    """Unique name, e.g. `room-1`."""
    description: Described
    """What the operator can see, with its article: `the closed room with the brown door`."""
    door: BoxSpec
    """The closed door."""
    viewpoint_m: Place
    """From here, in front of the door, the drone can look in."""
    prior_occupied: Probability | None = None
    """Probability that somebody is inside, before any answer. Default: `priors.occupied`."""
    occupied: bool | None = None
    """A known fact: true or false. Without it the room is a knowledge gap."""
    truth: Occupancy | None = None
    """What a scripted operator knows; never used to plan."""


class ObjectSpec(Spec):
    """A thing on the map that an instruction may mean. It is solid, where it is and as large as it is."""

    id: Name
    """Unique name, e.g. `box-1`."""
    label: Name
    """What it is: `box`, `person` …"""
    position_m: Place
    """Its centre."""
    size_m: Annotated[Point3, Field(description="Edge lengths [x, y, z], metres.")] = (0.4, 0.4, 0.4)
    solid: bool = True
    """Whether it can be bumped into. An object of size [0, 0, 0] never can."""
    attributes: Attributes = Field(default_factory=dict)
    """What can be said of it: `{colour: red, size: small}`."""


class MapWorld(Spec):
    """An occupancy map that others made. Deliberating on it needs no simulator."""

    map: Words
    """A ROS map_server file (`.yaml`) or a MovingAI map (`.map`, `.3dmap`); relative to the mission file."""
    resolution_m: Annotated[float, Field(ge=1e-4, le=1e4)] | None = None
    """Edge of a cell of a MovingAI map, metres; default 1. A ROS map names its own."""
    height_m: Annotated[float, Field(ge=0)] = 1.0
    """Height at which a flat map is flown, metres."""
    start_m: Place
    """Where the drone takes off."""
    fence: Annotated[Several[Point2], Field(min_length=3)] | None = None
    """Corners [x, y] in order of what must not be left. Nothing outside it is flown through."""
    regions: Several[RegionSpec] = ()
    """Places that are passable or not as a whole."""
    rooms: Several[RoomSpec] = ()
    """Places that cannot be looked into from outside."""
    objects: Several[ObjectSpec] = ()
    """Things that the instruction may mean."""
    seed: Annotated[int, Field(ge=0)] | None = None
    """For the scripted operator; `--seed` overrides it. Default: 0."""
    georeference: GeoreferenceSpec | None = None
    """Where it lies on the earth; default: nowhere, all places are metres."""


class SeenWorld(Spec):
    """A map that `mintpilot see` made of pictures, with everything that was seen on it."""

    seen: Words
    """The folder that `mintpilot see SOURCE --out DIR` wrote; relative to the mission file."""
    start_m: Point3 | None = None
    """Where the drone takes off. Default: where the first picture was taken."""
    seed: Annotated[int, Field(ge=0)] | None = None
    """For the scripted operator; `--seed` overrides it. Default: 0."""
    georeference: GeoreferenceSpec | None = None
    """Where it lies on the earth; default: nowhere, all places are metres."""


def _kind_of_world(value: Any) -> str | None:
    """Which of the four it is, told by its key."""
    for key, model in (("scenario", ScenarioWorld), ("scene", SceneWorld), ("map", MapWorld), ("seen", SeenWorld)):
        if (isinstance(value, dict) and key in value) or isinstance(value, model):
            return model.__name__
    return None


World: TypeAlias = Annotated[
    Annotated[ScenarioWorld, Tag("ScenarioWorld")]
    | Annotated[SceneWorld, Tag("SceneWorld")]
    | Annotated[MapWorld, Tag("MapWorld")]
    | Annotated[SeenWorld, Tag("SeenWorld")],
    Discriminator(_kind_of_world),
]


def names_in(world: World | None, language: str) -> dict[str, str]:
    """What the file calls regions and rooms in that language, by their English words; only where it says so."""
    if not isinstance(world, MapWorld):
        return {}
    described = [*(r.description for r in world.regions), *(r.description for r in world.rooms)]
    said = ((in_english(d), d) for d in described)
    return {english: d[lang] for english, d in said if isinstance(d, dict) for lang in d if lang == language}
