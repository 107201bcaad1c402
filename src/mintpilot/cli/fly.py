"""``mintpilot run`` and ``mintpilot demo``."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from mintpilot.cli.exits import ExitCode, hush
from mintpilot.cli.interrupts import stop_if_wanted
from mintpilot.cli.web_page import PageOptions, ServedPage
from mintpilot.core.compiled import NOT_KEPT, can_keep
from mintpilot.core.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from mintpilot.assembly.api import AnyOperator
    from mintpilot.assembly.talk import Talk
    from mintpilot.cli.progress import Narrator
    from mintpilot.core.events import Event
    from mintpilot.core.ports import Operator
    from mintpilot.recording.question_notes import QuestionNotes


OPERATORS = ("terminal", "console", "voice", "scripted")
"""Who may answer. Several may at once, but for the script, which would always be first."""


def operator_names(given: Sequence[str]) -> tuple[str, ...]:
    """The operators that are named, each once: ``console,terminal``, or each given for itself.

    Raises:
        InputError: there is none of that name, or the script is to answer beside somebody.
    """
    names = tuple(dict.fromkeys(name.strip() for one in given for name in one.split(",")))
    for name in names:
        if name not in OPERATORS:
            raise InputError(f"--operator {name}: there is none of that name; choose among {', '.join(OPERATORS)}")
    if "scripted" in names and len(names) > 1:
        raise InputError("--operator scripted answers at once, before any person: give it alone")
    return names


@dataclass(frozen=True, slots=True, kw_only=True)
class VoiceFlags:
    """How it sounds, as the command line says it.

    Raises:
        InputError: a volume or speed beyond its bounds.
    """

    listen_to: Path | None = None
    """A recording or a pipe in the microphone's place; None: the microphone."""
    volume: float = 1.0
    """0 to 1; 0: captions only."""
    speed: float = 1.0
    """0.5 to 2."""

    def __post_init__(self) -> None:
        if not 0 <= self.volume <= 1:
            raise InputError(f"--volume {self.volume:g}: must be 0 (captions only) to 1")
        if not 0.5 <= self.speed <= 2:
            raise InputError(f"--speech-speed {self.speed:g}: must be 0.5 to 2")


@dataclass(frozen=True, slots=True, kw_only=True)
class FlightOptions:
    """How a mission is flown, as the command line says it."""

    operators: tuple[str, ...]
    """Some of `OPERATORS`; none: the terminal's where somebody is there, else the script."""
    vehicle: str
    strategy: str
    seed: int | None
    out: Path | None
    """The run folder; None: a new one under ``runs``."""
    as_json: bool
    think: str | None = None
    """How long the scripted operator thinks, seconds; None: as the mission file says."""
    strategy_args: tuple[str, ...] = ()
    """Each ``NAME=VALUE``."""
    planner: str = "grid"
    """Who plans, by name."""
    llm: str | None = None
    """Language model by name; None: as the mission file says."""
    lang: str | None = None
    """In which questions are asked; None: as the mission file says."""
    perception: str | None = None
    """What makes objects of pictures, by name; None: as the mission file says."""
    accept_failsafes: bool = False
    """Fly a real vehicle whose autopilot's fail-safes are not as they should be."""
    camera: str = ""
    """Where a real vehicle's pictures come from; empty: nowhere."""
    earlier: Path | None = None
    """Run folder whose map the mission begins with; None: it makes its own."""
    voice: VoiceFlags = VoiceFlags()
    """How questions are said, and where answers are heard."""
    page: PageOptions | None = None
    """Where the web page is served, beside whoever else answers; None: it is not."""


def fly(path: Path, options: FlightOptions) -> ExitCode:
    """Flies the mission in that file, tells how it goes, and prints the report, or as JSON its summary."""
    from mintpilot.assembly.api import run_mission, vehicle_choice
    from mintpilot.assembly.strategies import parse_arguments
    from mintpilot.cli.progress import LenientConsole, Narrator
    from mintpilot.mission_file.reader import read_mission
    from mintpilot.recording.question_notes import QuestionNotes
    from mintpilot.recording.run_folder import new_run_path
    from mintpilot.recording.run_summary import summary
    from mintpilot.recording.terminal_report import print_report

    vehicle_choice(options.vehicle)  # a wrong name is told before anything is read
    arguments = parse_arguments(options.strategy_args)
    mission = read_mission(path)
    errors = LenientConsole(stderr=True)
    out = options.out or new_run_path(Path("runs"), mission.name, datetime.now(UTC))
    if not can_keep():
        errors.print(NOT_KEPT, highlight=False, soft_wrap=True)
    notes = QuestionNotes(out)
    with ExitStack() as stack, Narrator(errors) as narrator:
        served = ServedPage(options.page, errors, stack) if options.page is not None else None

        def tell(event: Event) -> None:
            narrator(event)
            notes(event)
            if served is not None:
                served.record(event)
            stop_if_wanted(event)

        try:
            record = run_mission(
                path,
                operator=_operators(
                    options.operators,
                    errors,
                    narrator,
                    served,
                    stack,
                    notes=notes,
                    voice=options.voice,
                    real="://" in options.vehicle,
                ),
                vehicle=options.vehicle,
                strategy=options.strategy,
                strategy_arguments=arguments,
                planner=options.planner,
                think=options.think,
                seed=options.seed,
                out=out,
                progress=tell,
                llm=options.llm,
                lang=options.lang,
                perception=options.perception,
                accept_failsafes=options.accept_failsafes,
                camera=options.camera,
                earlier=options.earlier,
                views=served is not None,
                briefs=served is not None or (_somebody(errors) and options.operators != ("scripted",)),
            )
        except KeyboardInterrupt:
            narrator.rest()
            if out.exists():
                errors.print(f"Stopped. What was recorded until then is in {out}.", highlight=False, soft_wrap=True)
            raise
    try:
        if options.as_json:
            print(summary(record).model_dump_json(), flush=True)
        else:
            print_report(record, LenientConsole())
    except BrokenPipeError:  # the reader went away; how the mission ended still counts
        hush()
    return ExitCode.SUCCESS if record.outcome.value == "success" else ExitCode.NOT_A_SUCCESS


def _somebody(console: Console) -> bool:
    """Whether a person sits at the terminal."""
    return sys.stdin is not None and sys.stdin.isatty() and console.is_terminal


def _operators(
    choice: tuple[str, ...],
    console: Console,
    narrator: Narrator,
    served: ServedPage | None,
    closing: ExitStack,
    *,
    notes: QuestionNotes,
    voice: VoiceFlags = VoiceFlags(),
    real: bool,
) -> tuple[AnyOperator, ...]:
    """Whoever answers. Where nobody is named: the page if there is one, and the terminal where somebody is there."""
    somebody = _somebody(console)
    if not choice and not somebody and served is None:
        if real:
            raise InputError(
                "a real vehicle needs somebody who answers and can call it back: use --operator terminal or console "
                "(--operator scripted is for the vehicle double)"
            )
        return ("scripted",)
    if choice == ("scripted",):
        return ("scripted",)
    made: list[AnyOperator] = [] if served is None else [served.operator, served.voice]
    if "voice" in choice:
        made.append(_voice(console, closing, voice))
    # by voice, keys answer as well
    if "terminal" in choice or (somebody and choice in ((), ("voice",))):
        made.append(_terminal(console, narrator, notes))
    return tuple(made)


def _terminal(console: Console, narrator: Narrator, notes: QuestionNotes) -> AnyOperator:
    """The person at this terminal."""
    if sys.stdin is None or _is_null(sys.stdin):
        raise InputError("--operator terminal needs a standard input; use --operator scripted where nobody is there")
    from mintpilot.cli.progress import Attended
    from mintpilot.interaction.terminal import TerminalOperator

    answers = sys.stdin

    def made(talk: Talk) -> Operator:
        person = TerminalOperator(
            console, answers, understand=talk.understand, order_of=talk.order_of, lang=talk.lang, notes=notes
        )
        return Attended(person, narrator)

    return made


def _is_null(stream: TextIO) -> bool:
    """Whether nothing can ever be read from it, as from /dev/null."""
    try:
        return os.path.samestat(os.fstat(stream.fileno()), os.stat(os.devnull))  # noqa: PTH116
    except (OSError, ValueError):
        return False


def _voice(console: Console, closing: ExitStack, choice: VoiceFlags) -> AnyOperator:
    """The person who speaks here."""
    from mintpilot.assembly.voiced import voice_operator
    from mintpilot.voice.devices import link_to
    from mintpilot.voice.mouth import VoiceSettings

    settings = VoiceSettings(volume=choice.volume, speed=choice.speed, muted=choice.volume == 0)
    link = link_to(choice.listen_to)
    closing.callback(link.close)

    def made(talk: Talk) -> Operator:
        person = voice_operator(link, talk, lambda text: console.print(text, markup=False), settings)
        closing.callback(person.close)
        return person

    return made
