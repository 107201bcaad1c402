"""What a scenario generator gives out, and how its parameters are read."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, TypeVar

from mintpilot.core.errors import MissionError, UnknownNameError
from mintpilot.core.mission import Mission
from mintpilot.simulation.scene import FlightRules, Scene


class Parameters(Protocol):
    """A frozen dataclass of plain numbers, one kind per generator."""

    __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[Any]]]


P = TypeVar("P", bound=Parameters)


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """One drawn world with its mission."""

    scene: Scene
    """The truth."""
    mission: Mission
    """What the drone is told."""
    rules: FlightRules
    """What ends the flight."""
    parameters: Parameters
    """What it was drawn from, defaults included."""
    notes: Mapping[str, str | float]
    """How this world came out, for tables: the smoke's place, the shortest way …; never planned on."""


def read_parameters(kind: type[P], given: Mapping[str, object], scenario: str) -> P:
    """Makes the parameter dataclass of a generator from names and values.

    Raises:
        UnknownNameError: the generator has no parameter of a name.
        MissionError: a value is not a number, or breaks a rule of the dataclass.
    """
    known = {field.name for field in dataclasses.fields(kind)}
    for name, value in given.items():
        if name not in known:
            raise UnknownNameError(f"parameter of the scenario {scenario}", name, known)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise MissionError(f"scenario {scenario}: {name} = {value!r} must be a number")
    return kind(**given)


def check_numbers(parameters: Parameters, *, probabilities: tuple[str, ...], positive: tuple[str, ...]) -> None:
    """Raises `MissionError` for a named value that is no probability, or not above 0."""
    for name in probabilities:
        if not 0 <= getattr(parameters, name) <= 1:
            raise MissionError(f"{name} = {getattr(parameters, name)}: must be a probability from 0 to 1")
    for name in positive:
        if not getattr(parameters, name) > 0:
            raise MissionError(f"{name} = {getattr(parameters, name)}: must be above 0")
