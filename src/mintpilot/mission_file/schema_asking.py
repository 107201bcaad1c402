"""The schema of `AskingSettings`, made of its fields: names, types, defaults, bounds and sentences stand there only."""

from __future__ import annotations

from dataclasses import fields
from enum import StrEnum
from typing import Annotated, Any, Literal, get_type_hints

from pydantic import Field, create_model

from mintpilot.core.mission import AskingSettings, Bounds
from mintpilot.mission_file.schema_base import PartName, Spec


def asking_spec() -> Any:
    """A pydantic model with one field for each of `AskingSettings`."""
    hints = get_type_hints(AskingSettings)
    made: dict[str, Any] = {}
    for one in fields(AskingSettings):
        bounds: Bounds = one.metadata["bounds"]
        limits = Field(ge=bounds.least, lt=bounds.below, description=bounds.meaning)
        made[one.name] = (Annotated[_written(hints[one.name]), limits], _default(one.default))
    return create_model("AskingFields", __base__=Spec, **made)


def _written(kind: Any) -> Any:
    """How a value of that type is written in a mission file: choices by their words, names as `PartName`."""
    if not isinstance(kind, type):
        return kind  # a number that may be left out
    if issubclass(kind, StrEnum):
        return Literal[tuple(choice.value for choice in kind)]
    return PartName if kind is str else kind


def _default(value: object) -> object:
    return value.value if isinstance(value, StrEnum) else value
