"""How instructions are read, against written-down references. `python -m bench.instructions [--llm NAME] [--file F]`."""

from __future__ import annotations

import argparse
import csv
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from scipy import stats

from bench.sections import ROOT
from mintpilot.core.errors import InputError
from mintpilot.core.task import Task
from mintpilot.language.instruction import parse_instruction
from mintpilot.language.lexicon import singular
from mintpilot.language.reading import parse_with_model

DATA = ROOT / "bench" / "data" / "instructions.tsv"
_HOME_M = (0.0, 0.0, 1.0)
_EMPTY = frozenset(
    "the a an this that these those my our your his her its their some of to in on at by is are who there all each every "
    "any from and into over somewhere it them".split()
)
_ALIKE = {
    "people": "person", "anybody": "anyone", "somebody": "anyone", "someone": "anyone", "near": "near", "next": "near",
    "beside": "near", "by": "near", "close": "near", "inside": "in",
}  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Score:
    """What came of a list."""

    n: int
    within: int
    """So many can be done with the documented verbs."""
    right: int
    """Of those, read as written down."""
    wrong: tuple[str, ...]
    """Read as something else, or read though they must be refused."""
    refused: tuple[str, ...]
    """Refused though they are within the verbs."""


Parse = Callable[[str], Task]


def rows() -> Iterator[dict[str, str]]:
    """The list, one instruction a row."""
    with DATA.open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE)


def score(parse: Parse) -> Score:
    """Reads the whole list."""
    right, wrong, refused, cases = 0, [], [], list(rows())
    for row in cases:
        text = row["instruction"]
        try:
            task = parse(text)
        except InputError:
            refused += [text] if row["within"] == "yes" else []
            continue
        if row["within"] == "yes" and read(task) in references(row["reference"]):
            right += 1
        else:
            wrong.append(f"{text} | {' ; '.join(s.text for s in task.steps)} | out: {', '.join(task.keep_out)}")
    within = sum(row["within"] == "yes" for row in cases)
    return Score(n=len(cases), within=within, right=right, wrong=tuple(wrong), refused=tuple(refused))


def read(task: Task) -> tuple[object, ...]:
    """A task in the notation of the references."""
    steps = []
    for step, goal in zip(task.steps, (*task.subgoals, *task.subgoals[-1:]), strict=False):
        if step.action == "seek":
            steps.append(("seek", frozenset(), frozenset(), ""))
            continue
        marks = (f"^{goal.height_m:g}" if goal.height_m is not None else "") + (
            f"~{goal.dwell_s:g}" if f"for {goal.dwell_s:g} s" in step.text else ""
        )
        steps.append((step.action, _content(step.target), _content(step.place), marks))
    outs = frozenset((_content(re.sub(r"\(.*\)|, if possible", "", out)), _metres(out)) for out in task.keep_out)
    return (tuple(steps), outs, task.slowly)


def references(text: str) -> list[tuple[object, ...]]:
    """The readings that are right."""
    return [_reference(one) for one in text.split(" | ")]


def _reference(text: str) -> tuple[object, ...]:
    steps, outs, slow = [], set(), False
    for part in text.split("; "):
        action, _, rest = part.partition(":")
        marks = "".join(re.findall(r" ([\^~][\d.]+)", rest))
        slow |= rest.endswith(" slow")
        rest = re.sub(r" [\^~][\d.]+| slow$", "", rest)
        if action == "out":
            kind = re.sub(r" [\d.]+$", "", rest)
            region = kind.strip() in ("smoke", "door", "area")
            outs.add((_content(kind), _metres(rest) or ("" if region else "2")))
        elif action == "seek":
            steps.append(("seek", frozenset(), frozenset(), ""))
        else:
            target, _, place = f" {rest} ".partition(" @ ")
            steps.append((action, _content(target), _content(place), marks))
    return (tuple(steps), frozenset(outs), slow)


def _metres(text: str) -> str:
    found = re.search(r"[\d.]+", text)
    return f"{float(found[0]):g}" if found else ""


def _content(text: str) -> frozenset[str]:
    words = re.findall(r"[a-z]+|\d+(?:\.\d+)?", text.lower())
    plain = (f"{float(w):g}" if w[0].isdigit() else _ALIKE.get(singular(w), _ALIKE.get(w, singular(w))) for w in words)
    return frozenset(w for w in plain if w not in _EMPTY and w not in ("x", "y", "position"))


def upper_bound(count: int, n: int) -> float:
    """The largest share that is consistent with so many of n, one-sided, exact, at 95 %."""
    return float(stats.beta.ppf(0.95, count + 1, n - count)) if count < n else 1.0


def report(name: str, found: Score) -> None:
    """Prints the figures."""
    wrong = len(found.wrong)
    print(f"{name}: n {found.n}; silently wrong {wrong} (at most {upper_bound(wrong, found.n):.2%} at 95 %); "
          f"within the verbs {found.within}, of those right {found.right} ({found.right / found.within:.1%}), "
          f"refused {len(found.refused)}")  # fmt: skip
    for line in found.wrong:
        print(f"  wrong: {line}")


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
    parser.add_argument("--refused", action="store_true", help="print what was refused though it is within the verbs")
    options = parser.parse_args()
    if options.file:
        plain_list(options.file)
        return
    found = score(lambda text: parse_instruction(text, home_m=_HOME_M))
    report("rules", found)
    if options.refused:
        print(*(f"  refused: {line}" for line in found.refused), sep="\n")
    if options.llm:
        from mintpilot.assembly.registry import load

        model = load("language", options.llm)()
        report(options.llm, score(lambda text: parse_with_model(text, model, home_m=_HOME_M, timeout_s=60.0)))


if __name__ == "__main__":
    main()
