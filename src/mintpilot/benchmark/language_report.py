"""All figures of ``mintpilot bench language`` as one record, and the tables made of it."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mintpilot.benchmark.instruction_trials import Score, upper_bound
from mintpilot.benchmark.language_cases import answer_cases
from mintpilot.benchmark.language_trials import (
    Answered,
    Counting,
    Speed,
    Worded,
    answer_all,
    parse_all,
    sampled,
    word_all,
)
from mintpilot.core.errors import MintPilotError
from mintpilot.core.ports import LanguageModel
from mintpilot.models.doubles import NoModel

RULES = "template"
"""The way without a model."""
SCHEMA_VERSION = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """What was measured with one language model beside the rules; without one for `RULES`."""

    name: str
    parsed: Score | None
    """None where no list of instructions was given."""
    answered: Answered
    reading_speed: Speed
    """For instructions and answers."""
    worded: Worded | None
    """None for `RULES`: there the template's words are asked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LanguageResult:
    """One run of the measurement."""

    ways: tuple[Way, ...]
    left_out: tuple[str, ...] = ()
    """What was not measured, and why."""
    schema_version: int = field(default=SCHEMA_VERSION)


@dataclass(frozen=True, slots=True, kw_only=True)
class LanguageOptions:
    """What is measured."""

    models: Mapping[str, Callable[[], LanguageModel]]
    """Name → how the model is made; `RULES` is always measured."""
    instructions: Path | None = None
    """A list in the form of ``bench/data/instructions.tsv``."""
    sample: int = 60
    """Answers that a model is given; drawn with seed 0."""


def models_there() -> tuple[str, ...]:
    """The models to try where none is named: what they lack is told among what was left out."""
    return ("embedded", *(["endpoint"] if os.environ.get("MINTPILOT_LLM_URL") else []))


def measure_language(options: LanguageOptions, progress: Callable[[str], None] = lambda _: None) -> LanguageResult:
    """Measures the rules alone and with each model that is there; says what it left out.

    Raises:
        InputError: the file of instructions cannot be used.
    """
    left_out = [] if options.instructions else ["instructions: no list was given; --instructions names one"]
    ways = []
    for name, make in {RULES: NoModel, **options.models}.items():
        progress(f"{name} …")
        try:
            model = make()
        except MintPilotError as error:
            left_out.append(f"{name}: {error}")
            continue
        try:
            ways.append(_way(name, model, options))
        finally:
            getattr(model, "close", lambda: None)()
    return LanguageResult(ways=tuple(ways), left_out=tuple(left_out))


def _way(name: str, model: LanguageModel, options: LanguageOptions) -> Way:
    getattr(model, "wait", lambda: None)()
    counting = Counting(model)
    cases = list(answer_cases())
    is_alone = name == RULES
    return Way(
        name=name,
        parsed=parse_all(options.instructions, counting) if options.instructions else None,
        answered=answer_all(cases if is_alone else sampled(cases, options.sample), counting),
        reading_speed=counting.speed(),
        worded=None if is_alone else word_all(model),
    )


def language_tables(result: LanguageResult) -> list[tuple[str, Sequence[str], list[Sequence[str]]]]:
    """Caption, header and rows of each table."""
    parsed = [_parsed(w.name, w.parsed) for w in result.ways if w.parsed is not None]
    answered = [_answered(w.name, w.answered) for w in result.ways]
    worded = [_worded(w.name, w.worded) for w in result.ways if w.worded is not None]
    speeds = [
        (w.name, "instructions and answers", *_speed(w.reading_speed)) for w in result.ways if w.worded is not None
    ]
    speeds += [(w.name, "wordings", *_speed(w.worded.speed)) for w in result.ways if w.worded is not None]
    tables: list[tuple[str, Sequence[str], list[Sequence[str]]]] = [
        (
            "Instructions",
            ("way", "n", "silently wrong", "at most, 95 %", "within the verbs", "of those right", "refused"),
            [*parsed],
        ),
        (
            "Answers",
            ("way", "n", "understood at once", "after a read-back", "taken though not said", "No for Yes"),
            [*answered],
        ),
        ("Wordings", ("way", "n", "accepted", "in other words", "words, template", "words, model"), [*worded]),
        ("The model's time", ("way", "for", "calls", "p50", "p95", "tokens"), [*speeds]),
    ]
    return [table for table in tables if table[2]]


def _parsed(name: str, found: Score) -> tuple[str, ...]:
    wrong = len(found.wrong)
    bound = f"{100 * upper_bound(wrong, found.n):.2f} %"
    right = _share(found.right, found.within)
    return (name, str(found.n), str(wrong), bound, str(found.within), right, _share(len(found.refused), found.within))


def _share(part: int, whole: int) -> str:
    return f"{100 * part / max(1, whole):.1f} %"


def _answered(name: str, answered: Answered) -> tuple[str, ...]:
    shares = (_share(answered.understood, answered.n), _share(answered.after_read_back, answered.n))
    return (name, str(answered.n), *shares, str(answered.false_guarded), str(answered.no_for_yes))


def _worded(name: str, worded: Worded) -> tuple[str, ...]:
    model_words = f"{worded.model_words:.1f}" if worded.model_words is not None else "–"
    shares = (_share(worded.accepted, worded.n), _share(worded.changed, worded.n))
    return (name, str(worded.n), *shares, f"{worded.template_words:.1f}", model_words)


def _speed(speed: Speed) -> tuple[str, ...]:
    if speed.p50_s is None or speed.p95_s is None:
        return (str(speed.calls), "–", "–", str(speed.tokens))
    return (str(speed.calls), f"{speed.p50_s:.2f} s", f"{speed.p95_s:.2f} s", str(speed.tokens))
