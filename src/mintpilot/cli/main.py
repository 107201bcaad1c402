"""The program ``mintpilot``: commands and options. What they do is in the files beside this one."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from io import TextIOWrapper
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from cyclopts import App, CycloptsError, Parameter, validators

from mintpilot import __version__
from mintpilot.cli.bench import bench
from mintpilot.cli.exits import EPILOGUE, ExitCode, fail, guarded, verdict_on
from mintpilot.cli.exporting import export
from mintpilot.cli.interrupts import listen
from mintpilot.cli.logs import log, runs
from mintpilot.cli.policies import policy
from mintpilot.cli.simulating import sim
from mintpilot.cli.understand_answer import answer
from mintpilot.cli.understand_instruction import instruction
from mintpilot.core.errors import InputError

app = App(
    name="mintpilot",
    help="Lets a drone ask instead of guess: it finds what it does not know, asks the fewest yes/no questions that "
    "matter, and flies safely.",
    help_epilogue=EPILOGUE,
    version=__version__,
    help_format="plaintext",
    result_action="return_value",
)

Json: TypeAlias = Annotated[bool, Parameter(name="--json", negative="")]
Flag: TypeAlias = Annotated[bool, Parameter(negative="")]
Seed: TypeAlias = Annotated[int | None, Parameter(name="--seed")]
StrategyArgs: TypeAlias = Annotated[list[str] | None, Parameter(name="--strategy-arg", negative="")]
Llm: TypeAlias = Annotated[str | None, Parameter(name="--llm")]
Lang: TypeAlias = Annotated[str | None, Parameter(name="--lang")]
Operators: TypeAlias = Annotated[list[str] | None, Parameter(name="--operator", negative="")]
Port: TypeAlias = Annotated[int | None, Parameter(validator=validators.Number(gte=0, lte=65535))]
VehicleName: TypeAlias = Literal["mujoco", "kinematic"]


def examples(*lines: str) -> str:
    """What stands at the end of a command's help: ways to call it, then the exit codes."""
    return "\n".join(("Examples:", *(f"  {line}" for line in lines), "", EPILOGUE))


@app.command(
    help_epilogue=examples(
        "mintpilot demo",
        "mintpilot demo medicine --seed 3",
        "mintpilot demo --headless --json",
    )
)
def demo(
    mission: Literal["fire-warehouse", "medicine"] = "fire-warehouse",
    /,
    *,
    headless: Flag = False,
    vehicle: VehicleName = "mujoco",
    think: str | None = None,
    seed: Seed = None,
    llm: Llm = None,
    lang: Lang = None,
    out: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Fly one of the paper's two missions and show it.

    On a terminal the drone asks you; where a browser can be opened, on a page as well.

    Args:
        mission: The warehouse on fire, or the boxes of which one holds the medicine.
        headless: Ask nobody: a scripted operator that knows the truth answers.
        vehicle: Physics and camera, or a fast point mass.
        think: Seconds that the scripted operator takes for an answer, or two bounds: 2..8. Default: 0.
        seed: Draws another world; the same seed gives the same mission. Default: 0.
        llm: Language model for words: template (none), endpoint, embedded, or a plug-in's. Default: as the file says.
        lang: Language of the questions: en, de, fr or es. Default: as the file says.
        out: Run folder; a new one under ./runs by default.
        json: Print the outcome, questions, gaps and figures as one JSON object, and nothing else, on standard output.
            The whole record is in the run folder.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.demos import demo_path
    from mintpilot.cli.fly import FlightOptions, fly
    from mintpilot.cli.web_page import BESIDE_S, PageOptions, browser_can_open

    options = FlightOptions(
        operators=("scripted",) if headless else (),
        page=PageOptions(opens=True, patience_s=BESIDE_S) if not headless and not json and browser_can_open() else None,
        vehicle=vehicle,
        strategy="mint",
        think=think,
        seed=seed,
        out=out,
        as_json=json,
        llm=llm,
        lang=lang,
    )
    return guarded(lambda: fly(demo_path(mission), options), as_json=json, debug=debug)


@app.command(
    help_epilogue=examples(
        "mintpilot run examples/medicine.yaml",
        "mintpilot run examples/medicine.yaml --vehicle kinematic --seed 7 --json",
        "mintpilot run examples/medicine.yaml --strategy knowno --strategy-arg quantile=0.8",
    )
)
def run(
    mission: Path,
    /,
    *,
    operator: Operators = None,
    vehicle: str = "mujoco",
    strategy: str = "mint",
    strategy_arg: StrategyArgs = None,
    planner: str = "grid",
    think: str | None = None,
    seed: Seed = None,
    llm: Llm = None,
    lang: Lang = None,
    perception: str | None = None,
    map: Path | None = None,
    accept_failsafes: Flag = False,
    camera: str = "",
    host: str | None = None,
    port: Port = None,
    tls_cert: Path | None = None,
    tls_key: Path | None = None,
    tls_self_signed: Path | None = None,
    volume: float | None = None,
    speech_speed: float | None = None,
    listen_to: Path | None = None,
    out: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Fly a mission file and write its run folder.

    Args:
        mission: The mission file (YAML).
        operator: Who answers: terminal (you here), console (you on a web page), voice, or scripted (a script that
            knows the truth). Several at once, joined by commas or given several times: the first answer counts.
            Default: terminal, where there is one.
        vehicle: mujoco: physics and camera; kinematic: a fast point mass; or a real one by its address, e.g.
            mavlink://udpin:127.0.0.1:14540.
        strategy: How it decides what to ask.
        strategy_arg: NAME=VALUE, an argument of the strategy; may be given several times. Overrides that of the file.
        planner: Who plans: grid; policy (by exact values), policy:FILE.npz (by learned ones); or a plug-in's.
        think: Seconds that the scripted operator takes for an answer, or two bounds: 2..8. Default: as the file says.
        seed: Of everything that is drawn at random; overrides the one in the file.
        llm: Language model for words: template (none), endpoint, embedded, or a plug-in's. Default: as the file says.
        lang: Language of the questions: en, de, fr or es. Default: as the file says.
        perception: Who makes objects of pictures: geometric, segments, or a plug-in's. Default: as the file says.
        map: Run folder of an earlier mission in the same place: this one begins with its map, in place of a survey. Its
            age is told; what was free is looked at again as it comes into view; what was permitted is asked again.
        accept_failsafes: Fly a real vehicle although its autopilot's fail-safes are not as they should be.
        camera: Of a real vehicle: where its pictures come from: realsense:, sim://127.0.0.1:PORT, a recording as for
            'see', or a plug-in's. The map is then made in flight. Default: none, the map is given.
        host: Of the web page: where it is served. Default: 127.0.0.1, for this machine only; elsewhere with TLS only.
        port: Of the web page. Default: any that is free.
        tls_cert: Of the web page: its certificate, PEM.
        tls_key: Of the web page: the certificate's key, PEM.
        tls_self_signed: Of the web page: a folder in which a self-signed pair is made, and used again next time.
            Browsers warn of it once; its fingerprint is printed.
        volume: Of questions that are said: 0 (captions only) to 1. Default: 1.
        speech_speed: Of questions that are said: 0.5 to 2. Default: 1.
        listen_to: A WAV file, or a pipe of 16-bit samples at 16 kHz, heard in the microphone's place. Nothing is
            played then.
        out: Run folder; a new one under ./runs by default.
        json: Print the outcome, questions, gaps and figures as one JSON object, and nothing else, on standard output.
            The whole record is in the run folder.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.fly import FlightOptions, VoiceFlags, fly, operator_names
    from mintpilot.cli.web_page import BESIDE_S, PageOptions

    try:
        people = operator_names(operator or ())
        sounds = VoiceFlags(
            listen_to=listen_to,
            volume=1.0 if volume is None else volume,
            speed=1.0 if speech_speed is None else speech_speed,
        )
    except InputError as error:
        return fail(str(error), as_json=json)
    page = None
    if "console" in people:
        patience_s = BESIDE_S if len(people) > 1 else None
        if tls_self_signed is not None and (tls_cert, tls_key) != (None, None):
            return fail("--tls-self-signed makes a pair: leave out --tls-cert and --tls-key", as_json=json)
        page = PageOptions(
            host=host or "127.0.0.1",
            port=port or 0,
            tls_cert=tls_cert,
            tls_key=tls_key,
            tls_self_signed=tls_self_signed,
            patience_s=patience_s,
        )
    elif (host, port, tls_cert, tls_key, tls_self_signed) != (None,) * 5:
        return fail("--host, --port and --tls-... go with --operator console only", as_json=json)
    if "voice" not in people and (volume, speech_speed, listen_to) != (None,) * 3:
        return fail("--volume, --speech-speed and --listen-to go with --operator voice only", as_json=json)
    options = FlightOptions(
        operators=people,
        page=page,
        voice=sounds,
        vehicle=vehicle,
        strategy=strategy,
        strategy_args=tuple(strategy_arg or ()),
        planner=planner,
        think=think,
        seed=seed,
        out=out,
        as_json=json,
        llm=llm,
        lang=lang,
        perception=perception,
        earlier=map,
        accept_failsafes=accept_failsafes,
        camera=camera,
    )
    return guarded(lambda: fly(mission, options), as_json=json, debug=debug)


@app.command(
    help_epilogue=examples(
        "mintpilot preflight examples/medicine.yaml --vehicle mavlink://udpin:127.0.0.1:14540",
    )
)
def preflight(
    mission: Path, /, *, vehicle: str, accept_failsafes: Flag = False, json: Json = False, debug: Flag = False
) -> ExitCode:
    """Look at a real vehicle on the ground: link, position, home, fence, fail-safes, battery against the plan's needs.

    Fail-safes and fence are set as the mission needs them, and read back.

    Args:
        mission: The mission file (YAML).
        vehicle: Its address: mavlink://udpin:127.0.0.1:14540, mavlink://serial:/dev/ttyUSB0:57600.
        accept_failsafes: Leave the autopilot's fail-safes as they are.
        json: Print a list of JSON objects, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.preflight import check_vehicle_for

    return guarded(
        lambda: check_vehicle_for(mission, vehicle, accept_failsafes=accept_failsafes, as_json=json),
        as_json=json,
        debug=debug,
    )


@app.command(
    name="vehicle-double",
    help_epilogue=examples(
        "mintpilot vehicle-double px4 --port 14540",
        "mintpilot vehicle-double ardupilot --port 14550 --fault pilot@40 --mission examples/medicine.yaml",
    ),
)
def vehicle_double(
    flavour: Literal["px4", "ardupilot"],
    /,
    *,
    port: Annotated[int, Parameter(validator=validators.Number(gte=1, lte=65535))] = 14540,
    fault: Annotated[list[str] | None, Parameter(negative="")] = None,
    mission: Path | None = None,
    camera: int | None = None,
    seed: Seed = None,
    debug: Flag = False,
) -> ExitCode:
    """Run a test double of an autopilot: it speaks MAVLink over UDP on this machine. It is no firmware.

    Args:
        flavour: Whose ways it has.
        port: Where it sends to.
        fault: NAME@SECONDS, what goes wrong, and when; may be given several times. Names: silence, heartbeat,
            refuse-arm, position-lost, position-jump, delay, reorder, duplicate, corrupt, pilot, battery, no-gripper.
        mission: The mission in whose world it flies. Default: nothing is around it.
        camera: Port for pictures of that world, drawn where the double says it is: the frame source sim://127.0.0.1:PORT.
            Default: none.
        seed: Of the world, and of what is drawn at random. Default: as the file says.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.vehicle_double import serve_double

    return guarded(lambda: serve_double(flavour, port, fault or [], mission, seed, camera), as_json=False, debug=debug)


@app.command(
    help_epilogue=examples(
        "mintpilot plan examples/my-building/mission.yaml",
        "mintpilot plan examples/my-building/mission.yaml --json",
    )
)
def plan(
    mission: Path,
    /,
    *,
    strategy: str = "mint",
    strategy_arg: StrategyArgs = None,
    planner: str = "grid",
    seed: Seed = None,
    llm: Llm = None,
    lang: Lang = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Think about a mission without flying it: gaps, tree, plan classes, the next question, how many to expect.

    A map of your own needs no simulator.

    Args:
        mission: The mission file (YAML).
        strategy: How it decides what to ask.
        strategy_arg: NAME=VALUE, an argument of the strategy; may be given several times. Overrides that of the file.
        planner: Who plans: grid; policy (by exact values), policy:FILE.npz (by learned ones); or a plug-in's.
        seed: Of everything that is drawn at random; overrides the one in the file.
        llm: Language model for words: template (none), endpoint, embedded, or a plug-in's. Default: as the file says.
        lang: Language of the questions: en, de, fr or es. Default: as the file says.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.think import think

    return guarded(
        lambda: think(
            mission,
            strategy=strategy,
            strategy_args=strategy_arg or (),
            planner=planner,
            seed=seed,
            llm=llm,
            lang=lang,
            as_json=json,
        ),
        as_json=json,
        debug=debug,
    )


@app.command(
    help_epilogue=examples(
        "mintpilot see recording/ --instruction 'bring me the can' --out seen",
        "mintpilot see --color color.png --depth depth.png --intrinsics camera.json --depth-unit 0.001 --json",
        "mintpilot see sim:medicine-boxes",
    )
)
def see(
    source: str = "",
    /,
    *,
    instruction: str | None = None,
    color: Path | None = None,
    depth: Path | None = None,
    intrinsics: Path | None = None,
    depth_unit: float | None = None,
    every: Annotated[int, Parameter(validator=validators.Number(gte=1))] = 1,
    longest: Annotated[int, Parameter(validator=validators.Number(gte=1))] = 200,
    perception: str = "segments",
    namer: Annotated[list[str], Parameter(name="--namer", negative="")] = [],  # noqa: B006
    calibration: Path | None = None,
    seed: Seed = None,
    out: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Make map, objects and gaps of pictures that were taken elsewhere, without a flight.

    Its folder is a world for plan and run: `world: {seen: DIR}` in a mission file.

    Args:
        source: A folder in TUM layout, or with color/, depth/ and trajectory.log; a ROS 2 bag; realsense:;
            sim:SCENARIO. Not for a single picture.
        instruction: What is to be done: what bears on it is listed as not known.
        color: A single picture's colours; goes with --depth.
        depth: A single picture's depth, 16 bit.
        intrinsics: The lens, JSON or YAML. Default: the source's own, else a Kinect's.
        depth_unit: Metres in one step of the depth. Default: 0.001, for TUM 0.0002.
        every: Use each n-th frame only.
        longest: Use no more frames than this.
        perception: Who makes objects of pictures: segments, geometric, or a plug-in's.
        namer: Who names what segments finds: geometry, ocr (text on things), vision (a vision-language model at
            MINTPILOT_VLM_URL), or a plug-in's; may be given several times. Default: geometry.
        calibration: Measured confidences of the namers, as mintpilot bench perception --calibrate writes them.
        seed: Of simulated sources. Default: 0.
        out: Folder for map and report.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.seeing import see_pictures
    from mintpilot.core.ports import SourceOptions

    if not source and color is None and depth is None:
        return fail("see needs a source, or --color and --depth; see mintpilot see --help", as_json=json)
    options = SourceOptions(
        color=color,
        depth=depth,
        intrinsics=intrinsics,
        depth_unit_m=depth_unit,
        every=every,
        longest=longest,
        seed=seed or 0,
    )
    return guarded(
        lambda: see_pictures(
            source,
            options,
            perception=perception,
            namers=namer,
            calibration=calibration,
            instruction=instruction,
            out=out,
            as_json=json,
        ),
        as_json=json,
        debug=debug,
    )


@app.command(
    help_epilogue=examples(
        "mintpilot check examples/my-building/mission.yaml",
        "mintpilot check --schema > mission.schema.json",
    )
)
def check(
    mission: Path | None = None,
    /,
    *,
    schema: Flag = False,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Find every mistake in a mission file: its place, what is wrong, and what to write instead.

    Args:
        mission: The mission file (YAML).
        schema: Print the JSON Schema of mission files instead; editors use it to help you write.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.checking import check_file, print_schema

    if schema:
        return guarded(print_schema, as_json=False, debug=debug)
    if mission is None:
        return fail("check needs a mission file, or --schema; see mintpilot check --help", as_json=json)
    return guarded(lambda: check_file(mission, as_json=json), as_json=json, debug=debug)


@app.command(
    help_epilogue=examples(
        "mintpilot doctor",
        "mintpilot doctor --json",
    )
)
def doctor(*, audio: Flag = False, json: Json = False, debug: Flag = False) -> ExitCode:
    """Look at this machine: what is installed, what is missing, and how to get it.

    Args:
        audio: Try speech and hearing: says a word, hears it again, and shows the microphone's level.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.doctor import examine

    if audio:
        from mintpilot.cli.doctor_audio import examine_audio

        return guarded(lambda: examine_audio(as_json=json), as_json=json, debug=debug)
    return guarded(lambda: examine(as_json=json), as_json=json, debug=debug)


@app.command(
    help_epilogue=examples(
        "mintpilot replay runs/2026-11-28T10-00-00-fire-warehouse",
        "mintpilot replay runs/2026-11-28T10-00-00-fire-warehouse --page",
        "mintpilot replay runs/2026-11-28T10-00-00-fire-warehouse --verify",
    )
)
def replay(
    run: Path,
    /,
    *,
    verify: Flag = False,
    page: bool | None = None,
    port: int = 0,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """Show a recorded mission again, or think it through again and compare.

    It prints the report, and opens the console's page on the run, finished or broken off: any moment of it, with the
    map, the questions, the tree and the log as they were. Nothing can be answered there.

    Args:
        run: The run folder.
        verify: Feed the recorded events to the mission again: every step must be equal bit for bit, every deliberation
            within 1e-9. The first difference is shown with the event before it.
        page: Serve the page until Ctrl-C. Default: where a browser can be opened.
        port: Of the page. Default: any that is free.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """
    from mintpilot.cli.replaying import replay_run

    if page and (verify or json):
        return fail("--page shows a run to a person: give it without --verify and --json", as_json=json)
    return guarded(
        lambda: replay_run(run, verify=verify, page=page, port=port, as_json=json), as_json=json, debug=debug
    )


app.command(bench)
app.command(sim)
app.command(policy)
app.command(log)
app.command(runs, help_epilogue=examples("mintpilot runs", "mintpilot runs --prune --keep 20 --yes"))
app.command(
    export,
    help_epilogue=examples(
        "mintpilot export mission.yaml --to plan --out mission.plan",
        "mintpilot export runs/2026-11-28T10-00-00-survey --to wpl --firmware ardupilot",
        "mintpilot export fire-warehouse --to usd --out warehouse.usda",
    ),
)

understand = App(
    name="understand",
    help="Show what the drone understands, without flying anything.",
    help_epilogue=EPILOGUE,
    help_format="plaintext",
    result_action="return_value",
)
understand.command(
    answer,
    help_epilogue=examples(
        'mintpilot understand answer "it is safe"',
        'mintpilot understand answer "not the red one" --kind target --json',
        "mintpilot understand answer --file answers.txt --kind presence --by voice",
    ),
)
understand.command(
    instruction,
    help_epilogue=examples('mintpilot understand instruction "Pick up the red box and come back"'),
)
app.command(understand)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the program with these words (default: those of the command line); returns its exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    listen()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a narrow encoding must not end a flight
    if any(word == "--out=" or (word == "--out" and after == "") for word, after in pairwise([*words, "-"])):
        return fail("--out '': give a file or a folder; the working directory is --out .", as_json="--json" in words)
    try:
        code = app(words, exit_on_error=False, print_error=False)
    except CycloptsError as error:
        return fail(f"{error}; see mintpilot --help", as_json="--json" in words)
    except KeyboardInterrupt as stopped:
        code, message = verdict_on(stopped)
        return fail(message, as_json="--json" in words, code=code)
    return int(code or 0)


if __name__ == "__main__":
    sys.exit(main())
