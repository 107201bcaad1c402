"""A folder of records: configuration, shards that only grow, and Parquet made from them."""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import IO

from pydantic import ValidationError

from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.records import Record, TrialRecord, WorldRecord, read_shard
from mintpilot.core.errors import MissingPartError, RecordError

CONFIG = "config.json"
SHARDS = "shards"


class RecordStore:
    """The records of one experiment. Use it as a context manager while writing.

    Each worker's records go to a shard of their own, line by line, never changed again; a run that goes on opens new
    shards, so that a line which was cut off spoils no other.

    Args:
        folder: made where it is not there.
        experiment: what is run. A folder that holds another one is refused; more trials of the same one may be added.

    Raises:
        RecordError: the folder cannot be written or read, or holds records of something else.
    """

    def __init__(self, folder: Path, experiment: Experiment) -> None:
        self.folder = folder
        self._files: dict[str, IO[str]] = {}
        config = folder / CONFIG
        try:
            (folder / SHARDS).mkdir(parents=True, exist_ok=True)
            most = experiment.trials
            if config.exists():
                old = read_config(folder)
                _check_same(old, experiment, folder)
                most = max(most, old.trials)
            _write_whole(config, experiment.model_copy(update={"trials": most}).model_dump_json(indent=1) + "\n")
        except OSError as error:
            raise RecordError(
                f"cannot write to {folder}: {error.strerror}; choose another folder with --out"
            ) from error
        self._run = 1 + max((int(p.stem.split("-")[0]) for p in _shards(folder)), default=0)

    def __enter__(self) -> RecordStore:
        return self

    def __exit__(self, *_: object) -> None:
        for file in self._files.values():
            # What could not be written was told when it was tried; closing tries once more.
            with suppress(OSError):
                file.close()

    def append(self, worker: str, record: Record) -> None:
        """Adds one record; it is on its way to the disk when this returns.

        Raises:
            RecordError: it cannot be written, e.g. since the disk is full. What was written before is kept.
        """
        path = self.folder / SHARDS / f"{self._run:03d}-{worker}.ndjson"
        try:
            if worker not in self._files:
                self._files[worker] = path.open("a", encoding="utf-8")
            self._files[worker].write(record.model_dump_json() + "\n")
            self._files[worker].flush()
        except OSError as error:
            raise RecordError(
                f"cannot write the record to {path}: {error.strerror}; make room and give the same command again: "
                "finished trials are kept and not flown again"
            ) from error


def read_config(folder: Path) -> Experiment:
    """The configuration of a folder.

    Raises:
        RecordError: there is none, or it cannot be used.
    """
    path = folder / CONFIG
    try:
        return Experiment.model_validate_json(path.read_bytes())
    except OSError as error:
        raise RecordError(f"{folder} holds no benchmark ({path}: {error.strerror}); give the folder of one") from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(step) for step in first["loc"])
        raise RecordError(
            f"{path}: {where}: {first['msg']}; it is of another version or was changed: run the benchmark again into "
            "another folder"
        ) from error


def read_records(folder: Path) -> tuple[list[TrialRecord], list[WorldRecord]]:
    """All records of a folder, each once, sorted by cell, seed and method.

    Raises:
        RecordError: a shard cannot be read, or is of another schema.
    """
    trials: dict[tuple[str, int, str], TrialRecord] = {}
    worlds: dict[tuple[str, int], WorldRecord] = {}
    for path in _shards(folder):
        for record in read_shard(path):
            if isinstance(record, TrialRecord):
                trials.setdefault((record.cell, record.seed, record.method), record)
            else:
                worlds.setdefault((record.cell, record.seed), record)
    return [trials[k] for k in sorted(trials)], [worlds[k] for k in sorted(worlds)]


def finished_in(folder: Path) -> frozenset[tuple[str, int, str]]:
    """(cell, seed, method) of all trials that have a record; the method is empty for worlds."""
    trials, worlds = read_records(folder)
    return frozenset({(t.cell, t.seed, t.method) for t in trials} | {(w.cell, w.seed, "") for w in worlds})


def write_parquet(folder: Path) -> tuple[Path, ...]:
    """``trials.parquet`` and ``worlds.parquet`` from the shards, through DuckDB.

    Raises:
        MissingPartError: duckdb is not installed.
        RecordError: they cannot be written.
    """
    try:
        import duckdb
    except ImportError as error:
        raise MissingPartError("duckdb is not installed; pip install 'mintpilot[bench]'") from error
    trials, worlds = read_records(folder)
    made = []
    for name, records in (("trials", trials), ("worlds", worlds)):
        if records:
            made.append(_parquet(duckdb, folder, name, records))
    return tuple(made)


def _parquet(duckdb: object, folder: Path, name: str, records: Iterable[Record]) -> Path:
    target, lines = folder / f"{name}.parquet", folder / f".{name}.ndjson"
    try:
        lines.write_text("".join(record.model_dump_json() + "\n" for record in records), encoding="utf-8")
        quoted = [str(path).replace("'", "''") for path in (lines, target)]
        duckdb.sql(  # type: ignore[attr-defined]
            f"COPY (SELECT * FROM read_json_auto('{quoted[0]}', format='newline_delimited', sample_size=-1, "
            f"maximum_object_size=67108864)) TO '{quoted[1]}' (FORMAT parquet)"
        )
    except (OSError, duckdb.Error) as error:  # type: ignore[attr-defined]
        raise RecordError(f"cannot write {target}: {error}; the shards beside it are whole") from error
    finally:
        lines.unlink(missing_ok=True)
    return target


def _shards(folder: Path) -> list[Path]:
    return sorted((folder / SHARDS).glob("[0-9]*-*.ndjson"))


def _check_same(old: Experiment, new: Experiment, folder: Path) -> None:
    if old.key_data() != new.key_data():
        differ = [
            name
            for name in type(new).model_fields
            if name not in ("trials", "time_limit_s") and getattr(old, name) != getattr(new, name)
        ]
        raise RecordError(
            f"{folder} holds records of another experiment (it differs in {', '.join(differ)}); "
            "choose another folder with --out, or remove that one"
        )


def _write_whole(path: Path, text: str) -> None:
    """Whole or not at all."""
    part = path.with_suffix(".part")
    part.write_text(text, encoding="utf-8")
    os.replace(part, path)  # noqa: PTH105
