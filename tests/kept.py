"""Results that are kept as text, line by line, and compared with what comes out now.

They say that something has changed, not that it is wrong: whoever changes a result on purpose reads the lines that
differ and keeps them with ``MINTPILOT_KEEP=1``. What is right, the laws and oracles beside them say.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path

import numpy as np

from mintpilot.core.message import Message

LEFT_OUT = {"setup", "cells", "frame", "mint", "objects"}
"""Fields that hold much and say little."""


def same_as_kept(file: Path, found: Mapping[str, str]) -> None:
    """Compares with the lines of that file, ``name: text`` each; or keeps these lines, beside those of other names."""
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    known = dict(line.split(": ", 1) for line in lines)
    if os.environ.get("MINTPILOT_KEEP"):
        known.update(found)
        file.write_text("".join(f"{name}: {known[name]}\n" for name in sorted(known)), encoding="utf-8")
    assert found == {name: known.get(name) for name in found}


def plain(value: object, name: str = "", *, digits: int = 1) -> Iterator[str]:
    """A value in lines: numbers with so many digits behind the point, arrays by shape and ends."""
    if isinstance(value, Enum):
        yield f"{name}={value.value}"
    elif isinstance(value, bool | int | None | str | Message):
        yield f"{name}={value}"
    elif isinstance(value, float | np.generic):
        yield f"{name}={float(value):.{digits}f}"
    elif isinstance(value, np.ndarray):
        numbers = value.size and value.dtype.kind in "fi"
        yield f"{name}={value.shape}" + (f" {value.min():.{digits}f} {value.max():.{digits}f}" if numbers else "")
    elif is_dataclass(value):
        yield f"{name}:{type(value).__name__}"
        for one in fields(value):
            if one.name not in LEFT_OUT:
                yield from plain(getattr(value, one.name), f"{name}.{one.name}", digits=digits)
    elif isinstance(value, Mapping):
        for key in sorted(value, key=str):
            yield from plain(value[key], f"{name}[{key}]", digits=digits)
    elif isinstance(value, frozenset | set):
        yield f"{name}={sorted(map(str, value))}"
    elif isinstance(value, tuple | list):
        for i, one in enumerate(value):
            yield from plain(one, f"{name}[{i}]", digits=digits)
