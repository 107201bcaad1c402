"""The forms in which a model may answer. What comes back is checked again against the world: a form is no trust."""

from __future__ import annotations

import re
from typing import Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from mintpilot.core.query import Combine

_Form = TypeVar("_Form", bound=BaseModel)
_LONGEST = 20_000


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class CutPart(_Strict):
    """``gap`` has ``value``; with ``attribute``, what the gap's phrase means has that attribute."""

    gap: str = Field(max_length=200)
    value: str = Field(max_length=200)
    attribute: str = Field(default="", max_length=100)


class Cut(_Strict):
    """One proposed cut."""

    parts: list[CutPart] = Field(min_length=1, max_length=3)
    combine: Combine = Combine.ALL


class Cuts(_Strict):
    """What a model proposes to ask."""

    cuts: list[Cut] = Field(max_length=20)


class AnswerReading(_Strict):
    """What a model takes an answer for. Orders are not among it: those must be heard by the rules."""

    reading: Literal["yes", "no", "unsure", "other"]


class TypedStep(_Strict):
    """One step of an instruction. What each field holds depends on the action; `Steps` says how."""

    action: Literal["go", "pick", "deliver", "look", "count", "photograph", "report", "seek"]
    target: str = Field(default="", max_length=100)
    place: str = Field(default="", max_length=100)


class Distance(_Strict):
    """What is to be stayed away from."""

    what: str = Field(min_length=1, max_length=100)
    metres: float = Field(default=0.0, ge=0, le=100)


class Steps(_Strict):
    """An instruction as typed steps. ``target`` is the thing, ``place`` the room, the container or the receiver."""

    steps: list[TypedStep] = Field(min_length=1, max_length=12)
    keep_out: list[Distance] = Field(default=[], max_length=6)


def read_form(text: str, form: type[_Form]) -> _Form | None:
    """The first JSON object in the text, if it has that form; None otherwise."""
    found = re.search(r"\{.*\}", text[:_LONGEST], re.DOTALL)
    if found is None:
        return None
    try:
        return form.model_validate_json(found[0])
    except (ValidationError, RecursionError):
        return None
