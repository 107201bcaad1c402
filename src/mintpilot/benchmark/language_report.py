"""All figures of ``mintpilot bench language`` as one record, and the tables made of it."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from mintpilot.benchmark.introplan import LOOKED_AT, Ambiguity, ambiguity, meant_by_model, meant_by_rules, read_scenes
from mintpilot.benchmark.language_cases import answer_cases
from mintpilot.benchmark.language_trials import (
    Answered,
    Counting,
    Parsed,
    Speed,
    Worded,
    answer_all,
    parse_all,
    sampled,
    word_all,
)
from mintpilot.core.errors import MintPilotError
from mintpilot.core.ports import LanguageModel
from mintpilot.language.doubles import NoModel

RULES = "template"
"""The way without a model."""
SCHEMA_VERSION = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """What was measured with one language model beside the rules; without one for `RULES`."""

    name: str
    parsed: Parsed
    answered: Answered
    reading_speed: Speed
    """For instructions and answers."""
    worded: Worded | None
    """None for `RULES`: there the template's words are asked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LanguageResult:
    """One run of the measurement."""

    ways: tuple[Way, ...]
    ambiguous: tuple[Ambiguity, ...] = ()
    left_out: tuple[str, ...] = ()
    """What was not measured, and why."""
    schema_version: int = field(default=SCHEMA_VERSION)


@dataclass(frozen=True, slots=True, kw_only=True)
class LanguageOptions:
    """What is measured."""

    models: Mapping[str, Callable[[], LanguageModel]]
    """Name → how the model is made; `RULES` is always measured."""
    instructions: Path | None = None
    """A file in IntroPlan's form."""
    sample: int = 60
    """Answers, and held-out ambiguous instructions, that a model is given; drawn with seed 0."""


def models_there() -> tuple[str, ...]:
    """The models to try where none is named: what they lack is told among what was left out."""
    return ("embedded", *(["endpoint"] if os.environ.get("MINTPILOT_LLM_URL") else []))


def measure_language(options: LanguageOptions, progress: Callable[[str], None] = lambda _: None) -> LanguageResult:
    """Measures the rules alone and with each model that is there; says what it left out.

    Raises:
        InputError: the file of instructions cannot be used.
    """
    scenes = read_scenes(options.instructions) if options.instructions else []
    first = [s for s in scenes if s.number < LOOKED_AT]
    rest = [s for s in scenes if s.number >= LOOKED_AT]
    left_out = [] if scenes else ["ambiguous instructions: no file was given; --instructions names one"]
    ambiguous = [
        ambiguity(RULES, part, some, meant_by_rules)
        for part, some in (("looked at", first), ("held out", rest))
        if some
    ]
    ways = []
    for name, make in {RULES: NoModel, **options.models}.items():
        progress(f"{name} …")
        try:
            model = make()
        except MintPilotError as error:
            left_out.append(f"{name}: {error}")
            continue
        try:
            ways.append(_way(name, model, options.sample))
            if rest and name != RULES:
                meant = partial(meant_by_model, model=model)
                ambiguous.append(
                    ambiguity(name, "held out, sample", rest[:: max(1, len(rest) // options.sample)], meant)
                )
        finally:
            getattr(model, "close", lambda: None)()
    return LanguageResult(ways=tuple(ways), ambiguous=tuple(ambiguous), left_out=tuple(left_out))


def _way(name: str, model: LanguageModel, sample: int) -> Way:
    getattr(model, "wait", lambda: None)()
    counting = Counting(model)
    cases = list(answer_cases())
    is_alone = name == RULES
    return Way(
        name=name,
        parsed=parse_all(counting),
        answered=answer_all(cases if is_alone else sampled(cases, sample), counting),
        reading_speed=counting.speed(),
        worded=None if is_alone else word_all(model),
    )


def language_tables(result: LanguageResult) -> list[tuple[str, Sequence[str], list[Sequence[str]]]]:
    """Caption, header and rows of each table."""
    parsed = [(w.name, str(w.parsed.n), _share(w.parsed.as_expected, w.parsed.n), str(w.parsed.as_something_else))
              for w in result.ways]  # fmt: skip
    answered = [_answered(w.name, w.answered) for w in result.ways]
    worded = [_worded(w.name, w.worded) for w in result.ways if w.worded is not None]
    speeds = [
        (w.name, "instructions and answers", *_speed(w.reading_speed)) for w in result.ways if w.worded is not None
    ]
    speeds += [(w.name, "wordings", *_speed(w.worded.speed)) for w in result.ways if w.worded is not None]
    ambiguous = [
        (a.way, a.part, str(a.n), *(f"{100 * x:.1f} %" for x in (a.exact, a.over_ask, a.over_step, a.unsafe)))
        for a in result.ambiguous
    ]
    tables: list[tuple[str, Sequence[str], list[Sequence[str]]]] = [
        ("Instructions", ("way", "n", "as expected", "as something else"), [*parsed]),
        (
            "Answers",
            ("way", "n", "understood at once", "after a read-back", "taken though not said", "No for Yes"),
            [*answered],
        ),
        ("Wordings", ("way", "n", "accepted", "in other words", "words, template", "words, model"), [*worded]),
        ("The model's time", ("way", "for", "calls", "p50", "p95", "tokens"), [*speeds]),
        ("Ambiguous instructions", ("way", "part", "n", "exact set", "over-ask", "over-step", "unsafe"), [*ambiguous]),
    ]
    return [table for table in tables if table[2]]


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
