"""Instructions with the steps that they mean, and how many are read so.

The notation of references is explained in ``bench/data/README.md``.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from scipy import stats

from mintpilot.core.errors import InputError
from mintpilot.core.task import Task
from mintpilot.language.lexicon import singular, word_set

_EMPTY = word_set(
    "the a an this that these those my our your his her its their some of to in on at by is are who there all each "
    "every any from and into over somewhere it them with behind room"
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


def read_rows(file: Path) -> list[dict[str, str]]:
    """A list of instructions with their references.

    Raises:
        InputError: the file cannot be read, or has other columns than ``within``, ``instruction`` and ``reference``.
    """
    try:
        with file.open(encoding="utf-8", newline="") as opened:
            rows = list(csv.DictReader(opened, delimiter="\t", quoting=csv.QUOTE_NONE))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"instructions {file} cannot be read ({error}): give a TSV file") from error
    if not rows or not {"within", "instruction", "reference"} <= rows[0].keys():
        raise InputError(f"instructions {file}: the columns must be 'within', 'instruction' and 'reference'")
    return rows


def score(rows: Sequence[Mapping[str, str]], parse: Parse) -> Score:
    """Reads the whole list."""
    right, wrong, refused, cases = 0, [], [], list(rows)
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
            wrong.append(f"{text} | {' ; '.join(str(s.text) for s in task.steps)} | out: {', '.join(task.keep_out)}")
    within = sum(row["within"] == "yes" for row in cases)
    return Score(n=len(cases), within=within, right=right, wrong=tuple(wrong), refused=tuple(refused))


def read(task: Task) -> tuple[object, ...]:
    """A task in the notation of the references."""
    steps: list[tuple[object, ...]] = []
    for step, goal in zip(task.steps, (*task.subgoals, *task.subgoals[-1:]), strict=False):
        if step.action == "seek":
            steps.append(("seek", frozenset(), frozenset(), ""))
            continue
        marks = (f"^{goal.height_m:g}" if goal.height_m is not None else "") + (
            f"~{goal.dwell_s:g}" if f"for {goal.dwell_s:g} s" in str(step.text) else ""
        )
        steps.append(_step(step.action, step.target, step.place, marks))
    outs = frozenset((_content(re.sub(r"\(.*\)|, if possible", "", out)), _metres(out)) for out in task.keep_out)
    return (tuple(steps), outs, task.slowly)


def _step(action: str, target: str, place: str, marks: str) -> tuple[object, ...]:
    """What is handed over and to whom are kept apart; otherwise thing and place together say what is meant."""
    if action == "deliver":
        return (action, _content(target), _content(place), marks)
    return (action, _content(f"{target} {place}"), frozenset(), marks)


def references(text: str) -> list[tuple[object, ...]]:
    """The readings that are right."""
    return [_reference(one) for one in text.split(" | ")]


def _reference(text: str) -> tuple[object, ...]:
    steps: list[tuple[object, ...]] = []
    outs: set[tuple[frozenset[str], str]] = set()
    slow = False
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
            steps.append(_step(action, target, place, marks))
    return (tuple(steps), frozenset(outs), slow)


def _metres(text: str) -> str:
    found = re.search(r"[\d.]+", text)
    return f"{float(found[0]):g}" if found else ""


def _content(text: str) -> frozenset[str]:
    words = re.findall(r"[a-z]+|\d+(?:\.\d+)?", text.lower())
    told = [w for w in words if w not in _EMPTY]
    plain = (f"{float(w):g}" if w[0].isdigit() else _ALIKE.get(singular(w), _ALIKE.get(w, singular(w))) for w in told)
    return frozenset(w for w in plain if w not in _EMPTY and w not in ("x", "y", "position"))


def upper_bound(count: int, n: int) -> float:
    """The largest share that is consistent with so many of n, one-sided, exact, at 95 %."""
    return float(stats.beta.ppf(0.95, count + 1, n - count)) if count < n else 1.0
