"""How instructions are read, against references. `python -m bench.instructions [--llm NAME] [--file F]`."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from bench.sections import ROOT, Section, Table, keep
from mintpilot.assembly.registry import load
from mintpilot.benchmark.instruction_trials import Score, read_rows, score, upper_bound
from mintpilot.core.errors import InputError
from mintpilot.language.instruction import parse_instruction
from mintpilot.language.instruction_model import parse_with_model

DATA = ROOT / "bench" / "data" / "instructions.tsv"
_HOME_M = (0.0, 0.0, 1.0)


def report(name: str, found: Score) -> None:
    """Prints the figures."""
    wrong = len(found.wrong)
    print(f"{name}: n {found.n}; silently wrong {wrong} (at most {upper_bound(wrong, found.n):.2%} at 95 %); "
          f"within the verbs {found.within}, of those right {found.right} ({found.right / found.within:.1%}), "
          f"refused {len(found.refused)}")  # fmt: skip
    for line in found.wrong:
        print(f"  wrong: {line}")


LISTS = (
    ("instructions", "written before the rules of November 2026 by their author, mended since"),
    ("instructions_a", "first read after the grammar was made; what it showed was mended"),
    ("instructions_b", "first read after that; the order of a search was mended, nothing else"),
    ("instructions_c", "written before its author saw any rule; what it showed was mended"),
)
NOTES = (
    "At first reading, before anything was mended: list a 59 of 82 within the verbs as meant and none silently wrong; "
    "list b 57 of 81, and 2 of 157 silently wrong: *check whether anybody is injured and come back* came back first "
    "(refused since), *fly to my house* means the house (kept). Four more were flagged that mean the same in other "
    "words; their references have that reading too now.",
    "List c at first reading: 70 of 151 within the verbs as meant (46.4 %), 4 of 338 silently wrong (at most 2.69 % at "
    "95 %): *drop the stone on the dog* was a delivery, *stay near the wall and go to the gate* went to both (both "
    "are refused since); *how many people are in the hall* leaves out the hall, *look for survivors* looks for "
    "everybody who needs help (both kept, and counted as wrong).",
    "Lists a and b are by somebody who had read the rules before, not by strangers. The goal, none silently wrong "
    "within 1 % at 95 % on 300 that nobody mended after, is not shown by them.",
    "Most refusals are one unknown word beside a known one (*the leaking valve*), which is a rule, and phrases.",
)


def keep_section() -> None:
    """All lists that are kept with the project, by the rules alone, into the results."""
    rows = []
    for name, history in LISTS:
        found = score(read_rows(DATA.with_name(f"{name}.tsv")), lambda text: parse_instruction(text, home_m=_HOME_M))
        wrong = len(found.wrong)
        share = f"{found.right} of {found.within} ({found.right / found.within:.1%})"
        rows.append((name, history, str(found.n), str(wrong), f"{upper_bound(wrong, found.n):.2%}", share))
    header = (
        "list",
        "history",
        "n",
        "silently wrong",
        "exact upper bound, 95 %",
        "as meant, of those within the verbs",
    )
    keep(
        Section(
            name="51-instructions",
            title="Instructions, by the rules alone",
            command="python -m bench.instructions --keep",
            how="Instructions with the steps that they mean (`bench/data`). A refusal is never wrong.",
            tables=[Table(caption="As they are read now", header=header, rows=rows)],
            notes=NOTES,
        )
    )


def plain_list(file: Path) -> None:
    """Counts what is done of a list without references, and prints what was read for looking through by eye."""
    lines = [line.removeprefix("Task:").strip() for line in file.read_text("utf-8").splitlines()]
    raw = file.read_text("utf-8")
    if "\nTask:" in raw:
        lines = re.findall(r"^Task: (.+)$", raw, re.MULTILINE)
    texts, done = [line for line in lines if line], 0
    for text in texts:
        try:
            task = parse_instruction(text, home_m=_HOME_M)
        except InputError:
            continue
        done += 1
        print(f"  {text} | {' ; '.join(step.text for step in task.steps)} | out: {', '.join(task.keep_out)}")
    print(f"{file.name}: n {len(texts)}, done {done}, refused {len(texts) - done}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--llm", default="")
    parser.add_argument("--file", type=Path)
    parser.add_argument("--data", type=Path, default=DATA, help="another list with references")
    parser.add_argument("--refused", action="store_true", help="print what was refused though it is within the verbs")
    parser.add_argument("--keep", action="store_true", help="put the figures of all lists into docs/results.md")
    options = parser.parse_args()
    if options.keep:
        keep_section()
        return
    if options.file:
        plain_list(options.file)
        return
    found = score(read_rows(options.data), lambda text: parse_instruction(text, home_m=_HOME_M))
    report("rules", found)
    if options.refused:
        print(*(f"  refused: {line}" for line in found.refused), sep="\n")
    if options.llm:
        model = load("language", options.llm)()
        helped = score(
            read_rows(options.data), lambda text: parse_with_model(text, model, home_m=_HOME_M, timeout_s=60.0)
        )
        report(options.llm, helped)


if __name__ == "__main__":
    main()
