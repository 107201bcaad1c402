"""All figures of ``mintpilot bench voice``, and the tables made of them."""

from __future__ import annotations

import resource
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import quantiles
from typing import TypeAlias

from mintpilot.assembly.registry import load
from mintpilot.benchmark.intervals import clopper_pearson, clopper_pearson_upper
from mintpilot.benchmark.voice_trials import (
    OTHER,
    VoiceTrial,
    alone_clips,
    condition,
    kept_clip,
    outcome,
    read_trials,
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
    voices: int = 7
    """So many synthesised voices; 0: none."""
    kokoro: Path | None = None
    """Folder of the voices of `mintpilot.benchmark.kokoro_voices`; None: those are left out."""
    alone_h: float = 0.0
    """So many hours of rotors, and of silence, with nobody who speaks."""
    snrs_db: tuple[float | None, ...] = (None, 20.0, 10.0, 5.0, 0.0)
    out: Path | None = None
    """Folder of records, with which a measurement is resumed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VoiceResult:
    """One run of the measurement."""

    trials: tuple[VoiceTrial, ...]
    notes: tuple[str, ...]
    memory_mb: float | None
    """Of the whole process at most; None: not known."""


def kept_voice(out: Path) -> VoiceResult:
    """What a measurement that was interrupted has reached so far."""
    return VoiceResult(trials=tuple(read_trials(out)), notes=(_MADE_NOISE,), memory_mb=None)


def measure_voice(options: VoiceOptions, progress: Callable[[str], object] = lambda _: None) -> VoiceResult:
    """Hears every clip in every condition with the installed recognisers.

    Raises:
        MissingPartError: a recogniser is not installed.
        InputError: the folder has no recordings.
    """
    ear = Ear(first=load("recogniser", "moonshine")(), second=load("recogniser", "whisper")())
    clips = recorded_clips(options.clips, options.most) if options.clips is not None else []
    notes = [_MADE_NOISE]
    opened: list[Speech] = []
    try:
        spoken = synthetic_clips(_voices(options, opened))
        sounds = options.out / "sounds" if options.out is not None else None
        clips += spoken if sounds is None else [kept_clip(clip, sounds) for clip in spoken]
    except MissingPartError as error:
        notes.append(f"No synthesised phrases: {error}")
    activity = load("activity", "silero")
    try:
        said = [clip for clip in clips if clip.says != OTHER]
        trials = list(run_trials(said, options.snrs_db, ear, activity, options.out, progress))
        others = [clip for clip in clips if clip.says == OTHER]
        trials += run_trials(others, options.snrs_db, ear, activity, options.out, progress)
        trials += run_trials(alone_clips(options.alone_h), (None,), ear, activity, options.out, progress)
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
    every = [*_of(trials, "recorded"), *_of(trials, "synthesised")]
    pooled = _off_grammar(every, "all")[-1:]
    return [
        ("What was said and heard", ("source", "condition", "said", "n", *_HEARD), heard),
        ("Of all that was to be heard", ("source", "condition", "n", *_HEARD), _accuracy(trials)),
        ("By voice, clean and at 10 dB", ("voice", "n", *_HEARD), _by_voice(_of(trials, "synthesised"))),
        (
            "Speech that is no answer",
            ("source", "condition", "n", "taken for confirm", "at most, 95 %", "for yes", "for no", "for an order"),
            [*off, *pooled],
        ),
        (
            "Nobody speaks",
            ("what is heard", "hours", "utterances", "answers", "confirmations", "orders"),
            _alone(trials),
        ),
        (
            "Time",
            ("n", "processor, p50", "p95", "passed, p50", "p95", "processor a second of sound", "memory"),
            [_times([trial for trial in every if trial.utterances], result.memory_mb)],
        ),
    ]


_MADE_NOISE = "Nothing was heard of a person beside real rotors: the noise is made."
_ALONE = ("rotors", "silence")
_HEARD = ("right", "95 %", "asked again", "opposite", "something else")


def _counts(trials: Sequence[VoiceTrial]) -> Sequence[str]:
    """n, right, its exact interval, asked again, opposite, something else."""
    got = [(trial.says, outcome(trial)) for trial in trials]
    right, again = sum(a == b for a, b in got), sum(b == OTHER for _, b in got)
    opposite = sum(b == {"yes": "no", "no": "yes"}.get(a) for a, b in got)
    low, high = clopper_pearson(right, len(got))
    return (
        str(len(got)), f"{right} ({100 * right / max(1, len(got)):.1f} %)", f"{100 * low:.1f} to {100 * high:.1f} %",
        str(again), str(opposite), str(len(got) - right - again - opposite),
    )  # fmt: skip


def _accuracy(trials: Sequence[VoiceTrial]) -> list[Sequence[str]]:
    rows: list[Sequence[str]] = []
    for source in ("recorded", "synthesised"):
        said = [trial for trial in _of(trials, source) if trial.says != OTHER]
        for snr_db in dict.fromkeys(trial.snr_db for trial in said):
            rows.append((source, condition(snr_db), *_counts([t for t in said if t.snr_db == snr_db])))
    return rows


def _by_voice(trials: Sequence[VoiceTrial]) -> list[Sequence[str]]:
    said = [trial for trial in trials if trial.says != OTHER and trial.snr_db in (None, 10.0)]
    voices = dict.fromkeys(trial.source for trial in said)
    return [(voice, *_counts([t for t in said if t.source == voice])) for voice in voices]


def _alone(trials: Sequence[VoiceTrial]) -> list[Sequence[str]]:
    rows: list[Sequence[str]] = []
    for source in _ALONE:
        some = [trial for trial in trials if trial.source == source]
        got = [outcome(trial) for trial in some]
        hours = sum(trial.sound_s for trial in some) / 3600
        orders = sum(one not in ("yes", "no", "confirm", OTHER) for one in got)
        counts = (sum(trial.utterances for trial in some), got.count("yes") + got.count("no"), got.count("confirm"))
        rows += [(source, f"{hours:.2f}", *map(str, counts), str(orders))] if some else []
    return rows


def _times(trials: Sequence[VoiceTrial], memory_mb: float | None) -> Sequence[str]:
    def cuts(values: list[float]) -> tuple[str, str]:
        found = quantiles(values, n=20) if len(values) > 1 else [*values, 0.0] * 19
        return f"{found[9]:.2f} s", f"{found[18]:.2f} s"

    factor = sum(trial.cpu_s for trial in trials) / max(1e-9, sum(trial.sound_s for trial in trials))
    processor, passed = cuts([t.answer_cpu_s for t in trials]), cuts([t.answer_s for t in trials])
    return (str(len(trials)), *processor, *passed, f"{factor:.2f}", "-" if memory_mb is None else f"{memory_mb:.0f} MB")


def _of(trials: Sequence[VoiceTrial], source: str) -> list[VoiceTrial]:
    """The trials of recordings, or of synthesised phrases; none of rotors alone."""
    with_words = [trial for trial in trials if trial.source not in _ALONE]
    return [trial for trial in with_words if (trial.source == "recorded") is (source == "recorded")]


def _heard(trials: Sequence[VoiceTrial], source: str) -> list[Sequence[str]]:
    rows: list[Sequence[str]] = []
    for snr_db in dict.fromkeys(trial.snr_db for trial in trials):
        for says in ("yes", "no", "confirm", "stop", "come back", "land"):
            some = [t for t in trials if t.snr_db == snr_db and t.says == says]
            if some:
                rows.append((source, condition(snr_db), says, *_counts(some)))
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


def _voices(options: VoiceOptions, opened: list[Speech]) -> list[tuple[str, Speech, str, float]]:
    """Voices of several programs, American and British. Raises `MissingPartError`."""
    if not options.voices:
        return []
    heart, piper, espeak = (load("speech", name)() for name in ("hibari", "piper", "espeak"))
    opened += [piper, espeak]
    natural: list[tuple[str, Speech, str, float]] = []
    if options.kokoro is not None:
        from mintpilot.benchmark.kokoro_voices import KokoroSpeech

        kokoro = KokoroSpeech(options.kokoro)
        natural = [
            ("Michael, American man", kokoro, "am_michael", 1.0),
            ("Emma, British woman", kokoro, "bf_emma", 1.0), ("George, British man", kokoro, "bm_george", 1.0),
        ]  # fmt: skip
    every = [
        ("Joe, American man", piper, "en", 1.0), ("Heart, American woman", heart, "en", 1.0), *natural,
        ("espeak, Scottish", espeak, "en-gb-scotland", 0.9),
        ("espeak, New York", espeak, "en-us-nyc", 0.9), ("espeak, British woman", espeak, "en+f4", 0.9),
    ]  # fmt: skip
    return every[: options.voices]
