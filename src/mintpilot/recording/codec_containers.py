"""Codecs of what holds other values: dataclasses, tuples, sets, mappings, unions."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

from pydantic import JsonValue

from mintpilot.recording.codec_parts import Budget, CodecError, TypeCodec, shown

TAG = "type"
"""Field that tells the members of a union apart."""
R = TypeVar("R")


def within(step: str | int, work: Callable[..., R], *arguments: object) -> R:
    """Does the work; a fault in it is seen from one level further out."""
    try:
        return work(*arguments)
    except CodecError as fault:
        raise fault.under(step) from None


def dataclass_codec(cls: type, fields: Sequence[tuple[str, TypeCodec, bool]]) -> TypeCodec:
    """An object with all fields.

    Args:
        cls: the dataclass; its own checks are run on what is read.
        fields: name, codec, and whether the field has no default. One that has may be missing in a document.
    """

    def encode(value: object) -> JsonValue:
        if type(value) is not cls:
            raise CodecError(f"{shown(value)}: {cls.__name__} is expected")
        document: dict[str, JsonValue] = {}
        for name, codec, _ in fields:
            try:
                document[name] = codec.encode(getattr(value, name))
            except CodecError as fault:
                raise fault.under(name) from None
        return document

    def decode(document: JsonValue, budget: Budget) -> object:
        if not isinstance(document, dict):
            raise CodecError(f"{shown(document)}: an object with the fields of {cls.__name__} is expected")
        values: dict[str, object] = {}
        for name, codec, required in fields:
            if name in document:
                values[name] = within(name, codec.decode, document[name], budget)
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


def fixed_codec(members: Sequence[TypeCodec]) -> TypeCodec:
    """A list of so many values, each of its own type."""

    def encode(value: object) -> JsonValue:
        if type(value) is not tuple or len(value) != len(members):
            raise CodecError(f"{shown(value)}: a tuple of {len(members)} is expected")
        return [within(i, codec.encode, item) for i, (codec, item) in enumerate(zip(members, value, strict=True))]

    def decode(document: JsonValue, budget: Budget) -> object:
        if not isinstance(document, list) or len(document) != len(members):
            raise CodecError(f"{shown(document)}: a list of {len(members)} is expected")
        pairs = enumerate(zip(members, document, strict=True))
        return tuple([within(i, codec.decode, item, budget) for i, (codec, item) in pairs])

    return TypeCodec(encode=encode, decode=decode)


def tagged_codec(known: Mapping[str, tuple[type, TypeCodec, bool]]) -> TypeCodec:
    """One of several types, told apart by `TAG`.

    Args:
        known: by the tag: the class, its codec, and whether its fields stand beside the tag; else under ``"value"``.
    """
    names = ", ".join(known)

    def encode(value: object) -> JsonValue:
        tag = type(value).__name__
        cls, codec, flat = known.get(tag, (None, None, False))
        if codec is None or type(value) is not cls:
            raise CodecError(f"{shown(value)}: one of {names} is expected")
        body = within(tag, codec.encode, value)
        return {TAG: tag, **body} if flat and isinstance(body, dict) else {TAG: tag, "value": body}

    def decode(document: JsonValue, budget: Budget) -> object:
        tag = document.get(TAG) if isinstance(document, dict) else None
        if not isinstance(document, dict) or not isinstance(tag, str) or tag not in known:
            raise CodecError(f"{shown(tag)}: the '{TAG}' is one of {names}")
        _, codec, flat = known[tag]
        body = {name: item for name, item in document.items() if name != TAG}
        if flat:
            return within(tag, codec.decode, body, budget)
        if set(body) != {"value"}:
            raise CodecError(f"a {tag} stands under 'value', alone")
        return within(tag, codec.decode, body["value"], budget)

    return TypeCodec(encode=encode, decode=decode)


def many_codec(codec: TypeCodec) -> TypeCodec:
    """A list of any length."""

    def encode(value: object) -> JsonValue:
        if type(value) is not tuple:
            raise CodecError(f"{shown(value)}: a tuple is expected")
        document: list[JsonValue] = []
        for item in value:
            try:
                document.append(codec.encode(item))
            except CodecError as fault:
                raise fault.under(len(document)) from None
        return document

    def decode(document: JsonValue, budget: Budget) -> object:
        if not isinstance(document, list):
            raise CodecError(f"{shown(document)}: a list is expected")
        values: list[object] = []
        for item in document:
            try:
                values.append(codec.decode(item, budget))
            except CodecError as fault:
                raise fault.under(len(values)) from None
        return tuple(values)

    return TypeCodec(encode=encode, decode=decode)


def frozenset_codec(codec: TypeCodec) -> TypeCodec:
    """A sorted list."""

    def encode(value: object) -> JsonValue:
        if type(value) is not frozenset:
            raise CodecError(f"{shown(value)}: a frozenset is expected")
        return sorted([codec.encode(item) for item in value], key=json.dumps)

    def decode(document: JsonValue, budget: Budget) -> object:
        if not isinstance(document, list):
            raise CodecError(f"{shown(document)}: a list is expected")
        values = frozenset([within(i, codec.decode, item, budget) for i, item in enumerate(document)])
        if len(values) != len(document):
            raise CodecError("a set holds nothing twice")
        return values

    return TypeCodec(encode=encode, decode=decode)


def mapping_codec(keys: TypeCodec, codec: TypeCodec, *, words: bool) -> TypeCodec:
    """An object where ``words`` says that keys are text, and they are; else a list of pairs."""

    def encode(value: object) -> JsonValue:
        if not isinstance(value, Mapping):
            raise CodecError(f"{shown(value)}: a mapping is expected")
        pairs = [(keys.encode(key), within(str(key), codec.encode, item)) for key, item in value.items()]
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
            values[keys.decode(pair[0], budget)] = within(shown(pair[0]), codec.decode, pair[1], budget)
        if len(values) != len(pairs):
            raise CodecError("a mapping holds no key twice")
        return values

    return TypeCodec(encode=encode, decode=decode)
