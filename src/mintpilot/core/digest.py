"""A digest of a value made of the project's nouns: equal values have equal digests, bit for bit."""

from __future__ import annotations

import dataclasses
import hashlib
import struct
from collections.abc import Mapping
from enum import Enum

import numpy as np


def digest(*values: object) -> str:
    """A short hexadecimal digest of these values with all that they hold.

    Dataclasses count by their type and their compared and uncompared fields alike, arrays by type, shape and bytes,
    mappings and sets in sorted order, floats bit for bit.

    Raises:
        TypeError: something in them is none of these.
    """
    hashed = hashlib.blake2b(digest_size=16)
    for value in values:
        _feed(hashed, value)
    return hashed.hexdigest()


def _feed(hashed: hashlib.blake2b, value: object) -> None:
    if value is None or isinstance(value, bool | int):
        hashed.update(f"{value};".encode())
    elif isinstance(value, float):
        hashed.update(struct.pack("<d", value))
    elif isinstance(value, Enum):
        hashed.update(f"{type(value).__name__}.{value.name};".encode())
    elif isinstance(value, str):
        data = value.encode("utf-8", "surrogatepass")
        hashed.update(f"s{len(data)}:".encode() + data)
    elif isinstance(value, np.ndarray):
        hashed.update(f"{value.dtype.str}{value.shape}".encode())
        hashed.update(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, np.generic):
        _feed(hashed, value.item())
    elif isinstance(value, tuple | list):
        hashed.update(f"({len(value)}".encode())
        for item in value:
            _feed(hashed, item)
    elif isinstance(value, Mapping):
        _feed(hashed, tuple(sorted((digest(key), digest(item)) for key, item in value.items())))
    elif isinstance(value, frozenset | set):
        _feed(hashed, tuple(sorted(digest(item) for item in value)))
    elif dataclasses.is_dataclass(value):
        hashed.update(type(value).__name__.encode())
        for field in dataclasses.fields(value):
            _feed(hashed, getattr(value, field.name))
    else:
        raise TypeError(f"no digest of a {type(value).__name__}: only nouns, arrays and plain values have one")
