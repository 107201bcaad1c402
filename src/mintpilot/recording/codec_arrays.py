"""numpy arrays in a document, exactly: small ones as nested lists, others compressed."""

from __future__ import annotations

import base64
import math
import zlib

import numpy as np
from numpy.typing import NDArray
from pydantic import JsonValue

from mintpilot.core.geometry import frozen
from mintpilot.recording.codec_parts import Budget, CodecError, TypeCodec, shown

SMALL = 24
"""Arrays of at most this many numbers are written as nested lists, for people."""
MAX_AXES = 8
_LEVEL = 1
"""Of zlib: higher ones take three times as long and save 4 % of flown paths."""
_TYPES = {
    name: np.dtype(name).newbyteorder("<")
    for name in (
        *("bool", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64"),
        *("float16", "float32", "float64"),
    )
}


def array_codec() -> TypeCodec:
    """Arrays of truth values, whole numbers and floats; read-only when decoded.

    ``{"float64": [[1.0, 2.0]]}`` or ``{"dtype", "shape", "data"}``; ``data`` is base64 of zlib of the little-endian
    elements, of which each but the first along the first axis is, read as a whole number, the difference to the one
    before it, and whose bytes are sorted by significance (elements of one byte are left as they are). ``"order": "F"``
    marks arrays that lie in memory with their first axis running fastest; they are written transposed. numpy's
    scalars, which sums over all axes leave, are written as ``{"scalar": array}``.
    """
    return TypeCodec(encode=encode_array, decode=decode_array)


def encode_array(value: object) -> JsonValue:
    """The array as a document. Raises `CodecError` for types of elements that have no exact form here."""
    if isinstance(value, np.generic):
        return {"scalar": encode_array(np.array(value))}
    if type(value) is not np.ndarray:
        raise CodecError(f"{shown(value)}: a numpy array is expected")
    if value.dtype.name not in _TYPES or value.ndim > MAX_AXES:
        raise CodecError(f"an array of {value.dtype} with {value.ndim} axes: convert it to one of {', '.join(_TYPES)}")
    if value.ndim > 1 and value.flags.f_contiguous and not value.flags.c_contiguous:
        return {**_packed(value.T), "order": "F"}
    if 0 < value.size <= SMALL and (value.dtype.kind != "f" or np.isfinite(value).all()):
        listed: JsonValue = value.tolist()
        return {value.dtype.name: listed}
    return _packed(value)


def decode_array(document: JsonValue, budget: Budget) -> NDArray[np.generic] | np.generic:
    """The array, read-only. Raises `CodecError` where the document does not hold exactly one, or one too large."""
    if isinstance(document, dict) and set(document) == {"scalar"}:
        held = _decoded(document["scalar"], budget)
        if held.ndim:
            raise CodecError("a scalar has no axes")
        return held.dtype.type(held[()])
    return _decoded(document, budget)


def _decoded(document: JsonValue, budget: Budget) -> NDArray[np.generic]:
    if not isinstance(document, dict):
        raise CodecError(f"{shown(document)}: an array is expected")
    if len(document) == 1:
        ((name, listed),) = document.items()
        array = _from_list(name, listed, budget)
    elif set(document) | {"order"} == {"dtype", "shape", "data", "order"}:
        array = _unpacked(document, budget)
    else:
        raise CodecError("an array has one field, its type, or dtype, shape and data")
    frozen(array)
    return array


def _packed(array: NDArray[np.generic]) -> dict[str, JsonValue]:
    kind = _TYPES[array.dtype.name]
    raw = np.ascontiguousarray(array, kind).reshape(array.shape)
    size = kind.itemsize
    if size == 1 or not array.ndim or not array.size:
        data = raw.tobytes()
    else:
        bits = raw.view(f"<u{size}")
        steps = np.concatenate([bits[:1], bits[1:] - bits[:-1]])
        data = steps.reshape(-1).view(np.uint8).reshape(-1, size).T.tobytes()
    text = base64.b64encode(zlib.compress(data, _LEVEL)).decode()
    return {"dtype": array.dtype.name, "shape": list(array.shape), "data": text}


def _unpacked(document: dict[str, JsonValue], budget: Budget) -> NDArray[np.generic]:
    name, shape, order = document["dtype"], document["shape"], document.get("order", "C")
    if not isinstance(name, str) or name not in _TYPES:
        raise CodecError(f"{shown(name)}: the elements of an array are one of {', '.join(_TYPES)}")
    if not isinstance(shape, list) or len(shape) > MAX_AXES or not all(type(n) is int and n >= 0 for n in shape):
        raise CodecError(f"an array's shape is at most {MAX_AXES} whole numbers that are not below 0")
    if order not in ("C", "F"):
        raise CodecError(f'{shown(order)}: the order of an array is "C" or "F"')
    sizes = tuple(n for n in shape if isinstance(n, int))
    kind = _TYPES[name]
    flat = _elements(_inflated(document["data"], math.prod(sizes) * kind.itemsize, budget), kind, sizes)
    try:
        array = flat.reshape(sizes)
    except ValueError as error:
        raise CodecError(f"shape {sizes}: {error}") from None
    return array.T if order == "F" else array


def _inflated(data: JsonValue, size: int, budget: Budget) -> bytes:
    """Exactly ``size`` bytes; nothing larger is ever held."""
    if not isinstance(data, str):
        raise CodecError(f"{shown(data)}: an array's data is text in base64")
    budget.take(size)
    try:
        packed = base64.b64decode(data, validate=True)
        machine = zlib.decompressobj()
        raw = machine.decompress(packed, size + 1)
    except (ValueError, zlib.error) as error:
        raise CodecError(f"an array's data cannot be unpacked: {error}") from None
    if len(raw) != size or not machine.eof or machine.unused_data:
        raise CodecError(f"an array's data does not hold the {size} bytes that its shape needs")
    return raw


def _elements(raw: bytes, kind: np.dtype[np.generic], shape: tuple[int, ...]) -> NDArray[np.generic]:
    size = kind.itemsize
    if size == 1:
        if kind.name == "bool" and any(raw.translate(None, b"\0\1")):
            raise CodecError("an array of truth values holds bytes other than 0 and 1")
        return np.frombuffer(raw, kind)
    if not shape or not raw:
        return np.frombuffer(raw, kind)
    bits = np.frombuffer(raw, np.uint8).reshape(size, -1).T.copy().reshape(-1).view(f"<u{size}")
    whole = np.add.accumulate(bits.reshape(shape[0], -1), axis=0, dtype=bits.dtype)
    return whole.reshape(-1).view(kind)


def _from_list(name: str, listed: JsonValue, budget: Budget) -> NDArray[np.generic]:
    kind = _TYPES.get(name)
    if kind is None:
        raise CodecError(f"{shown(name)}: the elements of an array are one of {', '.join(_TYPES)}")
    try:
        array: NDArray[np.generic] = np.array(listed, kind)
    except (ValueError, TypeError, OverflowError) as error:
        raise CodecError(f"no array of {name}: {error}") from None
    budget.take(array.nbytes)
    if array.ndim > MAX_AXES or array.tolist() != listed:
        raise CodecError(f"the list does not hold numbers of the type {name}")
    return array
