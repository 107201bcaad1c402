"""The bricks of the mission file's schema: strict models and bounded numbers."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, Literal, TypeAlias, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetJsonSchemaHandler,
    Tag,
    WithJsonSchema,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.observation import Attribute


class Spec(BaseModel):
    """A part of a mission file: unknown keys are refused, numbers are finite, nothing is converted silently."""

    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        frozen=True,
        allow_inf_nan=False,
        title=None,
        defer_build=True,
    )

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """What is written below a field describes it: read from the source only where a schema is wanted."""
        schema = handler(core_schema)
        fields = handler.resolve_ref_schema(schema).get("properties", {})
        for name, words in _described(cls).items():
            fields[cls.model_fields[name].alias or name].setdefault("description", words)
        return schema


def _described(model: type[Spec]) -> dict[str, str]:
    """The sentences below a model's own and inherited fields."""
    found: dict[str, str] = {}
    for one in reversed([kind for kind in model.__mro__ if issubclass(kind, Spec) and kind.__doc__]):
        tree = ast.parse(textwrap.dedent(inspect.getsource(one)))
        for field, words in pairwise(ast.walk(tree)):
            match field, words:
                case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                    found[name] = inspect.cleandoc(text)
    return found


def _as_tuple(value: Any) -> Any:
    """YAML has lists only; a strict tuple wants a tuple."""
    return tuple(value) if isinstance(value, list) else value


def _as_values(value: Any) -> Any:
    """One word, or a list of words."""
    return (value,) if isinstance(value, str) else _as_tuple(value)


T = TypeVar("T")
Several: TypeAlias = Annotated[tuple[T, ...], BeforeValidator(_as_tuple)]
"""A list in the file."""
Probability: TypeAlias = Annotated[float, Field(ge=0, le=1)]
Positive: TypeAlias = Annotated[float, Field(gt=0)]
Duration: TypeAlias = Annotated[float, Field(ge=0, le=1e6)]
"""Up to eleven days."""
Metres: TypeAlias = Annotated[float, Field(ge=0, le=1e3)]
"""Of a vehicle or a distance kept from something."""
NotNegative: TypeAlias = Annotated[float, Field(ge=0)]
Name: TypeAlias = Annotated[str, Field(min_length=1, max_length=100, pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$")]
"""Letters, digits, ``-``, ``_`` and ``.``: safe in file names, reports and answers."""
PartName: TypeAlias = Annotated[
    str, Field(min_length=1, max_length=300, pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*(:[^:]+)?$")
]
"""A registered name, perhaps with what it goes by after a colon: ``q-value:mine.npz``."""
ThinkWords: TypeAlias = Annotated[str, Field(pattern=r"^\d+(\.\d+)?(\.\.\d+(\.\d+)?)?$")]
"""``5``, or ``2..8``: a time, or two bounds between which it is drawn evenly, seconds."""
Words: TypeAlias = Annotated[str, Field(min_length=1, max_length=1000)]
Spoken: TypeAlias = Literal["en", "de", "fr", "es"]
WAYS_TO_DESCRIBE = ("words", "languages")
"""How pydantic names the two, in the order in which the JSON Schema lists them."""


def _way_to_describe(value: object) -> str:
    return WAYS_TO_DESCRIBE[isinstance(value, Mapping)]


Described: TypeAlias = Annotated[
    Annotated[Words, Tag(WAYS_TO_DESCRIBE[0])]
    | Annotated[dict[Spoken, Words], Field(min_length=1), Tag(WAYS_TO_DESCRIBE[1])],
    Discriminator(_way_to_describe),
]
"""Words, or the same in several languages: ``{en: the grey smoke, de: der graue Rauch}``. Instructions and answers of
other languages than the questions' name a thing by its English words, or the first ones where there are none."""
Point3: TypeAlias = Annotated[tuple[float, float, float], BeforeValidator(_as_tuple)]
"""``[x, y, z]`` in metres."""
Point2: TypeAlias = Annotated[tuple[float, float], BeforeValidator(_as_tuple)]
"""``[x, y]`` in metres."""
Place: TypeAlias = Annotated[tuple[float, ...], BeforeValidator(_as_tuple), Field(min_length=2, max_length=3)]
"""``[x, y]`` or ``[x, y, z]`` in metres; without z on a flat map: at the height of its layer."""
Values: TypeAlias = Annotated[
    tuple[Annotated[str, Field(min_length=1)], ...],
    BeforeValidator(_as_values),
    Field(min_length=1),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "minLength": 1},
                {"type": "array", "items": {"type": "string", "minLength": 1}, "minItems": 1},
            ]
        }
    ),
]
"""One word or a list of words."""
Attributes: TypeAlias = dict[Name, Values]
"""What can be said of a thing: ``{colour: red, size: small}``."""


class BoxSpec(Spec):
    """An axis-aligned box."""

    lo_m: Point3
    """Lowest corner [x, y, z], metres."""
    hi_m: Point3
    """Highest corner [x, y, z], metres."""

    def box(self) -> Box:
        """The box as core knows it. Raises `MapError` when a corner is on the wrong side."""
        return Box(lo_m=self.lo_m, hi_m=self.hi_m)


def attributes_of(attributes: Mapping[str, tuple[str, ...]]) -> tuple[Attribute, ...]:
    """The mapping of a mission file as core attributes, in the file's order."""
    return tuple(Attribute(name=name, value=value) for name, values in attributes.items() for value in values)


def place_of(place: tuple[float, ...], layer_m: float) -> Vec3:
    """A place with its height; one given as ``[x, y]`` lies at ``layer_m``."""
    return (place[0], place[1], place[2] if len(place) == 3 else layer_m)


def in_english(described: Described) -> str:
    """The words that the map has for it."""
    return described if isinstance(described, str) else described.get("en") or next(iter(described.values()))
