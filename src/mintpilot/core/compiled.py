"""Compiled functions: numba, kept on disk, and compiled anew whenever anything that they were made from has changed.

numba keeps a compiled function as long as the file that defines it stays the same. What that function calls, and the
constants that it reads, are compiled into it, and may stand in other files: after an update of the package it would run
on with what those files said before. Rooms of one layer never import each other, so a room's folder holds all of it.

numba itself is imported with the first call of a compiled function, not with the module that defines it: reading and
checking a mission file compiles nothing, and should not wait for a compiler.
"""

from __future__ import annotations

import functools
import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, TypeVar, cast

NOT_KEPT = (
    "Compiled searches cannot be kept on this machine: they are compiled again at every start, which takes a minute. "
    "Set NUMBA_CACHE_DIR to a folder that may be written."
)
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
        return cast(F, Compiled(function, error_model=error_model, fastmath=fastmath, nogil=nogil))

    return decorate


class Compiled:
    """A function that numba compiles; called like the function, from Python and from other compiled functions.

    Args:
        function: what is compiled.
        options: those of ``numba.njit``.
    """

    def __init__(self, function: Callable[..., Any], **options: Any) -> None:
        functools.update_wrapper(self, function)
        self._options = options

    def __call__(self, *arguments: Any) -> Any:
        """The function's value."""
        return self.dispatcher(*arguments)

    @functools.cached_property
    def dispatcher(self) -> Any:
        """What numba makes of the function; it holds the compiled code of every signature."""
        from numba import njit

        _teach_numba()
        function: Any = self.__wrapped__  # type: ignore[attr-defined]  # set by `functools.update_wrapper`
        try:
            made: Any = njit(cache=True, **self._options)(function)
        except RuntimeError:  # no folder can be written (`can_keep`): compiled for this process alone
            return njit(**self._options)(function)
        if hasattr(made, "_cache"):  # there is none where compiling is switched off
            made._cache._cache_file._source_stamp = stamp(Path(function.__code__.co_filename).parent)
        return made


def can_keep() -> bool:
    """Whether there is a folder to keep compiled functions in: numba's own, the package's, or the user's cache."""
    user = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")  # noqa: PTH111  (without a home: as it is)
    chosen = os.environ.get("NUMBA_CACHE_DIR", "")
    places = [Path(place) for place in (chosen, str(Path(__file__).parent), user) if os.path.isabs(place)]  # noqa: PTH117
    return any(os.access(_nearest(place), os.W_OK) for place in places)


def _nearest(folder: Path) -> Path:
    """The folder, or the nearest one above that exists."""
    return next((place for place in (folder, *folder.parents) if place.exists()), folder)


@functools.cache
def _teach_numba() -> None:
    """Compiled functions call each other: numba takes a `Compiled` for the dispatcher that it holds."""
    from numba.core.types import Dispatcher
    from numba.extending import typeof_impl

    @typeof_impl.register(Compiled)
    def type_of(value: Compiled, _context: object) -> object:
        return Dispatcher(value.dispatcher)


@functools.cache
def stamp(folder: Path) -> str:
    """A number that changes with the contents of any source file of a folder."""
    digest = hashlib.sha256()
    for file in sorted(folder.glob("*.py")):
        digest.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()
