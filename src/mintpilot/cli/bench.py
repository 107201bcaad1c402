"""``mintpilot bench``: the paper's experiments and more, by one command each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import App, Parameter

from mintpilot.cli.bench_faults import faults
from mintpilot.cli.bench_flags import BenchFlags, Flag, Json, VehicleName
from mintpilot.cli.bench_perception import perception
from mintpilot.cli.bench_trust import trust
from mintpilot.cli.exits import EPILOGUE, ExitCode, guarded

if TYPE_CHECKING:
    from mintpilot.benchmark.experiment import Experiment

bench = App(
    name="bench",
    help="Rerun the paper's experiments and more. Every trial is kept as a record; the same command goes on where an "
    "interrupted one stopped, and never flies a finished trial again.",
    help_epilogue=EPILOGUE,
    help_format="plaintext",
    result_action="return_value",
)

bench.command(faults)
bench.command(perception)
bench.command(trust)
_USUAL = BenchFlags()


@bench.command
def table1(
    *,
    trials: int = 100,
    vehicle: VehicleName = "kinematic",
    think: str = "5",
    spare: float | None = None,
    flags: BenchFlags = _USUAL,
) -> ExitCode:
    """Table 1 of the paper: success and questions in a warehouse on fire, every method in the same worlds.

    Args:
        trials: Number of worlds.
        vehicle: A fast point mass, or physics and camera.
        think: Seconds that the scripted person takes for an answer, or two bounds: 2..8. The battery runs meanwhile.
        spare: Seconds that the battery lasts longer for each gap. Default: 10, or 0 with --think 0.
        flags: What all experiments share.
    """

    def made() -> Experiment:
        from mintpilot.benchmark.experiments import table1 as experiment

        return experiment(
            trials=trials,
            seed=flags.seed,
            vehicle=vehicle,
            think=think,
            spare_s=spare,
            strategies=flags.strategy,
            llm=flags.llm,
            time_limit_s=flags.time_limit,
        )

    return _run(made, flags)


@bench.command
def boxes(
    *, trials: int = 20, vehicle: VehicleName = "mujoco", think: str = "5", flags: BenchFlags = _USUAL
) -> ExitCode:
    """The paper's real-world task: which box holds the medicine? Through the whole chain, from pictures to flight.

    Args:
        trials: Number of arrangements of boxes.
        vehicle: Physics and camera, or a fast point mass.
        think: Seconds that the scripted person takes for an answer, or two bounds: 2..8. The drone waits for them.
        flags: What all experiments share.
    """

    def made() -> Experiment:
        from mintpilot.benchmark.experiments import boxes as experiment

        return experiment(
            trials=trials,
            seed=flags.seed,
            vehicle=vehicle,
            think=think,
            strategies=flags.strategy,
            llm=flags.llm,
            time_limit_s=flags.time_limit,
        )

    return _run(made, flags)


@bench.command
def gaps(
    *,
    trials: int = 20,
    vehicle: VehicleName = "kinematic",
    think: str = "5",
    spare: float | None = None,
    flags: BenchFlags = _USUAL,
) -> ExitCode:
    """Beyond the paper: one to eight gaps, wrong and unsure answers, wrong priors, misplaced detections.

    Args:
        trials: Number of worlds for each of the 16 settings.
        vehicle: A fast point mass, or physics and camera.
        think: Seconds that the scripted person takes for an answer, or two bounds: 2..8. The battery runs meanwhile.
        spare: Seconds that the battery lasts longer for each gap. Default: 10, or 0 with --think 0.
        flags: What all experiments share.
    """

    def made() -> Experiment:
        from mintpilot.benchmark.experiments import gaps as experiment

        return experiment(
            trials=trials,
            seed=flags.seed,
            vehicle=vehicle,
            think=think,
            spare_s=spare,
            strategies=flags.strategy,
            llm=flags.llm,
            time_limit_s=flags.time_limit,
        )

    return _run(made, flags)


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
def export(
    folders: Annotated[list[Path], Parameter(negative="")],
    /,
    *,
    to: Annotated[Literal["csv", "latex"], Parameter(name="--to")] = "csv",
    out: Path | None = None,
    debug: Flag = False,
) -> ExitCode:
    """The tables of those folders as CSV or LaTeX, for a paper or a notebook.

    Args:
        folders: Folders of records.
        to: CSV with every figure, or LaTeX tables (package booktabs).
        out: The file. Default: standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.cli.bench_run import write_tables

        return write_tables(folders, to, out)

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
        instructions: Instructions with the steps that they mean, as in bench/data/instructions.tsv.
        sample: So many answers are given to each model.
        out: Folder for language.json. Default: nothing is kept.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.cli.bench_language import bench_language

        return bench_language(llm, instructions=instructions, sample=sample, out=out, as_json=json)

    return guarded(work, as_json=json, debug=debug)


@bench.command
def voice(
    *,
    clips: Path | None = None,
    most: int | None = None,
    voices: int = 8,
    kokoro: Path | None = None,
    alone: float = 0.0,
    out: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """How answers are heard: recordings and synthesised phrases, clean and beside made rotor noise. Resumable by --out.

    Args:
        clips: Folder of WAV files in yes, no and unknown. Default: synthesised phrases only.
        most: Recordings of each kind. Default: all.
        voices: Number of synthesised voices, 0 to 8.
        kokoro: Folder "voices" of the npm package kokoro-js 1.2.1: four of those voices are spoken with as well.
            Needs the extra "voice-bench".
        alone: Hours of rotors, and as many of silence, in which nobody speaks.
        out: Folder of records. Default: nothing is kept.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.benchmark.voice_report import VoiceOptions
        from mintpilot.cli.bench_voice import bench_voice

        options = VoiceOptions(clips=clips, most=most, voices=voices, kokoro=kokoro, alone_h=alone, out=out)
        return bench_voice(options, as_json=json)

    return guarded(work, as_json=json, debug=debug)


def _run(made: Callable[[], Experiment], flags: BenchFlags) -> ExitCode:
    def work() -> ExitCode:
        from mintpilot.cli.bench_run import run_bench

        flags.check()
        return run_bench(made(), flags)

    return guarded(work, as_json=flags.json, debug=flags.debug)
