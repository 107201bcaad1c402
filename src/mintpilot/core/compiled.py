"""Compiled functions: numba, kept on disk, and compiled anew whenever anything that they were made from has changed.

numba keeps a compiled function as long as the file that defines it stays the same. What that function calls, and the
constants that it reads, are compiled into it, and may stand in other files: after an update of the package it would run
on with what those files said before. Rooms of one layer never import each other, so a room's folder holds all of it.
"""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, TypeVar, cast

from numba import njit

F = TypeVar("F", bound=Callable[..., Any])


def compiled(
    *, error_model: Literal["python", "numpy"] = "python", fastmath: bool = False, nogil: bool = False
) -> Callable[[F], F]:
    """Compiles a function when it is first called, and keeps the result on disk.

    Args:
        error_model: "numpy" makes a division by zero infinite instead of raising.
        fastmath: allows the compiler to reorder sums.
        nogil: lets other threads run meanwhile.
    """

    def decorate(function: F) -> F:
        made: Any = njit(cache=True, error_model=error_model, fastmath=fastmath, nogil=nogil)(function)
        if hasattr(made, "_cache"):  # there is none where compiling is switched off
            made._cache._cache_file._source_stamp = stamp(Path(function.__code__.co_filename).parent)
        return cast(F, made)

    return decorate


@functools.cache
def stamp(folder: Path) -> str:
    """A number that changes with the contents of any source file of a folder."""
    digest = hashlib.sha256()
    for file in sorted(folder.glob("*.py")):
        digest.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()
