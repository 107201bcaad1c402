"""The forms in which a model may answer. What comes back is checked again against the world: a form is no trust."""

from __future__ import annotations

import re
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

_Form = TypeVar("_Form", bound=BaseModel)
_LONGEST = 20_000


class StrictForm(BaseModel):
    """A form that takes no other fields than its own."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def read_form(text: str, form: type[_Form]) -> _Form | None:
    """The first JSON object in the text, if it has that form; None otherwise."""
    found = re.search(r"\{.*\}", text[:_LONGEST], re.DOTALL)
    if found is None:
        return None
    try:
        return form.model_validate_json(found[0])
    except (ValidationError, RecursionError):
        return None
