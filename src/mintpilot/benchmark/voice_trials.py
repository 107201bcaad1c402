"""How answers are heard: clips and synthesised phrases beside rotors, each trial one record, resumable."""

from __future__ import annotations

import json
import re
import time
import zlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from mintpilot.assembly.sample_question import sample_question
from mintpilot.core.errors import InputError
from mintpilot.core.gap import GapKind
from mintpilot.core.geometry import Floats
from mintpilot.core.query import Order
from mintpilot.core.reading import AnsweredBy, ReadingKind, guarded_replies
from mintpilot.language.answers import confirmation_in, order_in, read_answer
from mintpilot.voice.audio import read_wav, write_wav
from mintpilot.voice.hearing import Ear, Hearing, Segmenter
from mintpilot.voice.ports import RATE_HZ, Activity, Speech
from mintpilot.voice.rotor import mixed, rotor_noise

OTHER = "other"
"""What is said is no answer, order or confirmation."""
_BEFORE_S, _AFTER_S = 0.6, 0.8
FILE = "voice.jsonl"


@dataclass(frozen=True, slots=True, kw_only=True)
class Clip:
    """Something said."""

    name: str
    source: str
    """``recorded``, or the voice."""
    says: str
    """``yes``, ``no``, ``confirm``, ``stop``, ``come back``, ``land`` or `OTHER`."""
    samples: Callable[[], Floats]


@dataclass(frozen=True, slots=True, kw_only=True)
class VoiceTrial:
    """One clip in one condition."""

    name: str
    source: str
    says: str
    snr_db: float | None
    """None: no rotors."""
    text: str
    second: str
    written: tuple[str, str]
    probability: float
    is_sure: bool
    utterances: int
    sound_s: float
    cpu_s: float
    """Processor time of activity and recognition."""
    answer_cpu_s: float
    """Of it, from the utterance's end to its text, for each utterance."""
    answer_s: float
    """The same as time that passed; without the silence that ends an utterance."""

    @property
    def key(self) -> tuple[str, float | None]:
        """What was tried."""
        return self.name, self.snr_db


def recorded_clips(folder: Path, most: int | None) -> list[Clip]:
    """The WAV files below ``yes``, ``no`` and ``unknown`` in a folder, evenly chosen; the first ``most`` of each.

    The thresholds of `mintpilot.voice.hearing.HearingSettings` were chosen on every second yes and no and on every
    third other word, in the order of their names: those are left out.

    Raises:
        InputError: there are none.
    """
    found = []
    for name, says in (("yes", "yes"), ("no", "no"), ("unknown", OTHER)):
        every = 3 if says == OTHER else 2
        files = [file for at, file in enumerate(sorted((folder / name).glob("*.wav"))) if at % every]
        step = max(1, len(files) // most) if most else 1
        for file in files[::step][:most]:
            found.append(
                Clip(name=f"{name}/{file.stem}", source="recorded", says=says, samples=partial(read_wav, file))
            )
    if not found:
        raise InputError(f"{folder}: no WAV files in its folders yes, no and unknown")
    return found


ORDERS = ("yes", "no", "confirm", "stop", "come back", "land")
OFF_GRAMMAR = (
    "what is that", "wait a second", "I never said so", "seventeen", "forty two", "where did you put the keys",
    "the weather will be fine", "hold my coffee", "she went to the station", "goal in the last minute",
    "here is the news", "more after the break", "turn the volume down", "I can hear the rotors", "is anyone there",
    "comfortable", "uniform", "platform", "farm", "come for me", "conformity", "we will confirm tomorrow",
    "did he confirm it", "nobody confirmed anything", "yes or no", "yes and no", "no idea about that", "note it down",
    "noon", "snow", "chess", "dress", "yesterday evening", "stand there", "sand", "top", "shop", "a stop sign",
    "come back to me later", "the island", "yeah no", "I can confirm it is toxic", "confirm that again please",
    "the captain confirmed it", "do not confirm", "yes but not now", "well yes and no", "yes yes but it is burning",
    "no wait", "now", "know", "yet", "guess", "less", "it's a yes or no question", "landing gear", "land of hope",
    "he landed yesterday", "stop it you two", "stopwatch", "can you hear me", "over and out", "roger", "copy that",
    "go ahead", "tonight at eight on channel four", "the police have confirmed the reports", "three two one",
    "nine hundred", "thank you very much", "pass me the radio", "the firm is closed", "information", "conference",
    "a confirmed case",
)  # fmt: skip
"""None of them was among the clips that the thresholds were chosen on, but the first two. "Now" and "know" sound as no
does, and are counted all the same."""
ALONE_S = 20.0
"""Length of one stretch of rotor noise, or of silence, seconds."""
SYNTHETIC = (*((text, text) for text in ORDERS), *((text, OTHER) for text in OFF_GRAMMAR))
"""Phrases with what they say."""


def synthetic_clips(voices: Iterable[tuple[str, Speech, str, float]]) -> list[Clip]:
    """The phrases in several voices: name, speech, its language or accent, speed."""
    speakers = tuple(voices)
    return [
        Clip(
            name=f"{name}/{text}", source=name, says=says,
            samples=partial(speech.say, text, lang=lang, speed=speed),
        )
        for text, says in SYNTHETIC
        for name, speech, lang, speed in speakers
    ]  # fmt: skip


def alone_clips(hours: float) -> list[Clip]:
    """So many hours of rotors at many levels, and as many of silence with the hiss of a microphone; nobody speaks."""

    def rotors(number: int) -> Floats:
        rng = np.random.default_rng([number, 7])
        return 10 ** (rng.uniform(-45, -10) / 20) * rotor_noise(int(ALONE_S * RATE_HZ), rng)

    def silence(number: int) -> Floats:
        rng = np.random.default_rng([number, 8])
        return 10 ** (rng.uniform(-100, -60) / 20) * rng.standard_normal(int(ALONE_S * RATE_HZ))

    return [
        Clip(name=f"{source}/{number}", source=source, says=OTHER, samples=partial(make, number))
        for number in range(round(3600 * hours / ALONE_S))
        for source, make in (("rotors", rotors), ("silence", silence))
    ]


def kept_clip(clip: Clip, folder: Path) -> Clip:
    """The same clip, whose sound is made once and kept in that folder."""
    name = re.sub(r"\W+", "-", clip.name) + f"-{zlib.crc32(clip.name.encode()):08x}.wav"

    def samples() -> Floats:
        path = folder / name
        if not path.exists():
            folder.mkdir(parents=True, exist_ok=True)
            made = path.with_suffix(".part")
            write_wav(made, clip.samples())
            made.rename(path)
        return read_wav(path)

    return replace(clip, samples=samples)


def run_trials(
    clips: Iterable[Clip],
    snrs_db: Iterable[float | None],
    ear: Ear,
    activity: Callable[[], Activity],
    out: Path | None,
    progress: Callable[[str], object] = lambda _: None,
) -> Iterator[VoiceTrial]:
    """Every clip in every condition; what the file in ``out`` holds already is not tried again."""
    done = {trial.key: trial for trial in read_trials(out)} if out is not None else {}
    wanted = list(clips)
    for snr_db in snrs_db:
        for number, clip in enumerate(wanted):
            if (clip.name, snr_db) in done:
                yield done[clip.name, snr_db]
                continue
            trial = _tried(clip, snr_db, ear, activity())
            if out is not None:
                out.mkdir(parents=True, exist_ok=True)
                with (out / FILE).open("a") as file:
                    file.write(json.dumps(asdict(trial)) + "\n")
            progress(f"{condition(snr_db)}: {number + 1} of {len(wanted)}")
            yield trial


def read_trials(out: Path) -> list[VoiceTrial]:
    """The records of a folder; a last line that was cut off is left out."""
    found = []
    if (out / FILE).exists():
        for line in (out / FILE).read_text().splitlines():
            try:
                found.append(VoiceTrial(**json.loads(line)))
            except (ValueError, TypeError):
                continue
    return found


def condition(snr_db: float | None) -> str:
    """A noise condition in words."""
    return "clean" if snr_db is None else f"{snr_db:g} dB"


def outcome(trial: VoiceTrial) -> str:
    """What the voice operator takes it for: yes, no, an order or a confirmation; `OTHER`: it asks again, or nothing.

    Yes and no are answers to a question about smoke; a yes is still to be read back and confirmed then.
    """
    return _meaning((trial.text, trial.second), trial.written, is_sure=trial.is_sure)


def _meaning(texts: tuple[str, str], written: tuple[str, str], *, is_sure: bool) -> str:
    orders = [order_in(text) for text in texts]
    if Order.HOLD in (*orders, *map(order_in, written)):
        return "stop"
    if not is_sure:
        return OTHER
    if orders[0] is not None and orders[0] is orders[1]:
        return {Order.RETURN: "come back", Order.LAND: "land"}.get(orders[0], orders[0].value)
    if [confirmation_in(text) for text in texts] == [True, True]:
        return "confirm"
    question = sample_question(GapKind.OBSTACLE)
    readings = {
        read_answer(text, question, guarded=guarded_replies(question), by=AnsweredBy.VOICE) for text in texts
    }  # fmt: skip
    reading = readings.pop()
    is_reply = reading.kind in (ReadingKind.YES, ReadingKind.NO, ReadingKind.READ_BACK)
    return reading.reply.value if not readings and is_reply and reading.reply is not None else OTHER


def _weight(heard: Hearing) -> tuple[bool, float]:
    """Of several utterances in one clip the one counts that means something, else the longest."""
    meaning = _meaning((heard.text, heard.second), heard.written, is_sure=heard.is_sure)
    return meaning != OTHER, heard.duration_s


def _tried(clip: Clip, snr_db: float | None, ear: Ear, activity: Activity) -> VoiceTrial:
    spoken = clip.samples()
    rng = np.random.default_rng([zlib.crc32(clip.name.encode()), 0 if snr_db is None else int(snr_db) + 100])
    sound = np.concatenate([np.zeros(int(_BEFORE_S * RATE_HZ)), spoken, np.zeros(int(_AFTER_S * RATE_HZ))])
    if snr_db is not None:  # the ratio is that of the clip, not of the silence around it
        sound = mixed(sound, snr_db - 10 * float(np.log10(len(spoken) / len(sound))), rng)
    begun = time.process_time()
    utterances = Segmenter(activity, ear.settings).feed(np.concatenate([sound, np.zeros(int(_AFTER_S * RATE_HZ))]))
    cut, cut_at = time.process_time(), time.perf_counter()
    heard = [ear.hear(utterance) for utterance in utterances]
    ended, ended_at = time.process_time(), time.perf_counter()
    best, count = max(heard, key=_weight, default=None), max(1, len(heard))
    return VoiceTrial(
        name=clip.name, source=clip.source, says=clip.says, snr_db=snr_db,
        text=best.text if best else "", second=best.second if best else "",
        written=best.written if best else ("", ""),
        probability=best.probability if best else 0.0, is_sure=best.is_sure if best else False, utterances=len(heard),
        sound_s=len(sound) / RATE_HZ, cpu_s=ended - begun, answer_cpu_s=(ended - cut) / count,
        answer_s=(ended_at - cut_at) / count,
    )  # fmt: skip
