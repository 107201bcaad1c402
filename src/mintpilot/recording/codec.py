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
| numpy array | see `mintpilot.recording.codec_arrays.array_codec` |
"""

from __future__ import annotations

import collections.abc as abc
import dataclasses
import functools
import types
import typing
from collections.abc import Callable, Mapping
from enum import Enum
from typing import Any, Final, TypeVar, cast

import numpy as np
from pydantic import JsonValue

from mintpilot.core.errors import RecordError
from mintpilot.recording import codec_parts as scalars
from mintpilot.recording.codec_arrays import array_codec
from mintpilot.recording.codec_containers import (
    TAG,
    dataclass_codec,
    fixed_codec,
    frozenset_codec,
    many_codec,
    mapping_codec,
    tagged_codec,
    within,
)
from mintpilot.recording.codec_parts import Budget, CodecError, TypeCodec

T = TypeVar("T")
_SCALARS: Mapping[object, Callable[[], TypeCodec]] = {
    str: scalars.text_codec,
    int: scalars.int_codec,
    bool: scalars.bool_codec,
    float: scalars.float_codec,
    type(None): scalars.none_codec,
    np.ndarray: array_codec,
}


class Codec:
    """Encodes and decodes; what it has learned of a type it keeps.

    Args:
        special: types that are written in a way of their own, e.g. as differences to the value before.
    """

    def __init__(self, special: Mapping[object, TypeCodec] | None = None) -> None:
        self._special: Final = dict(special or {})
        self._known = dict(self._special)

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
            return self.type_codec(declared).encode(value)
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
            return cast(T, self.type_codec(hint).decode(document, Budget()))
        except CodecError as fault:
            raise RecordError(fault.told(_name(hint))) from None
        except RecursionError:
            raise RecordError(f"{_name(hint) or 'value'}: nested too deeply for any record") from None

    def type_codec(self, hint: object) -> TypeCodec:
        """Both ways for a declared type. Raises `CodecError` where it has no exact form."""
        known = self._known.get(hint)
        if known is not None:
            return known
        # Types may hold themselves, like the nodes of a tree: the codec is known before it is finished.
        codec = self._known[hint] = TypeCodec(encode=_unfinished, decode=_unfinished)
        try:
            made = self._made(hint)
        except CodecError:  # others may hold the unfinished one by now
            self._known = dict(self._special)
            raise
        codec.encode, codec.decode = made.encode, made.decode
        return codec

    def _made(self, hint: Any) -> TypeCodec:
        if hint in _SCALARS:
            return _SCALARS[hint]()
        origin, arguments = typing.get_origin(hint), typing.get_args(hint)
        if origin is np.ndarray:
            return array_codec()
        if origin is typing.Annotated:
            return self.type_codec(arguments[0])
        if origin is typing.Literal:
            return scalars.literal_codec(arguments)
        if origin is typing.Union or origin is types.UnionType:
            return self._union(arguments)
        if origin is tuple or origin is abc.Sequence:
            return self._tuple(arguments if origin is tuple else (*arguments, ...))
        if origin in (frozenset, abc.Set):
            return frozenset_codec(self.type_codec(arguments[0]))
        if origin in (dict, abc.Mapping):
            return mapping_codec(
                self.type_codec(arguments[0]), self.type_codec(arguments[1]), words=arguments[0] is str
            )
        if isinstance(hint, type) and issubclass(hint, Enum):
            return scalars.enum_codec(hint)
        if isinstance(hint, type) and dataclasses.is_dataclass(hint):
            return self._dataclass(hint)
        if isinstance(hint, typing.NewType):
            return self.type_codec(hint.__supertype__)
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
                fields.append((field.name, within(field.name, self.type_codec, hints[field.name]), required))
        return dataclass_codec(cls, fields)

    def _tuple(self, arguments: tuple[Any, ...]) -> TypeCodec:
        if len(arguments) == 2 and arguments[1] is ...:
            return many_codec(self.type_codec(arguments[0]))
        return fixed_codec([self.type_codec(argument) for argument in arguments])

    def _union(self, members: tuple[Any, ...]) -> TypeCodec:
        named = [member for member in members if member is not type(None)]
        optional = len(named) < len(members)
        inner = self.type_codec(named[0]) if len(named) == 1 else self._tagged(named)
        if not optional:
            return inner
        return TypeCodec(
            encode=lambda value: None if value is None else inner.encode(value),
            decode=lambda document, budget: None if document is None else inner.decode(document, budget),
        )

    def _tagged(self, members: list[Any]) -> TypeCodec:
        """Members of a union, told apart by their class."""
        classes = [typing.get_origin(member) or member for member in members]
        known: dict[str, tuple[type, TypeCodec, bool]] = {}
        for member, cls in zip(members, classes, strict=True):
            flat = dataclasses.is_dataclass(member) and member not in self._special
            if flat and any(field.name == TAG for field in dataclasses.fields(member)):
                raise CodecError(f"{_name(member)} is a member of a union and has a field '{TAG}': rename the field")
            if cls.__name__ in known:
                raise CodecError(
                    f"two members of a union are called {cls.__name__}: a document could not tell them apart"
                )
            known[cls.__name__] = (cls, self.type_codec(member), flat)
        return tagged_codec(known)


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
