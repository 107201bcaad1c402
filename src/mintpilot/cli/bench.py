"""``mintpilot bench``: the paper's experiments and more, by one command each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from cyclopts import App, Parameter

from mintpilot.cli.exits import EPILOGUE, ExitCode, guarded

if TYPE_CHECKING:
    from mintpilot.cli.bench_run import BenchOptions

bench = App(
    name="bench",
    help="Rerun the paper's experiments and more. Every trial is kept as a record; the same command goes on where an "
    "interrupted one stopped, and never flies a finished trial again.",
    help_epilogue=EPILOGUE,
    help_format="plaintext",
    result_action="return_value",
)

Json: TypeAlias = Annotated[bool, Parameter(name="--json", negative="")]
Flag: TypeAlias = Annotated[bool, Parameter(negative="")]
Strategies: TypeAlias = Annotated[list[str], Parameter(name="--strategy", negative="")]
VehicleName: TypeAlias = Literal["mujoco", "kinematic"]
ExecutorName: TypeAlias = Literal["process", "ray"]


@bench.command
def table1(
    *,
    trials: int = 100,
    seed: int = 0,
    jobs: int = 2,
    executor: ExecutorName = "process",
    ray_address: str = "",
    vehicle: VehicleName = "kinematic",
    strategy: Strategies = [],  # noqa: B006
    time_limit: float | None = None,
    out: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Table 1 of the paper: success and questions in a warehouse on fire, every method in the same worlds.

    Args:
        trials: Number of worlds.
        seed: Of the first world; the others follow.
        jobs: Worker processes; with a local Ray, its workers.
        executor: Processes of this machine, or a Ray cluster.
        ray_address: Of a running cluster; without it a local one is started.
        vehicle: A fast point mass, or physics and camera.
        strategy: One more method to compare, e.g. of a plug-in; may be given several times.
        time_limit: Seconds of computing after which a trial counts as failed. Default: 120, with MuJoCo 900.
        out: Folder of the records. Default: one under ./runs, named after the configuration.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work(options: BenchOptions) -> ExitCode:
        from mintpilot.benchmark.experiments import table1 as experiment
        from mintpilot.cli.bench_run import run_bench

        made = experiment(trials=trials, seed=seed, vehicle=vehicle, strategies=strategy, time_limit_s=time_limit)
        return run_bench(made, options)

    return _run(work, jobs, executor, ray_address, out, json=json, debug=debug)


@bench.command
def boxes(
    *,
    trials: int = 20,
    seed: int = 0,
    jobs: int = 2,
    executor: ExecutorName = "process",
    ray_address: str = "",
    vehicle: VehicleName = "mujoco",
    think: float = 3.0,
    strategy: Strategies = [],  # noqa: B006
    time_limit: float | None = None,
    out: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """The paper's real-world task: which box holds the medicine? Through the whole chain, from pictures to flight.

    Args:
        trials: Number of arrangements of boxes.
        seed: Of the first one; the others follow.
        jobs: Worker processes; with a local Ray, its workers.
        executor: Processes of this machine, or a Ray cluster.
        ray_address: Of a running cluster; without it a local one is started.
        vehicle: Physics and camera, or a fast point mass.
        think: Seconds that the scripted person takes for an answer; part of the latency, not waited for.
        strategy: One more method to compare, e.g. of a plug-in; may be given several times.
        time_limit: Seconds of computing after which a trial counts as failed. Default: 900, with a point mass 120.
        out: Folder of the records. Default: one under ./runs, named after the configuration.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work(options: BenchOptions) -> ExitCode:
        from mintpilot.benchmark.experiments import boxes as experiment
        from mintpilot.cli.bench_run import run_bench

        made = experiment(
            trials=trials, seed=seed, vehicle=vehicle, think_s=think, strategies=strategy, time_limit_s=time_limit
        )
        return run_bench(made, options)

    return _run(work, jobs, executor, ray_address, out, json=json, debug=debug)


@bench.command
def gaps(
    *,
    trials: int = 20,
    seed: int = 0,
    jobs: int = 2,
    executor: ExecutorName = "process",
    ray_address: str = "",
    vehicle: VehicleName = "kinematic",
    strategy: Strategies = [],  # noqa: B006
    time_limit: float | None = None,
    out: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Beyond the paper: one to eight gaps, wrong and unsure answers, wrong priors, misplaced detections.

    Args:
        trials: Number of worlds for each of the 16 settings.
        seed: Of the first world; the others follow.
        jobs: Worker processes; with a local Ray, its workers.
        executor: Processes of this machine, or a Ray cluster.
        ray_address: Of a running cluster; without it a local one is started.
        vehicle: A fast point mass, or physics and camera.
        strategy: One more method to compare, e.g. of a plug-in; may be given several times.
        time_limit: Seconds of computing after which a trial counts as failed. Default: 120, with MuJoCo 900.
        out: Folder of the records. Default: one under ./runs, named after the configuration.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work(options: BenchOptions) -> ExitCode:
        from mintpilot.benchmark.experiments import gaps as experiment
        from mintpilot.cli.bench_run import run_bench

        made = experiment(trials=trials, seed=seed, vehicle=vehicle, strategies=strategy, time_limit_s=time_limit)
        return run_bench(made, options)

    return _run(work, jobs, executor, ray_address, out, json=json, debug=debug)


@bench.command
def report(
    folders: Annotated[list[Path], Parameter(negative="")],
    /,
    *,
    out: Path = Path("benchmark.html"),
    debug: Flag = False,
) -> ExitCode:
    """One page that needs nothing else: tables, plots, every trial, side by side.

    Args:
        folders: Folders of records.
        out: The HTML file.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.cli.bench_run import write_page

        return write_page(folders, out)

    return guarded(work, as_json=False, debug=debug)


@bench.command
def language(
    *,
    llm: Annotated[list[str], Parameter(name="--llm", negative="")] = [],  # noqa: B006
    instructions: Path | None = None,
    sample: int = 60,
    out: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Instructions, answers and questions: by rules alone, and what a language model adds.

    Args:
        llm: Model to measure beside the rules: embedded, endpoint, or one of a plug-in; may be given several times.
            Default: those that are there.
        instructions: Ambiguous instructions with their possible objects, in the form of IntroPlan's file.
        sample: So many answers and ambiguous instructions are given to each model.
        out: Folder for language.json. Default: nothing is kept.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.cli.bench_language import bench_language

        return bench_language(llm, instructions=instructions, sample=sample, out=out, as_json=json)

    return guarded(work, as_json=json, debug=debug)


def _run(
    work: Callable[[BenchOptions], ExitCode],
    jobs: int,
    executor: ExecutorName,
    ray_address: str,
    out: Path | None,
    *,
    json: bool,
    debug: bool,
) -> ExitCode:
    def guarded_work() -> ExitCode:
        from mintpilot.cli.bench_run import BenchOptions
        from mintpilot.core.errors import InputError

        if jobs < 1:
            raise InputError(f"--jobs {jobs}: must be 1 or more")
        if ray_address and executor != "ray":
            raise InputError(f"--ray-address {ray_address} is for --executor ray; add that, or leave it out")
        return work(BenchOptions(jobs=jobs, executor=executor, ray_address=ray_address, out=out, as_json=json))

    return guarded(guarded_work, as_json=json, debug=debug)
