"""What codecs are made of: faults with their place, bounds on memory, and the scalars."""

from __future__ import annotations

import base64
import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np
from pydantic import JsonValue

from mintpilot.core.errors import RecordError

MAX_DECODED_BYTES = 256 * 2**20
"""Arrays of one document may unpack to this much in all; a crafted length or archive is refused before it is held."""


class CodecError(RecordError):
    """A value or a part of a document breaks a rule; the place is added on the way out.

    Attributes:
        rule: the offending value, the rule that it breaks, the next step.
        steps: field names and indices that lead there, innermost first.
    """

    def __init__(self, rule: str) -> None:
        super().__init__(rule)
        self.rule = rule
        self.steps: list[str | int] = []

    def under(self, step: str | int) -> CodecError:
        """The same fault, seen from one level further out."""
        self.steps.append(step)
        return self

    def told(self, root: str = "") -> str:
        """Place and rule in one line, e.g. ``LegFlown.log.time_s: …``."""
        path = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in reversed(self.steps))
        return f"{(root + path).lstrip('.') or 'value'}: {self.rule}"


@dataclass(slots=True)
class Budget:
    """Memory that decoding one document may still take, bytes."""

    left: int = MAX_DECODED_BYTES

    def take(self, count: int) -> None:
        """Accounts for an array before it is unpacked. Raises `CodecError` when there is no room for it."""
        if count > self.left:
            raise CodecError(f"arrays of more than {MAX_DECODED_BYTES} bytes in one document: no record needs so many")
        self.left -= count


@dataclass(slots=True, kw_only=True)
class TypeCodec:
    """Both ways for the values of one type; either raises `CodecError`."""

    encode: Callable[[object], JsonValue]
    decode: Callable[[JsonValue, Budget], object]


def shown(value: object) -> str:
    """A value in a message: its beginning is enough."""
    text = repr(value) if isinstance(value, str | int | float | type(None)) else type(value).__name__
    return text if len(text) <= 60 else text[:57] + "…"


def text_codec() -> TypeCodec:
    """Strings. Those that are no Unicode text (lone surrogates) are written as ``{"surrogates": base64}``."""
    return TypeCodec(encode=encode_text, decode=lambda document, _: decode_text(document))


def encode_text(value: object) -> JsonValue:
    """A string, as it stands in a document."""
    if not isinstance(value, str):
        raise CodecError(f"{shown(value)}: text is expected")
    if value.isascii():
        return value
    try:
        value.encode()
    except UnicodeEncodeError:
        return {"surrogates": base64.b64encode(value.encode("utf-8", "surrogatepass")).decode()}
    return value


def decode_text(document: JsonValue) -> str:
    """The string that stands in a document so."""
    if isinstance(document, str):
        return document
    held = document.get("surrogates") if isinstance(document, dict) and len(document) == 1 else None
    if not isinstance(held, str):
        raise CodecError(f"{shown(document)}: text is expected")
    try:
        return base64.b64decode(held, validate=True).decode("utf-8", "surrogatepass")
    except ValueError:
        raise CodecError(f"{shown(held)}: base64 of UTF-8 with surrogates is expected") from None


def bool_codec() -> TypeCodec:
    """Truth values."""

    def encode(value: object) -> JsonValue:
        if isinstance(value, bool | np.bool_):
            return bool(value)
        raise CodecError(f"{shown(value)}: true or false is expected")

    return TypeCodec(encode=encode, decode=lambda document, _: encode(document))


def int_codec() -> TypeCodec:
    """Whole numbers of any size; numpy's become Python's."""

    def encode(value: object) -> JsonValue:
        if type(value) is int or type(value) is bool:
            return value
        if isinstance(value, int | np.integer):
            return int(value)
        raise CodecError(f"{shown(value)}: a whole number is expected")

    return TypeCodec(encode=encode, decode=lambda document, _: encode(document))


def float_codec() -> TypeCodec:
    """Numbers, exactly; numpy's become Python's. Whole numbers stay whole; ``"inf"``, ``"-inf"`` and ``"nan"``."""
    return TypeCodec(encode=_encode_float, decode=lambda document, _: _decode_float(document))


def _encode_float(value: object) -> JsonValue:
    if type(value) is float:
        return value if math.isfinite(value) else _odd_float(value)
    if type(value) is int or type(value) is bool:
        return value
    plain = value.item() if isinstance(value, np.generic) else value
    if isinstance(plain, float):
        return _encode_float(float(plain))
    if isinstance(plain, int):
        return int(plain)
    raise CodecError(f"{shown(value)}: a number of double precision is expected")


def _odd_float(value: float) -> str:
    if value == math.inf:
        return "inf"
    if value == -math.inf:
        return "-inf"
    bits = struct.pack(">d", value).hex()
    return "nan" if bits == "7ff8000000000000" else f"nan:{bits}"


def _decode_float(document: JsonValue) -> float:
    if isinstance(document, float | int):
        return document
    known = {"inf": math.inf, "-inf": -math.inf, "nan": math.nan}
    if isinstance(document, str):
        if document in known:
            return known[document]
        if document.startswith("nan:") and len(document) == 20:
            try:
                value: float = struct.unpack(">d", bytes.fromhex(document[4:]))[0]
            except (ValueError, struct.error):
                value = 0.0
            if math.isnan(value):
                return value
    raise CodecError(f'{shown(document)}: a number is expected, or "inf", "-inf", "nan"')


def none_codec() -> TypeCodec:
    """Nothing but None."""

    def encode(value: object) -> JsonValue:
        if value is not None:
            raise CodecError(f"{shown(value)}: null is expected")
        return None

    return TypeCodec(encode=encode, decode=lambda document, _: encode(document))


def enum_codec(cls: type[Enum]) -> TypeCodec:
    """Members of an enumeration: by value where all values are text, else by name."""
    members = tuple(cls)
    by_value = all(isinstance(member.value, str) for member in members)
    words = {member: str(member.value) if by_value else member.name for member in members}
    known = {word: member for member, word in words.items()}

    def encode(value: object) -> JsonValue:
        if type(value) is not cls or value not in words:
            raise CodecError(f"{shown(value)}: a member of {cls.__name__} is expected")
        return words[value]

    def decode(document: JsonValue, _: Budget) -> object:
        if not isinstance(document, str) or document not in known:
            raise CodecError(f"{shown(document)}: {cls.__name__} knows {', '.join(known)}")
        return known[document]

    return TypeCodec(encode=encode, decode=decode)


def literal_codec(choices: tuple[object, ...]) -> TypeCodec:
    """One of a few constants: text, whole numbers, truth values."""

    def check(value: object) -> JsonValue:
        for choice in choices:
            if type(value) is type(choice) and value == choice and isinstance(value, str | int):
                return value
        raise CodecError(f"{shown(value)}: one of {', '.join(map(repr, choices))} is expected")

    return TypeCodec(encode=check, decode=lambda document, _: check(document))
