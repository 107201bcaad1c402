"""The mission file, version 1 (YAML). Its first key is ``mintpilot: 1``.

The models check the form; `mintpilot.mission_file.reader` adds what only the whole file, and the map
it names, can tell.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, ConfigDict, Field

from mintpilot.mission_file.schema_asking import asking_spec
from mintpilot.mission_file.schema_base import (
    Attributes,
    Duration,
    Metres,
    Name,
    NotNegative,
    Place,
    Probability,
    Several,
    Spec,
    ThinkWords,
    Words,
)
from mintpilot.mission_file.schema_world import ValueSpec, World

SCHEMA_VERSION = 1


def _as_rule(value: object) -> object:
    """A formula may stand alone."""
    return {"formula": value} if isinstance(value, str) else value


class VehicleSpec(Spec):
    """What the vehicle can do."""

    model_config = ConfigDict(validate_by_alias=True, validate_by_name=True)

    radius_m: Annotated[float, Field(gt=0, le=100)] = 0.3
    """No part of the vehicle is further from its centre, metres."""
    margin_m: Metres = 0.1
    """Clearance kept besides the radius, metres."""
    position_sigma_m: Metres = 0.0
    """Standard deviation of the known position, metres; three times as much is added to the margin."""
    cruise_mps: Annotated[float, Field(ge=0.01, le=100)] = 1.5
    """Speed on straight legs, metres per second."""
    max_acceleration_mps2: Annotated[float, Field(ge=0.01, le=100)] = 2.0
    """Of any commanded motion, metres per second squared."""
    endurance_s: Annotated[float, Field(gt=0, le=1e6)] | None = None
    """Flight time for the mission, seconds; plans leave a fifth of it for braking, corners and gusts; default:
    unlimited."""
    reserve_s: Duration = 0.0
    """Flight time that no plan may use, seconds."""
    returns: Literal["required", "if-possible", "none"] = Field(default="none", alias="return")
    """Whether it flies back to the start when its task is done; `required`: every plan leaves battery for that."""


StrategyArguments = dict[str, dict[str, bool | int | float | str]]


class AskingSpec(asking_spec()):  # type: ignore[misc]  # made of the fields of AskingSettings
    """Thresholds and bounds of reasoning and asking."""

    strategy_arguments: StrategyArguments = Field(default_factory=dict)
    """Arguments of methods of asking, by the name of the strategy, e.g. `{knowno: {quantile: 0.8}}`;
    `--strategy-arg` overrides them."""


class SurveySpec(Spec):
    """The flight that makes the map, for worlds that have none yet."""

    spacing_m: Annotated[float, Field(ge=0.1, le=1e3)] = 4.0
    """Between places to look around from, about, metres."""
    speed_mps: Annotated[float, Field(ge=0.01, le=100)] = 2.0
    """Between those places, metres per second."""
    longest_s: Annotated[float, Field(gt=0, le=1e6)] = 240.0
    """No new place is flown to after this time, seconds."""
    resolution_m: Annotated[float, Field(ge=0.01, le=10)] = 0.2
    """Edge of a voxel of the map that is made, metres."""


class PriorsSpec(Spec):
    """What is believed of things that name no prior of their own."""

    passable: Probability = 0.5
    """That a region is passable."""
    occupied: Probability = 0.5
    """That somebody is in a closed room."""


class PerceptionSpec(Spec):
    """What makes objects of pictures."""

    use: Name = "geometric"
    """Perception by name: `geometric` (boxes, people lying, doors, smoke, fire), `segments` (bodies of any kind,
    anywhere), or that of a plug-in; `--perception` overrides it."""
    namers: Several[Name] = ()
    """With `segments`: who names what it finds, e.g. `[geometry, ocr, vision]`; default: by geometry."""
    calibration: Words | None = None
    """With `segments`: file of confidences of the namers, as `mintpilot bench perception --calibrate` writes it;
    relative to the mission file."""


class GoalSpec(Spec):
    """One step. Give where it is as exactly one of `phrase`, `object`, `room` and `position_m`."""

    action: Literal["go", "pick", "deliver", "look", "count", "photograph", "report"]
    """What is done there."""
    phrase: Words | None = None
    """Words that mean a thing, e.g. `the box`. Several things may fit: that is a knowledge gap."""
    label: Name | None = None
    """With a phrase: what the thing must be, e.g. `box`."""
    attributes: Attributes = Field(default_factory=dict)
    """With a phrase: what the thing must have, e.g. `{colour: red}`."""
    object: Name | None = None
    """Id of one object of the world."""
    room: Name | None = None
    """Id of one room of the world: its viewpoint."""
    position_m: Place | None = None
    """A fixed place."""
    dwell_s: Duration = 2.0
    """How long the drone stays there, seconds."""
    price_s: NotNegative | None = None
    """What leaving it undone costs, seconds of flight; default: `asking.failure_price_s`."""
    id: Name | None = None
    """What `rules` call it by."""
    truth: Name | None = None
    """With a phrase: id of the object that is really meant, for a scripted operator; never used to plan."""


class KeepAwaySpec(Spec):
    """A distance that is to be kept. A wish: where nothing can be flown so, the drone says so and asks."""

    model_config = ConfigDict(validate_by_alias=True, validate_by_name=True)

    thing: Words = Field(alias="from")
    """From what: `people`, words for things of a kind (`the barrels`), or the id of a region."""
    metres: Annotated[float, Field(gt=0, le=100)] = 2.0
    """How far, metres, between the drone's body and it."""


class RuleSpec(Spec):
    """What every flight keeps, as one pattern: `never`, `always`, `never` with `before`, `first` with `then`, `after`
    with `eventually`, `end`, or `formula`. Each but the last takes one proposition: `in(REGION)`, `inside(REGION)`,
    `touches(REGION)`, `within(THING, METRES)`, `at(GOAL)`, `did(GOAL)`, `looked(ROOM)`, `carrying(LABEL)`.
    `looked` takes the id of a goal that is a look, too.
    """

    never: Words | None = None
    """At no moment; with `before`: at no moment before that."""
    before: Words | None = None
    """Until when `never` counts."""
    always: Words | None = None
    """At every moment; `in(REGION)` then means with the whole body."""
    first: Words | None = None
    """With `then`: both, and this not after that."""
    then: Words | None = None
    """What comes after `first`."""
    after: Words | None = None
    """With `eventually`: whenever this holds."""
    eventually: Words | None = None
    """What holds at some time after `after`."""
    end: Words | None = None
    """At the last moment of the flight."""
    formula: Words | None = None
    """A rule in LTLf: `! & | -> G F U R` over the propositions. A rule may also be given as this text alone."""


class LookSpec(Spec):
    """A place from which it can be seen whether a region is passable. What a look tells is as good as an answer."""

    at: Name
    """Id of the region."""
    viewpoint_m: Place
    """From where."""
    dwell_s: Duration = 2.0
    """How long the drone stays there, seconds."""
    sees: Annotated[float, Field(gt=0, le=1)] = 1.0
    """Probability that the look settles it; else it tells nothing, and is not tried again."""


class CombinationSpec(Spec):
    """One combination of values with its probability."""

    values: Several[Words]
    """One value for each gap, in the group's order: `passable`/`blocked`, `present`/`absent`, or an object's id."""
    probability: Probability
    """Of all of them together."""


class CorrelationSpec(Spec):
    """Gaps whose priors do not multiply, e.g. two clouds from one fire."""

    gaps: Annotated[Several[Words], Field(min_length=2)]
    """Ids of gaps: `obstacle:REGION`, `presence:ROOM`."""
    joint: Annotated[Several[CombinationSpec], Field(min_length=1)]
    """Probability of each combination; those not named have none. They sum to 1."""


class LanguageSpec(Spec):
    """The language of questions, and who may help with words. What a model needs comes from the environment only."""

    model: Name = "template"
    """Language model by name: `template` (none), `endpoint`, `embedded`, or that of a plug-in; `--llm` overrides it."""
    lang: Literal["en", "de", "fr", "es"] = "en"
    """In which questions are asked; `--lang` overrides it."""


class OperatorSpec(Spec):
    """How a scripted operator behaves."""

    answer_error: Probability = 0.0
    """Probability of answering the opposite of the truth."""
    unsure: Probability = 0.0
    """Probability of answering that it does not know."""
    silence: Probability = 0.0
    """Probability of not answering."""
    latency_s: NotNegative | ThinkWords = 0.0
    """Time taken for an answer, seconds, on the mission's clock; `2..8`: drawn evenly between the two."""


class MissionFile(Spec):
    """A mission: what is to be done, where, by which vehicle, with which tolerances."""

    mintpilot: Literal[1]
    """Version of this schema; must be 1."""
    name: Name
    """Short name of the mission, used for its run folder."""
    instruction: Words
    """What is to be done, in plain words."""
    world: World
    """Where: a `scenario` by name, an explicit `scene`, a `map` of your own, or what was `seen`."""
    goals: Annotated[Several[GoalSpec], Field(min_length=1)] | None = None
    """The steps, in order. Without them they are taken from the instruction."""
    flight_plan: Words | None = None
    """A `.plan` of QGroundControl or a `.waypoints` list, relative to this file, for a `map` with a `georeference`: its
    way-points are the goals, and its fence is that of the map."""
    seeks_people: bool | None = None
    """True when everybody who is hurt must be found. Default: as the instruction says."""
    keep_away: Several[KeepAwaySpec] = ()
    """Distances to be kept from people, things or regions, besides those that the instruction names."""
    rules: Several[Annotated[RuleSpec, BeforeValidator(_as_rule)]] = ()
    """What every flight keeps from take-off to its end. Hard: where a rule cannot be kept, stops are left undone."""
    looks: Several[LookSpec] = ()
    """From where regions can be looked at: a look competes with questions by what it tells a second
    (`asking.reply_s`). What it sees counts as a yes does: for the outline that it saw, for `answer_valid_s`. Only the
    kinematic simulator settles looks, where it knows how things truly are; elsewhere they are left out, and that is
    said."""
    people_price_s: NotNegative | None = None
    """What leaving somebody unseen costs, seconds of flight; default: `asking.failure_price_s`."""
    vehicle: VehicleSpec = VehicleSpec.model_construct()
    """What the vehicle can do."""
    asking: AskingSpec = AskingSpec.model_construct()
    """When to ask, and when to stop."""
    language: LanguageSpec = LanguageSpec.model_construct()
    """In which language it asks, and with what language model, if any."""
    perception: PerceptionSpec = PerceptionSpec.model_construct()
    """What makes objects of pictures, where the mission is flown with a camera."""
    survey: SurveySpec | None = None
    """The flight that makes the map; not for worlds given as a map."""
    priors: PriorsSpec = PriorsSpec.model_construct()
    """For regions and rooms that name none."""
    values: Several[ValueSpec] = ()
    """Ordered values of regions of a given map: how wide a passage is, how high smoke hangs."""
    correlations: Several[CorrelationSpec] = ()
    """Gaps whose priors do not multiply."""
    operator: OperatorSpec = OperatorSpec.model_construct()
    """How a scripted operator behaves."""
    truth: dict[str, str] = Field(default_factory=dict)
    """What a scripted operator knows: id of a region or room, or a phrase, to its true value."""
