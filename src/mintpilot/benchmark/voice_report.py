"""All figures of ``mintpilot bench voice``, and the tables made of them."""

from __future__ import annotations

import resource
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import quantiles
from typing import TypeAlias

from mintpilot.assembly.registry import load
from mintpilot.benchmark.intervals import clopper_pearson_upper
from mintpilot.benchmark.voice_trials import (
    OTHER,
    VoiceTrial,
    condition,
    outcome,
    recorded_clips,
    run_trials,
    synthetic_clips,
)
from mintpilot.core.errors import MissingPartError
from mintpilot.voice.hearing import Ear
from mintpilot.voice.ports import Speech

Rows: TypeAlias = tuple[str, Sequence[str], list[Sequence[str]]]
"""Caption, header, rows."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VoiceOptions:
    """What is measured."""

    clips: Path | None
    """Folder with recordings in ``yes``, ``no`` and ``unknown``; None: synthesised phrases only."""
    most: int | None = None
    """Recordings of each kind; None: all."""
    voices: int = 6
    """So many synthesised voices; 0: none."""
    snrs_db: tuple[float | None, ...] = (None, 20.0, 10.0, 5.0, 0.0)
    out: Path | None = None
    """Folder of records, with which a measurement is resumed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VoiceResult:
    """One run of the measurement."""

    trials: tuple[VoiceTrial, ...]
    notes: tuple[str, ...]
    memory_mb: float


def measure_voice(options: VoiceOptions, progress: Callable[[str], object] = lambda _: None) -> VoiceResult:
    """Hears every clip in every condition with the installed recognisers.

    Raises:
        MissingPartError: a recogniser is not installed.
        InputError: the folder has no recordings.
    """
    ear = Ear(first=load("recogniser", "moonshine")(), second=load("recogniser", "whisper")())
    clips = recorded_clips(options.clips, options.most) if options.clips is not None else []
    notes = ["Nothing was heard of a person beside real rotors: the noise is made."]
    opened: list[Speech] = []
    try:
        voices = _voices(options.voices, opened)
        clips += synthetic_clips(voices)
    except MissingPartError as error:
        notes.append(f"No synthesised phrases: {error}")
    try:
        trials = list(run_trials(clips, options.snrs_db, ear, load("activity", "silero"), options.out, progress))
    finally:
        for speech in opened:
            getattr(speech, "close", lambda: None)()
    return VoiceResult(
        trials=tuple(trials),
        notes=tuple(notes),
        memory_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    )


def voice_tables(result: VoiceResult) -> list[Rows]:
    """What is printed and kept."""
    trials = result.trials
    sources = ("recorded", "synthesised")
    heard = [row for source in sources for row in _heard(_of(trials, source), source)]
    off = [row for source in sources for row in _off_grammar(_of(trials, source), source)]
    every = sorted(trial.answer_s for trial in trials)
    cuts = quantiles(every, n=20) if len(every) > 1 else every * 19
    factor = sum(trial.seconds for trial in trials) / max(1e-9, sum(trial.sound_s for trial in trials))
    speed = [(f"{len(every)}", f"{cuts[9]:.2f} s", f"{cuts[18]:.2f} s", f"{factor:.2f}", f"{result.memory_mb:.0f} MB")]
    return [
        ("What was said and heard", ("source", "condition", "said", "n", "right", "asked again", "opposite"), heard),
        (
            "Speech that is no answer",
            ("source", "condition", "n", "taken for confirm", "at most, 95 %", "for yes", "for no", "for an order"),
            off,
        ),
        ("Time", ("n", "recognition p50", "p95", "work a second of sound", "memory"), [*speed]),
    ]


def _of(trials: Sequence[VoiceTrial], source: str) -> list[VoiceTrial]:
    return [trial for trial in trials if (trial.source == "recorded") is (source == "recorded")]


def _heard(trials: Sequence[VoiceTrial], source: str) -> list[Sequence[str]]:
    rows: list[Sequence[str]] = []
    for snr_db in dict.fromkeys(trial.snr_db for trial in trials):
        for says in ("yes", "no", "confirm", "stop", "come back", "land"):
            got = [outcome(t) for t in trials if t.snr_db == snr_db and t.says == says]
            if not got:
                continue
            opposite = sum(one == {"yes": "no", "no": "yes"}.get(says) for one in got)
            counts = (got.count(says), got.count(OTHER), opposite)
            rows.append((source, condition(snr_db), says, str(len(got)), *map(str, counts)))
    return rows


def _off_grammar(trials: Sequence[VoiceTrial], source: str) -> list[Sequence[str]]:
    rows: list[Sequence[str]] = []
    others = [trial for trial in trials if trial.says == OTHER]
    groups = [
        (condition(snr), [t for t in others if t.snr_db == snr]) for snr in dict.fromkeys(t.snr_db for t in others)
    ]
    for name, some in [*groups, ("pooled", others)]:
        if not some:
            continue
        got = [outcome(trial) for trial in some]
        confirmed, orders = got.count("confirm"), sum(one not in ("yes", "no", "confirm", OTHER) for one in got)
        bound = f"{100 * clopper_pearson_upper(confirmed, len(got)):.2f} %"
        counts = (len(got), confirmed, bound, got.count("yes"), got.count("no"), orders)
        rows.append((source, name, *map(str, counts)))
    return rows


def _voices(count: int, opened: list[Speech]) -> list[tuple[str, Speech, str, float]]:
    """Voices of two programs and several accents."""
    if not count:
        return []
    piper, espeak = load("speech", "piper")(), load("speech", "espeak")()
    opened += [piper, espeak]
    every = [
        ("joe", piper, "en", 1.0), ("joe, slow", piper, "en", 0.8), ("espeak Scottish", espeak, "en-gb-scotland", 0.9),
        ("espeak New York", espeak, "en-us-nyc", 0.9), ("espeak British, woman", espeak, "en+f4", 0.9),
        ("espeak American, man", espeak, "en-us+m7", 0.9),
    ]  # fmt: skip
    return every[:count]
