"""How answers are heard, into docs/results.md. `python -m bench.voice --clips FOLDER [--most N]`."""

from __future__ import annotations

import argparse
from pathlib import Path

from bench.sections import Section, keep
from bench.sections import Table as PageTable
from mintpilot.benchmark.voice_report import VoiceOptions, measure_voice, voice_tables


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clips", type=Path)
    parser.add_argument("--most", type=int)
    parser.add_argument("--voices", type=int, default=7)
    parser.add_argument("--kokoro", type=Path)
    parser.add_argument("--alone", type=float, default=1.0)
    parser.add_argument("--snr", type=float, nargs="*", default=[20, 10, 5, 0])
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
    result = measure_voice(wanted, print)
    if options.dry:
        return
    keep(
        Section(
            name="56-voice",
            title="Voice",
            command="python -m bench.voice --clips FOLDER --kokoro FOLDER "
            f"--voices {options.voices} --alone {options.alone:g} --snr {' '.join(f'{s:g}' for s in options.snr)}",
            how="One-second recordings of yes, no and other words, and phrases synthesised in several voices; rotor "
            "noise is made. The thresholds were chosen on other clips, other phrases and, but for the one American "
            "speaker, other voices. Yes and no are taken as answers to a question about smoke. A guarded update takes "
            "effect only by 'confirm' after a read-back, so what is falsely taken for 'confirm' is false guarded "
            "acceptance; what is falsely taken for yes is read back only.",
            tables=[PageTable(caption=c, header=h, rows=r) for c, h, r in voice_tables(result)],
            notes=result.notes,
        )
    )


if __name__ == "__main__":
    main()
