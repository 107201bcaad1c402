"""Where two values made of the project's nouns differ first."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping

import numpy as np


def first_difference(expected: object, found: object, *, tolerance: float = 0.0, place: str = "") -> str:
    """The place and the two values of the first difference; empty where there is none.

    Fields that are left out of comparison by their dataclass are left out here. Sets are compared as sets.

    Args:
        expected: what was kept.
        found: what is compared with it.
        tolerance: up to which numbers count as equal, absolutely or relatively.
        place: what stands before the place.
    """
    if isinstance(expected, float | int | np.generic) and isinstance(found, float | int | np.generic):
        return "" if _near(float(expected), float(found), tolerance) else _said(place, expected, found)
    if isinstance(expected, np.ndarray) and isinstance(found, np.ndarray):
        return _of_arrays(expected, found, tolerance, place)
    if type(expected) is not type(found):
        return _said(place, expected, found)
    if dataclasses.is_dataclass(expected):
        for field in dataclasses.fields(expected):
            if field.compare:
                here = f"{place}.{field.name}" if place else field.name
                parts = getattr(expected, field.name), getattr(found, field.name)
                if said := first_difference(*parts, tolerance=tolerance, place=here):
                    return said
        return ""
    if isinstance(expected, tuple | list) and isinstance(found, tuple | list):
        if len(expected) != len(found):
            return f"{place}: {len(expected)} items, and {len(found)} now"
        for number, parts in enumerate(zip(expected, found, strict=True)):
            if said := first_difference(*parts, tolerance=tolerance, place=f"{place}[{number}]"):
                return said
        return ""
    if isinstance(expected, Mapping) and isinstance(found, Mapping):
        if expected.keys() != found.keys():
            return _said(place, sorted(expected), sorted(found))
        for key, value in expected.items():
            if said := first_difference(value, found[key], tolerance=tolerance, place=f"{place}[{key!r}]"):
                return said
        return ""
    return "" if expected == found else _said(place, expected, found)


def _of_arrays(expected: np.ndarray, found: np.ndarray, tolerance: float, place: str) -> str:
    if expected.shape != found.shape:
        return f"{place}: shape {expected.shape}, and {found.shape} now"
    if expected.size == 0 or np.array_equal(expected, found, equal_nan=expected.dtype.kind == "f"):
        return ""
    if expected.dtype.kind in "fiu":
        same = np.isclose(expected, found, rtol=tolerance, atol=tolerance, equal_nan=True)
    else:
        same = np.asarray(expected == found)
    if same.all():
        return ""
    index = tuple(int(i) for i in np.argwhere(~same)[0])
    return _said(f"{place}{list(index)}", expected[index], found[index])


def _near(a: float, b: float, tolerance: float) -> bool:
    return a == b or (math.isnan(a) and math.isnan(b)) or math.isclose(a, b, rel_tol=tolerance, abs_tol=tolerance)


def _said(place: str, expected: object, found: object) -> str:
    return f"{place or 'value'}: {_short(expected)}, and {_short(found)} now"


def _short(value: object) -> str:
    text = repr(value) if not dataclasses.is_dataclass(value) else type(value).__name__
    return text if len(text) <= 120 else f"{text[:117]}..."
