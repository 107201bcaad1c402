"""Values as JSON and back, exactly: trees of frozen dataclasses, by their type hints.

The hints say all: no class needs code of its own, and no name in a document is ever imported or executed. What has no
exact form (an unknown type, an array of objects) is refused when its class is first met.

| hint | in a document |
|---|---|
| str, int, bool, None, float | as they are; ``"inf"``, ``"-inf"``, ``"nan"`` |
| enumeration, Literal | its value as text; members whose values are no text by name |
| dataclass | an object with all fields |
| union of several types | an object with ``"type"``; what is no dataclass stands under ``"value"`` |
| tuple, Sequence | a list |
| frozenset | a sorted list |
| Mapping | an object; with keys other than text a list of pairs |
| numpy array | see `mintpilot.recording.codec_arrays.array_part` |
"""

from __future__ import annotations

import collections.abc as abc
import dataclasses
import functools
import json
import types
import typing
from collections.abc import Callable, Mapping
from enum import Enum
from typing import Any, Final, TypeVar, cast

import numpy as np
from pydantic import JsonValue

from mintpilot.core.errors import RecordError
from mintpilot.recording import codec_parts as parts
from mintpilot.recording.codec_arrays import array_part
from mintpilot.recording.codec_parts import Budget, CodecError, TypeCodec, shown

T = TypeVar("T")
TAG = "type"
"""Field that tells the members of a union apart."""
_SCALARS: Mapping[object, Callable[[], TypeCodec]] = {
    str: parts.text_part,
    int: parts.int_part,
    bool: parts.bool_part,
    float: parts.float_part,
    type(None): parts.none_part,
    np.ndarray: array_part,
}


class Codec:
    """Encodes and decodes; what it has learned of a type it keeps.

    Args:
        special: types that are written in a way of their own, e.g. as differences to the value before.
    """

    def __init__(self, special: Mapping[type, TypeCodec] | None = None) -> None:
        self._special: Final = dict(special or {})
        self._parts: dict[object, TypeCodec] = {cls: part for cls, part in self._special.items()}  # noqa: C416

    def encode(self, value: object, hint: object = None) -> JsonValue:
        """The value as JSON. Equal values give equal documents, except for the order within mappings.

        Args:
            value: a tree of frozen dataclasses, or what their fields may hold.
            hint: the declared type, needed where the value's own class does not say all (a union, a tuple).

        Raises:
            RecordError: something in it has no exact form, or is not of its declared type; the message names the place.
        """
        declared = type(value) if hint is None else hint
        try:
            return self.part(declared).encode(value)
        except CodecError as fault:
            raise RecordError(fault.told(_name(declared))) from None

    def decode(self, hint: type[T], document: JsonValue) -> T:
        """The value that was encoded under that hint; arrays in it are read-only.

        Args:
            hint: the declared type (for a union, ``cast`` it to ``type`` of the union).
            document: what `encode` gave; it may be hostile.

        Raises:
            RecordError: the document does not hold such a value; the message names the place and the rule.
        """
        try:
            return cast(T, self.part(hint).decode(document, Budget()))
        except CodecError as fault:
            raise RecordError(fault.told(_name(hint))) from None
        except RecursionError:
            raise RecordError(f"{_name(hint) or 'value'}: nested too deeply for any record") from None

    def part(self, hint: object) -> TypeCodec:
        """Both ways for a declared type. Raises `CodecError` where it has no exact form."""
        known = self._parts.get(hint)
        if known is not None:
            return known
        # Types may hold themselves, like the nodes of a tree: the part is known before it is finished.
        part = self._parts[hint] = TypeCodec(encode=_unfinished, decode=_unfinished)
        try:
            made = self._made(hint)
        except CodecError:
            del self._parts[hint]
            raise
        part.encode, part.decode = made.encode, made.decode
        return part

    def _made(self, hint: Any) -> TypeCodec:
        if hint in _SCALARS:
            return _SCALARS[hint]()
        origin, arguments = typing.get_origin(hint), typing.get_args(hint)
        if origin is np.ndarray:
            return array_part()
        if origin is typing.Annotated:
            return self.part(arguments[0])
        if origin is typing.Literal:
            return parts.literal_part(arguments)
        if origin is typing.Union or origin is types.UnionType:
            return self._union(arguments)
        if origin is tuple or origin is abc.Sequence:
            return self._tuple(arguments if origin is tuple else (*arguments, ...))
        if origin in (frozenset, abc.Set):
            return _frozenset(self.part(arguments[0]))
        if origin in (dict, abc.Mapping):
            return _mapping(self.part(arguments[0]), self.part(arguments[1]), words=arguments[0] is str)
        if isinstance(hint, type) and issubclass(hint, Enum):
            return parts.enum_part(hint)
        if isinstance(hint, type) and dataclasses.is_dataclass(hint):
            return self._dataclass(hint)
        if isinstance(hint, typing.NewType):
            return self.part(hint.__supertype__)
        raise CodecError(f"values of type {_name(hint)} have no exact form in a record: use the nouns of core")

    def _dataclass(self, cls: type) -> TypeCodec:
        try:
            hints = typing.get_type_hints(cls)
        except NameError as error:
            raise CodecError(
                f"the type hints of {cls.__name__} need names that its module does not import: {error}"
            ) from error
        fields: list[tuple[str, TypeCodec, bool]] = []
        for field in dataclasses.fields(cls):
            if field.init:
                required = field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
                fields.append((field.name, _within(field.name, self.part, hints[field.name]), required))

        def encode(value: object) -> JsonValue:
            if type(value) is not cls:
                raise CodecError(f"{shown(value)}: {cls.__name__} is expected")
            document: dict[str, JsonValue] = {}
            for name, part, _ in fields:
                try:
                    document[name] = part.encode(getattr(value, name))
                except CodecError as fault:
                    raise fault.under(name) from None
            return document

        def decode(document: JsonValue, budget: Budget) -> object:
            if not isinstance(document, dict):
                raise CodecError(f"{shown(document)}: an object with the fields of {cls.__name__} is expected")
            values: dict[str, object] = {}
            for name, part, required in fields:
                if name in document:
                    values[name] = _within(name, part.decode, document[name], budget)
                elif required:
                    raise CodecError(f"{cls.__name__} needs the field '{name}'")
            if len(values) != len(document):
                extra = sorted(document.keys() - values.keys())
                raise CodecError(f"{cls.__name__} has no field {shown(extra[0])}")
            try:
                return cls(**values)
            except Exception as error:  # whatever the noun's own checks raise for values that nobody could have made
                raise CodecError(f"{cls.__name__} refuses it: {error}") from None

        return TypeCodec(encode=encode, decode=decode)

    def _tuple(self, arguments: tuple[Any, ...]) -> TypeCodec:
        if len(arguments) == 2 and arguments[1] is ...:
            return _many(self.part(arguments[0]))
        members = tuple(self.part(argument) for argument in arguments)

        def encode(value: object) -> JsonValue:
            if type(value) is not tuple or len(value) != len(members):
                raise CodecError(f"{shown(value)}: a tuple of {len(members)} is expected")
            return [_within(i, part.encode, item) for i, (part, item) in enumerate(zip(members, value, strict=True))]

        def decode(document: JsonValue, budget: Budget) -> object:
            if not isinstance(document, list) or len(document) != len(members):
                raise CodecError(f"{shown(document)}: a list of {len(members)} is expected")
            pairs = enumerate(zip(members, document, strict=True))
            return tuple([_within(i, part.decode, item, budget) for i, (part, item) in pairs])

        return TypeCodec(encode=encode, decode=decode)

    def _union(self, members: tuple[Any, ...]) -> TypeCodec:
        named = [member for member in members if member is not type(None)]
        optional = len(named) < len(members)
        inner = self.part(named[0]) if len(named) == 1 else self._tagged(named)
        if not optional:
            return inner
        return TypeCodec(
            encode=lambda value: None if value is None else inner.encode(value),
            decode=lambda document, budget: None if document is None else inner.decode(document, budget),
        )

    def _tagged(self, members: list[Any]) -> TypeCodec:
        """Members of a union, told apart by their class."""
        classes = [typing.get_origin(member) or member for member in members]
        known: dict[str, tuple[TypeCodec, bool]] = {}
        for member, cls in zip(members, classes, strict=True):
            flat = dataclasses.is_dataclass(member) and member not in self._special
            if flat and any(field.name == TAG for field in dataclasses.fields(member)):
                raise CodecError(f"{_name(member)} is a member of a union and has a field '{TAG}': rename the field")
            if cls.__name__ in known:
                raise CodecError(
                    f"two members of a union are called {cls.__name__}: a document could not tell them apart"
                )
            known[cls.__name__] = (self.part(member), flat)
        names = ", ".join(known)

        def encode(value: object) -> JsonValue:
            cls = type(value)
            if cls not in classes:
                raise CodecError(f"{shown(value)}: one of {names} is expected")
            part, flat = known[cls.__name__]
            body = _within(cls.__name__, part.encode, value)
            return (
                {TAG: cls.__name__, **body} if flat and isinstance(body, dict) else {TAG: cls.__name__, "value": body}
            )

        def decode(document: JsonValue, budget: Budget) -> object:
            tag = document.get(TAG) if isinstance(document, dict) else None
            if not isinstance(document, dict) or not isinstance(tag, str) or tag not in known:
                raise CodecError(f"{shown(tag)}: the '{TAG}' is one of {names}")
            part, flat = known[tag]
            body = {name: item for name, item in document.items() if name != TAG}
            if flat:
                return _within(tag, part.decode, body, budget)
            if set(body) != {"value"}:
                raise CodecError(f"a {tag} stands under 'value', alone")
            return _within(tag, part.decode, body["value"], budget)

        return TypeCodec(encode=encode, decode=decode)


def _many(part: TypeCodec) -> TypeCodec:
    def encode(value: object) -> JsonValue:
        if type(value) is not tuple:
            raise CodecError(f"{shown(value)}: a tuple is expected")
        document: list[JsonValue] = []
        for item in value:
            try:
                document.append(part.encode(item))
            except CodecError as fault:
                raise fault.under(len(document)) from None
        return document

    def decode(document: JsonValue, budget: Budget) -> object:
        if not isinstance(document, list):
            raise CodecError(f"{shown(document)}: a list is expected")
        values: list[object] = []
        for item in document:
            try:
                values.append(part.decode(item, budget))
            except CodecError as fault:
                raise fault.under(len(values)) from None
        return tuple(values)

    return TypeCodec(encode=encode, decode=decode)


def _frozenset(part: TypeCodec) -> TypeCodec:
    def encode(value: object) -> JsonValue:
        if type(value) is not frozenset:
            raise CodecError(f"{shown(value)}: a frozenset is expected")
        return sorted([part.encode(item) for item in value], key=json.dumps)

    def decode(document: JsonValue, budget: Budget) -> object:
        if not isinstance(document, list):
            raise CodecError(f"{shown(document)}: a list is expected")
        values = frozenset([_within(i, part.decode, item, budget) for i, item in enumerate(document)])
        if len(values) != len(document):
            raise CodecError("a set holds nothing twice")
        return values

    return TypeCodec(encode=encode, decode=decode)


def _mapping(key_part: TypeCodec, part: TypeCodec, *, words: bool) -> TypeCodec:
    def encode(value: object) -> JsonValue:
        if not isinstance(value, Mapping):
            raise CodecError(f"{shown(value)}: a mapping is expected")
        pairs = [(key_part.encode(key), _within(str(key), part.encode, item)) for key, item in value.items()]
        if words and all(isinstance(key, str) for key, _ in pairs):
            return {str(key): item for key, item in pairs}
        return [[key, item] for key, item in pairs]

    def decode(document: JsonValue, budget: Budget) -> object:
        pairs = [[key, item] for key, item in document.items()] if isinstance(document, dict) else document
        if not isinstance(pairs, list):
            raise CodecError(f"{shown(document)}: a mapping is expected")
        values: dict[object, object] = {}
        for pair in pairs:
            if not isinstance(pair, list) or len(pair) != 2:
                raise CodecError("a mapping is an object or a list of pairs")
            values[key_part.decode(pair[0], budget)] = _within(shown(pair[0]), part.decode, pair[1], budget)
        if len(values) != len(pairs):
            raise CodecError("a mapping holds no key twice")
        return values

    return TypeCodec(encode=encode, decode=decode)


R = TypeVar("R")


def _within(step: str | int, work: Callable[..., R], *arguments: object) -> R:
    """Does the work; a fault in it is seen from one level further out."""
    try:
        return work(*arguments)
    except CodecError as fault:
        raise fault.under(step) from None


def _unfinished(*_: object) -> Any:
    raise CodecError("a type was used before it was understood")


def _name(hint: object) -> str:
    """For messages; empty for a union, whose members name themselves."""
    if isinstance(hint, type) and not typing.get_args(hint):
        return hint.__name__
    return "" if typing.get_origin(hint) in (typing.Union, types.UnionType) else str(hint).replace("typing.", "")


@functools.cache
def _plain() -> Codec:
    return Codec()


def encode(value: object, hint: object = None) -> JsonValue:
    """See `Codec.encode`."""
    return _plain().encode(value, hint)


def decode(hint: type[T], document: JsonValue) -> T:
    """See `Codec.decode`."""
    return _plain().decode(hint, document)
