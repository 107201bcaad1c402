"""Policies on disk: ``.npz`` files of numpy, read without pickle, each refused with its name and what is wrong."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import InputError
from mintpilot.core.policy import GridCell
from mintpilot.core.ports import Policy
from mintpilot.policies.grid import MAX_REGIONS, PolicyGrid
from mintpilot.policies.network import NetworkPolicy
from mintpilot.policies.table import TabularPolicy

SUFFIX: Final = ".npz"
_FORMAT: Final = "mintpilot-policy-1"
_LARGEST: Final = 1 << 30
"""Bytes that a file may unpack to."""
_GRID: Final = ("free", "region_cells", "region_sizes", "goals")
Arrays = Mapping[str, NDArray[np.generic]]


def save_policy(path: Path, policy: TabularPolicy | NetworkPolicy) -> None:
    """Writes a policy.

    Raises:
        InputError: the name does not end in ``.npz``, or the file cannot be written.
    """
    if path.suffix != SUFFIX:
        raise InputError(f"{path}: the name of a policy's file ends in {SUFFIX}; give such a one")
    grid = policy.grid
    arrays: dict[str, NDArray[np.generic]] = {
        "format": np.array(_FORMAT),
        "free": grid.free,
        "region_cells": np.concatenate([np.zeros(0, np.int64), *grid.regions]).astype(np.int64),
        "region_sizes": np.array([len(cells) for cells in grid.regions], np.int64),
        "goals": np.array(grid.goals, np.int64).reshape(-1, 3),
    }
    if isinstance(policy, TabularPolicy):
        arrays["values"] = policy.values
    else:
        arrays["edges_per_unit"] = np.array(policy.edges_per_unit)
        for number, (weights, biases) in enumerate(policy.layers):
            arrays[f"weights_{number}"], arrays[f"biases_{number}"] = weights, biases
    try:
        with path.open("wb") as file:
            np.savez_compressed(file, allow_pickle=False, **arrays)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error}; choose another place") from error


def load_policy(path: Path) -> Policy:
    """Reads a policy.

    Raises:
        InputError: there is no such file, it is no policy, truncated, or has values that are none.
    """
    arrays = _read(path)
    try:
        grid = _grid(arrays)
        if "values" in arrays:
            return TabularPolicy(grid, _numbers(arrays, "values"))
        count = sum(name.startswith("weights_") for name in arrays)
        layers = tuple((_numbers(arrays, f"weights_{n}"), _numbers(arrays, f"biases_{n}")) for n in range(count))
        scale = _numbers(arrays, "edges_per_unit")
        if scale.shape != ():
            raise InputError(f"edges_per_unit of shape {scale.shape}: one number it must be")
        return NetworkPolicy(grid, layers, edges_per_unit=float(scale))
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _read(path: Path) -> Arrays:
    again = "Learn it anew (mintpilot policy learn), or give the file of a policy."
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(member.file_size for member in archive.infolist())
        if size > _LARGEST:
            raise InputError(f"{path}: unpacks to {size} bytes; at most {_LARGEST} are read. {again}")
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
    except FileNotFoundError as error:
        raise InputError(f"{path}: there is no such file. {again}") from error
    except InputError:
        raise
    except Exception as error:  # a damaged archive fails in any of a dozen ways
        raise InputError(f"{path}: is truncated, or no file of a policy: {error}. {again}") from error
    if str(arrays.get("format", "")) != _FORMAT:
        raise InputError(f"{path}: is no policy of the form '{_FORMAT}'. {again}")
    return arrays


def _grid(arrays: Arrays) -> PolicyGrid:
    missing = [name for name in _GRID if name not in arrays]
    if missing:
        raise InputError(f"lacks {', '.join(missing)}; learn or export it anew")
    foreign = [name for name in _GRID if arrays[name].dtype != (np.bool_ if name == "free" else np.int64)]
    if foreign:
        raise InputError(f"its grid makes no sense ({', '.join(foreign)} of a wrong type); learn or export it anew")
    free = arrays["free"].astype(bool)
    cells, sizes, goals = (arrays[name].astype(np.int64) for name in _GRID[1:])
    sound = (
        free.ndim == 3
        and cells.ndim == sizes.ndim == 1
        and goals.ndim == 2
        and goals.shape[1] == 3
        and len(goals) > 0
        and len(sizes) <= MAX_REGIONS
        and bool((sizes >= 0).all())
        and int(sizes.sum()) == len(cells)
        and bool(((cells >= 0) & (cells < free.size)).all())
        and bool(((goals >= 0) & (goals < np.array(free.shape))).all())
    )
    if not sound:
        raise InputError(
            f"its grid makes no sense (free {free.shape}, regions {sizes.shape}, goals {goals.shape}); "
            "learn or export it anew"
        )
    places: list[GridCell] = [(int(z), int(y), int(x)) for z, y, x in goals.tolist()]
    regions = tuple(np.split(cells, np.cumsum(sizes)[:-1])) if len(sizes) else ()
    return PolicyGrid(free=free, regions=regions, goals=tuple(places))


def _numbers(arrays: Arrays, name: str) -> NDArray[np.float32]:
    if name not in arrays:
        raise InputError(f"lacks {name}; learn or export it anew")
    found = arrays[name]
    if found.dtype.kind != "f":
        raise InputError(f"{name} are of type {found.dtype}; floating-point numbers they must be. Export it anew")
    return found.astype(np.float32)
