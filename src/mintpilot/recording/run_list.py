"""The runs in a folder: what they were, and which may go."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mintpilot.core.errors import InputError, RecordError
from mintpilot.recording.event_log import EVENTS_FILE, read_event_log


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """One recorded mission."""

    path: Path
    name: str
    begun_s: float
    """Seconds since 1970."""
    outcome: str
    """How it ended; ``broken-off`` where it was not closed, ``unreadable`` where nothing can be told."""
    size_bytes: int


def listed(folder: Path) -> tuple[Run, ...]:
    """All runs directly in that folder, newest first.

    Raises:
        RecordError: it cannot be read.
    """
    try:
        inside = sorted(path for path in folder.iterdir() if (path / EVENTS_FILE).is_file()) if folder.exists() else []
    except OSError as error:
        raise RecordError(f"cannot read {folder}: {error.strerror}; give a folder of runs") from error
    return tuple(sorted((_run(path) for path in inside), key=lambda run: (-run.begun_s, run.path.name)))


def to_remove(
    runs: Sequence[Run], now_s: float, *, older_than_days: float | None = None, keep: int | None = None
) -> tuple[Run, ...]:
    """Those older than so many days, and those beyond the newest so many; with both, those that are both.

    Args:
        runs: newest first.
        now_s: seconds since 1970.
        older_than_days: None: age does not count.
        keep: None: the number does not count.

    Raises:
        InputError: neither is given, or one is negative.
    """
    if older_than_days is None and keep is None:
        raise InputError("--prune needs --older-than DAYS or --keep COUNT")
    if (older_than_days is not None and not older_than_days >= 0) or (keep is not None and keep < 0):
        raise InputError(f"--older-than {older_than_days}, --keep {keep}: must not be negative")
    old = {run.path for run in runs if older_than_days is None or now_s - run.begun_s > older_than_days * 86_400}
    many = {run.path for n, run in enumerate(runs) if keep is None or n >= keep}
    return tuple(run for run in runs if run.path in old & many)


def remove(run: Run) -> None:
    """Removes the folder of a run. Raises `RecordError` when it cannot."""
    if run.path.is_symlink() or not (run.path / EVENTS_FILE).is_file():
        raise RecordError(f"{run.path} is no run folder; it is left alone")
    try:
        shutil.rmtree(run.path)
    except OSError as error:
        raise RecordError(f"cannot remove {run.path}: {error.strerror}") from error


def _run(path: Path) -> Run:
    size = sum(file.stat().st_size for file in path.rglob("*") if file.is_file() and not file.is_symlink())
    name, outcome, begun_s = path.name, "unreadable", path.stat().st_mtime
    try:
        begun_s = read_event_log(path).begun_s
        record = json.loads((path / "record.json").read_bytes())
        name = str(record["name"])
        outcome = str(record["outcome"]) if record["complete"] else "broken-off"
    except (RecordError, OSError, ValueError, KeyError, TypeError, RecursionError):
        pass
    return Run(path=path, name=name, begun_s=begun_s, outcome=outcome, size_bytes=size)
