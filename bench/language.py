"""What a language model adds to the rules, into docs/results.md. `python -m bench.language [--llm embedded]`."""

from __future__ import annotations

import argparse
from pathlib import Path

from bench.sections import ROOT, Section, Table, keep
from mintpilot.assembly.registry import load
from mintpilot.benchmark.language_report import LanguageOptions, language_tables, measure_language, models_there

INSTRUCTIONS = ROOT / "bench" / "data" / "instructions.tsv"
NOTES = (
    "The answers were written while earlier rules were made, with an eye on them. Answers are now taken from closed "
    "lists or read back, so far fewer are understood at once; the section on answers says what that buys.",
    "What a model makes of an answer is only read back; it never settles one.",
    "The instructions were written before the grammar, by the same author. At first reading 3 of 361 were silently "
    "wrong (at most 2.1 %), and 196 of the 211 within the verbs right; the classes behind those were mended then.",
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--llm", action="append", default=[])
    parser.add_argument("--instructions", type=Path, default=INSTRUCTIONS)
    parser.add_argument("--sample", type=int, default=60)
    parser.add_argument("--dry", action="store_true", help="print only; leave docs/results.md alone")
    options = parser.parse_args()
    instructions = options.instructions if options.instructions.exists() else None
    names = options.llm or models_there()
    models = {name: load("language", name) for name in names}
    result = measure_language(LanguageOptions(models=models, instructions=instructions, sample=options.sample), print)
    named = "".join(f" --llm {name}" for name in names)
    section = Section(
        name="50-language",
        title="Language: the rules alone, and with models",
        command=f"python -m bench.language{named} --sample {options.sample}",
        how="As `mintpilot bench language` measures: the instructions in bench/data, the package's own answers. An "
        "answer that was unsure or beside the point counts as understood when it is asked again. Models get a sample.",
        tables=[Table(caption=caption, header=header, rows=rows) for caption, header, rows in language_tables(result)],
        notes=(*NOTES, *(f"Left out: {reason}" for reason in result.left_out)),
    )
    print(section.markdown())
    if not options.dry:
        keep(section)


if __name__ == "__main__":
    main()
