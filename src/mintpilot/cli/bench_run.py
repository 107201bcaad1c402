"""What the commands of ``mintpilot bench`` share: running with progress, and telling the results."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from mintpilot.assembly.talk import talk_for
from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.exporting import Format
from mintpilot.benchmark.records import Record
from mintpilot.benchmark.runner import Progress, RunOptions, run_experiment
from mintpilot.benchmark.store import read_config, read_records, write_parquet
from mintpilot.benchmark.summary import Row, Summary, summarise
from mintpilot.benchmark.tables import print_summary
from mintpilot.cli.bench_flags import BenchFlags
from mintpilot.cli.exits import ExitCode
from mintpilot.cli.output import put
from mintpilot.core.errors import MissingPartError, RecordError
from mintpilot.mission_file.schema import LanguageSpec

JSON_VERSION = 1


def run_bench(experiment: Experiment, flags: BenchFlags) -> ExitCode:
    """Runs what is left of the experiment, and prints its tables from the records."""
    errors = Console(stderr=True, highlight=False, soft_wrap=True)
    folder = flags.out or Path("runs") / f"bench-{experiment.name}-{experiment.digest()}"
    with talk_for(LanguageSpec(), llm=experiment.llm):
        pass  # what a model lacks is told now, not once in every trial
    run = RunOptions(
        folder=folder,
        jobs=flags.jobs,
        executor=flags.executor,
        ray_address=flags.ray_address,
        only=frozenset(flags.only),
    )
    try:
        with _Meter(errors, experiment) as meter:
            progress = run_experiment(experiment, run, meter)
    except KeyboardInterrupt:
        errors.print(f"Stopped. Finished trials are in {folder}; the same command goes on from there.")
        raise
    errors.print(_throughput(progress, flags))
    try:
        write_parquet(folder)
    except MissingPartError as error:
        errors.print(f"No Parquet was made, the records stay NDJSON: {error}")
    trials, worlds = read_records(folder)
    last = experiment.seed + experiment.trials
    wanted = [t for t in trials if t.seed < last and (not run.only or t.method in run.only)]
    summary = summarise(experiment, wanted, [w for w in worlds if w.seed < last])
    if flags.json:
        print(json.dumps(as_json(experiment, summary, folder, progress), ensure_ascii=False))
    else:
        print_summary(experiment, summary, Console())
        errors.print(f"Records: {folder}. A page of them: mintpilot bench report {folder}")
    return ExitCode.SUCCESS


def as_json(experiment: Experiment, summary: Summary, folder: Path, progress: Progress) -> dict[str, object]:
    """The object that ``--json`` prints."""
    return {
        "schema_version": JSON_VERSION,
        "experiment": experiment.name,
        "rows": [_row(row) for row in summary.rows],
        "least_possible_queries": summary.least_possible_queries,
        "worlds": summary.worlds,
        "possible_worlds": summary.possible,
        "gaps": [share.model_dump(mode="json") for share in summary.gaps],
        "config": experiment.model_dump(mode="json"),
        "records": str(folder),
        "missions_per_minute": round(progress.per_minute, 1) if progress.done else None,
    }


def write_page(folders: Sequence[Path], out: Path) -> ExitCode:
    """Writes the page of those folders."""
    from mintpilot.benchmark.report import write_report

    write_report([(read_config(folder), *read_records(folder), str(folder)) for folder in folders], out)
    print(out)
    return ExitCode.SUCCESS


def write_tables(folders: Sequence[Path], to: Format, out: Path | None) -> ExitCode:
    """Writes the tables of those folders.

    Raises:
        RecordError: a folder has no records, or the file cannot be written.
    """
    from mintpilot.benchmark.exporting import as_csv, as_latex

    read = [(read_config(folder), *read_records(folder)) for folder in folders]
    summaries = [(experiment, summarise(experiment, trials, worlds)) for experiment, trials, worlds in read]
    if not any(summary.rows for _, summary in summaries):
        raise RecordError("there are no trials in these folders; run a benchmark first")
    text = as_csv(summaries) if to == "csv" else as_latex(summaries)
    put(text, out)
    return ExitCode.SUCCESS


def _row(row: Row) -> dict[str, object]:
    return row.model_dump(mode="json")


def _throughput(progress: Progress, flags: BenchFlags) -> str:
    if not progress.done:
        return f"All {progress.trials} trials had a record already; nothing was flown."
    kept = f" ({progress.before} were finished before)" if progress.before else ""
    return (
        f"{progress.done} missions{kept} in {progress.seconds:.1f} s: {progress.per_minute:.0f} missions per minute, "
        f"{flags.jobs} workers, executor {flags.executor}."
    )


class _Meter:
    """A bar on a terminal; elsewhere a line now and then."""

    def __init__(self, console: Console, experiment: Experiment) -> None:
        self._console = console
        self._label = f"{experiment.name}, {experiment.vehicle}"
        self._bar: Bar | None = None
        self._last_s = 0.0

    def __enter__(self) -> _Meter:
        if self._console.is_terminal:
            columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
            self._bar = Bar(*columns, console=self._console, transient=True)
            self._bar.start()
            self._bar.add_task(self._label, total=None)
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, progress: Progress, _record: Record) -> None:
        """Shows how far it is."""
        done = progress.before + progress.done
        if self._bar is not None:
            self._bar.update(self._bar.task_ids[0], completed=done, total=progress.trials)
        elif progress.seconds - self._last_s >= 30:
            self._last_s = progress.seconds
            self._console.print(f"{self._label}: {done} of {progress.trials}, {progress.per_minute:.0f} per minute")
