"""How answers are heard, into docs/results.md. `python -m bench.voice --clips FOLDER [--most N]`."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from statistics import median, quantiles

from bench.sections import Section, keep
from bench.sections import Table as PageTable
from mintpilot.benchmark.intervals import clopper_pearson, clopper_pearson_upper
from mintpilot.benchmark.voice_report import VoiceOptions, kept_voice, measure_voice, voice_tables
from mintpilot.benchmark.voice_trials import OTHER, VoiceTrial, outcome


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clips", type=Path)
    parser.add_argument("--most", type=int)
    parser.add_argument("--voices", type=int, default=7)
    parser.add_argument("--kokoro", type=Path)
    parser.add_argument("--alone", type=float, default=1.0)
    parser.add_argument("--snr", type=float, nargs="*", default=[20, 10, 5, 0])
    parser.add_argument("--kept", action="store_true", help="write the page from the records that there are")
    parser.add_argument("--dry", action="store_true", help="measure and keep the records, write no page")
    parser.add_argument("--out", type=Path, default=Path("runs/bench-voice"))
    options = parser.parse_args()
    wanted = VoiceOptions(
        clips=options.clips,
        most=options.most,
        voices=options.voices,
        kokoro=options.kokoro,
        alone_h=options.alone,
        snrs_db=(None, *options.snr),
        out=options.out,
    )
    result = kept_voice(options.out) if options.kept else measure_voice(wanted, print)
    if options.dry:
        return
    keep(
        Section(
            name="56-voice",
            title="Voice",
            command="python -m bench.voice --clips FOLDER --kokoro FOLDER "
            f"--voices {options.voices} --alone {options.alone:g} --snr {' '.join(f'{s:g}' for s in options.snr)}"
            + (" --kept" if options.kept else ""),
            how="One-second recordings of yes, no and other words by many speakers, and phrases synthesised in seven "
            "voices (American, British, Scottish; no recording of 'confirm' or of an order was at hand); rotor noise "
            "is made. The thresholds were chosen on other clips, other phrases and, but for the one American man Joe, "
            "other voices. Yes and no are taken as answers to a question about smoke. A guarded update takes effect "
            "only by 'confirm' after a read-back, so what is falsely taken for 'confirm' is false guarded acceptance; "
            "what is falsely taken for yes is read back only.",
            tables=[PageTable(caption=c, header=h, rows=r) for c, h, r in voice_tables(result)],
            notes=[*result.notes, *verdicts(result.trials)],
        )
    )


def verdicts(trials: Sequence[VoiceTrial]) -> list[str]:
    """What was to be reached, and what was."""
    found = []
    for snr_db, least in ((None, 97), (10.0, 90)):
        said = [trial for trial in trials if trial.snr_db == snr_db and trial.says != OTHER]
        right = sum(outcome(trial) == trial.says for trial in said)
        low, high = clopper_pearson(right, len(said))
        reached = "reached" if 100 * right >= least * len(said) else "not reached"
        found.append(
            f"Accuracy {'without rotors' if snr_db is None else f'at {snr_db:g} dB'}, recordings and synthesised words "
            f"together: {right} of {len(said)} = {100 * right / max(1, len(said)):.1f} % ({100 * low:.1f} to "
            f"{100 * high:.1f} %); {least} % wanted: {reached}."
        )
    others = [trial for trial in trials if trial.says == OTHER and trial.source not in ("rotors", "silence")]
    wrong = sum(outcome(trial) == "confirm" for trial in others)
    hours = sum(trial.sound_s for trial in others) / 3600
    orders = sum(outcome(trial) not in ("yes", "no", "confirm", OTHER) for trial in others)
    shown = "shown" if len(others) >= 2995 and not wrong else "not shown yet; the measurement goes on where it stopped"
    found.append(
        f"False guarded acceptance: {wrong} of {len(others)} utterances that are no answer, at most "
        f"{100 * clopper_pearson_upper(wrong, len(others)):.2f} % with 95 %. That it is at most 0.1 % takes 2,995 "
        f"without an error, 600 in each condition: {shown}. False orders: {orders} in {hours:.2f} hours of other "
        "people's talk."
    )
    times = [trial.answer_cpu_s for trial in trials if trial.utterances and trial.source not in ("rotors", "silence")]
    found.append(
        f"From the end of speech to the answer: 0.4 s of silence, and {median(times):.2f} s of processor time (median; "
        f"{quantiles(times, n=20)[18]:.2f} s in 95 %); 0.8 s wanted, reached where a core is free. The time that "
        f"passed is of a machine on which {os.getloadavg()[0]:.0f} processes shared {os.cpu_count()} cores, and this "
        "one came last."
    )
    found.append(
        "'Stop it' was added to the orders for holding after it had been heard here. Before, with the shorter decoding "
        "of Whisper, the least probability of free text was set from 0.5 to 0.4. No threshold of short words changed."
    )
    return found


if __name__ == "__main__":
    main()
