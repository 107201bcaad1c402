"""The box mission by sound alone, into docs/results.md. `python -m bench.voice_missions [--seeds N] [--snr DB]`."""

from __future__ import annotations

import argparse
import json
import os
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median

import numpy as np

from bench.sections import Section, Table, keep
from mintpilot.assembly.api import run_mission
from mintpilot.assembly.registry import load
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.voiced import LoopbackParts, hears_here, loopback_operator, speech_for
from mintpilot.assembly.worlds import build_world
from mintpilot.benchmark.intervals import clopper_pearson
from mintpilot.benchmark.kokoro_voices import KokoroSpeech
from mintpilot.benchmark.summary import latency_s
from mintpilot.benchmark.tally import Tally
from mintpilot.cli.demos import demo_path
from mintpilot.core.geometry import Floats
from mintpilot.mission_file.reader import read_mission
from mintpilot.voice.audio import trimmed
from mintpilot.voice.hearing import Ear, Hearing, HearingSettings, Utterance
from mintpilot.voice.loopback import Conditions, LoopbackPerson
from mintpilot.voice.operator import VoiceOperator
from mintpilot.voice.ports import Speech

PAPER_S = 20.7
VOICES = KokoroSpeech.languages
"""Of the person, in turn: an American man, a British woman, a British man."""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One mission."""

    seed: int
    snr_db: float | None
    vehicle: str
    outcome: str
    reason: str
    questions: int
    heard: list[str]
    said: list[str]
    sound_s: float
    """All speech of both sides up to the last answer, notices included, and 1 s of reaction before each."""
    thinking_s: float
    """One picture, all deliberations, wordings and trajectories."""
    hearing_s: float
    """Recognition of all answers, and the silence that ends each."""
    speaking_s: float
    """Synthesis of everything that was said."""
    hearing_cpu_s: float
    speaking_cpu_s: float
    """The same without the silences, and of synthesis, as processor time."""
    load: float
    """Of the machine, mean of the last minute at the end."""

    @property
    def own_s(self) -> float:
        return self.thinking_s + self.hearing_s + self.speaking_s

    @property
    def own_cpu_s(self) -> float:
        """Our own share on a core of its own: processor time, and the silences."""
        answers = HearingSettings().silence_s * len(self.said)
        return self.thinking_s + self.hearing_cpu_s + answers + self.speaking_cpu_s

    @property
    def all_s(self) -> float:
        return self.own_s + self.sound_s


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedEar(Ear):
    """Adds up what recognition took."""

    spent: list[tuple[float, float]]

    def hear(self, utterance: Utterance) -> Hearing:
        begun, begun_cpu = time.perf_counter(), time.process_time()
        heard = Ear.hear(self, utterance)
        self.spent.append((time.perf_counter() - begun, time.process_time() - begun_cpu))
        return heard


class Person(Speech):
    """Another voice than the drone's; says few words, each made once."""

    languages = ("en",)

    def __init__(self, speech: Speech, voice: str) -> None:
        self._speech, self._voice = speech, voice
        self._kept: dict[str, Floats] = {}

    def say(self, text: str, *, lang: str = "en", speed: float = 1.0) -> Floats:
        if text not in self._kept:
            assert lang in self.languages
            self._kept[text] = trimmed(self._speech.say(text, lang=self._voice, speed=speed))
        return self._kept[text]


class TimedSpeech(Speech):
    """Adds up what synthesis took."""

    languages = ("en",)

    def __init__(self, speech: Speech) -> None:
        self._speech = speech
        self.spent_s = self.spent_cpu_s = 0.0

    def say(self, text: str, *, lang: str = "en", speed: float = 1.0) -> Floats:
        begun, begun_cpu = time.perf_counter(), time.process_time()
        said = self._speech.say(text, lang=lang, speed=speed)
        self.spent_s += time.perf_counter() - begun
        self.spent_cpu_s += time.process_time() - begun_cpu
        return said


def fly(seed: int, snr_db: float | None, vehicle: str, speech: Speech, voice: Speech, ear: Ear) -> Trial:
    """One mission with everything that is real but the person, the rotors and the vehicle."""
    path = demo_path("medicine")
    made: list[tuple[VoiceOperator, LoopbackPerson]] = []
    timed_ear, timed_speech = TimedEar(first=ear.first, second=ear.second, spent=[]), TimedSpeech(speech)
    tally = Tally()

    def operator(talk: Talk) -> VoiceOperator:
        world = build_world(read_mission(path), base=path.parent, seed=seed, parse=talk.parse)
        parts = LoopbackParts(
            speech=timed_speech, ear=timed_ear, activity=load("activity", "silero")(), person_hears=ear.first,
            person_speaks=Person(voice, VOICES[seed % len(VOICES)]),
        )  # fmt: skip
        rng = np.random.default_rng([seed, 15])
        made.append(loopback_operator(world, talk, parts, rng=rng, conditions=Conditions(snr_db=snr_db)))
        return made[0][0]

    record = run_mission(path, operator=operator, vehicle=vehicle, seed=seed, progress=tally.record)
    person = made[0][1]
    return Trial(
        seed=seed, snr_db=snr_db, vehicle=vehicle, outcome=record.outcome.value, reason=record.reason,
        questions=len(tally.asked), heard=person.heard, said=person.said, sound_s=person.sound_s,
        thinking_s=latency_s(tally.stages) - tally.stages.answer,
        hearing_s=sum(wall for wall, _ in timed_ear.spent) + len(timed_ear.spent) * HearingSettings().silence_s,
        speaking_s=timed_speech.spent_s, hearing_cpu_s=sum(cpu for _, cpu in timed_ear.spent),
        speaking_cpu_s=timed_speech.spent_cpu_s,
        load=os.getloadavg()[0],
    )  # fmt: skip


def section(trials: list[Trial], command: str) -> Section:
    """The section of docs/results.md."""
    well = sum(trial.outcome == "success" for trial in trials)
    low, high = clopper_pearson(well, len(trials))
    rows = []
    for name, values in (
        ("speech of both sides, reaction of 1 s", [t.sound_s for t in trials]),
        ("thinking: picture, deliberation, wording, trajectories", [t.thinking_s for t in trials]),
        ("hearing: recognition, and 0.4 s of silence for each answer", [t.hearing_s for t in trials]),
        ("making speech", [t.speaking_s for t in trials]),
        ("our own share", [t.own_s for t in trials]),
        ("instruction to trajectories", [t.all_s for t in trials]),
        ("our own share, by processor time", [t.own_cpu_s for t in trials]),
        ("instruction to trajectories, by processor time", [t.own_cpu_s + t.sound_s for t in trials]),
    ):
        rows.append((name, f"{median(values):.1f}", f"{max(values):.1f}"))
    failed = [
        f"Seed {t.seed}: {t.outcome}: {t.reason} (said: {', '.join(t.said)})" for t in trials if t.outcome != "success"
    ]
    under = sum(trial.own_cpu_s + trial.sound_s < PAPER_S for trial in trials)
    own = sum(trial.own_cpu_s < 3 for trial in trials)
    loads = [trial.load for trial in trials]
    return Section(
        name="57-voice-missions",
        title="The box mission by voice alone",
        command=command,
        how="The drone's voice asks; a simulated person understands by the sound alone (Moonshine) and answers "
        "from the truth, in one of three natural voices, beside made rotor noise. Both recognisers hear the answers, "
        "which are read back and confirmed. Everything that the drone says up to the last answer is counted, notices "
        "too, and 1 s of reaction for each answer.",
        tables=[
            Table(
                caption="Missions",
                header=("n", "success", "95 %", "questions, mean", f"under {PAPER_S} s", "own share under 3 s"),
                rows=[
                    (
                        str(len(trials)), str(well), f"{100 * low:.1f} to {100 * high:.1f} %",
                        f"{np.mean([t.questions for t in trials]):.2f}", str(under), str(own),
                    )
                ],
            ),
            Table(caption="Seconds of a mission: median and worst", header=("part", "median", "worst"), rows=rows),
        ],
        notes=[
            f"The machine had {min(loads):.0f} to {max(loads):.0f} processes to run on {os.cpu_count()} cores. "
            "What passed on the clock is mostly waiting for a core; processor time is what an idle core takes at most.",
            "Missions that ended without a flight ended so because 'confirm' was not understood twice, or because an "
            "answer fell into a notice of the drone. The latter counts since; these missions were flown before.",
            *failed,
        ],
    )  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--kokoro", type=Path, required=True, help='the folder "voices" of kokoro-js')
    parser.add_argument("--snr", type=float, default=10.0)
    parser.add_argument("--vehicle", default="kinematic")
    parser.add_argument("--out", type=Path, default=Path("runs/bench-voice-missions"))
    parser.add_argument("--dry", action="store_true", help="keep the records, write no page")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    file = options.out / "missions.jsonl"
    kept = [Trial(**json.loads(line)) for line in file.read_text().splitlines()] if file.exists() else []
    trials = {t.seed: t for t in kept if (t.snr_db, t.vehicle) == (options.snr, options.vehicle)}
    speech, voice, ear = speech_for("en"), KokoroSpeech(options.kokoro), hears_here()
    for seed in range(options.seeds):
        if seed not in trials:
            trials[seed] = fly(seed, options.snr, options.vehicle, speech, voice, ear)
            with file.open("a") as lines:
                lines.write(json.dumps(asdict(trials[seed])) + "\n")
            print(
                f"{seed}: {trials[seed].outcome}, {trials[seed].all_s:.1f} s, own {trials[seed].own_s:.1f} s",
                flush=True,
            )
    if not options.dry:
        done = [trials[seed] for seed in sorted(trials) if seed < options.seeds]
        keep(
            section(
                done,
                f"python -m bench.voice_missions --kokoro FOLDER --seeds {len(done)} --snr {options.snr:g} "
                f"--vehicle {options.vehicle}",
            )
        )


if __name__ == "__main__":
    main()
