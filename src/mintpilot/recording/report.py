"""The report for people: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from pydantic import JsonValue

from mintpilot.core.message import Message, message
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Reply
from mintpilot.recording.frames import FRAMES, FrameStore, crop_jpeg
from mintpilot.recording.people import look_line, people_lines, people_seen
from mintpilot.recording.record import GapRecord, MissionRecord, QuestionRecord, RuleRecord, SeenRecord
from mintpilot.recording.tree_drawing import percent
from mintpilot.recording.tree_svg import tree_svg
from mintpilot.recording.words import OUTCOME_WORDS, REPLY_WORDS, stage_words
from mintpilot.wording.speech import Speech

REPORT_FILE = "report.html"
MAX_PICTURES = 18
"""Close-ups shown; what bears on a gap comes first."""


def reply_words(question: QuestionRecord, speech: Speech) -> str:
    """The reply in a word or two: ``Yes``, the label of an option."""
    if question.option is not None:
        return question.replies[question.option]
    return speech(REPLY_WORDS[question.reply])


def consequence(question: QuestionRecord) -> str:
    """What the reply did to the flight; empty for one that named no part of the query."""
    if question.option is not None:
        return question.option_means[question.option] if question.option < len(question.option_means) else ""
    return {Reply.YES: question.yes_means, Reply.NO: question.no_means}.get(question.reply, "")


_KNOWN_WORDS = {
    ("region", "open"): message("not known whether it can be flown through"),
    ("region", "yes"): message("known to be free"),
    ("region", "no"): message("known to be blocked"),
    ("room", "open"): message("not known whether somebody is inside"),
    ("room", "yes"): message("somebody is inside"),
    ("room", "no"): message("nobody is inside"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A close-up with its caption."""

    data: str
    """As a data URI."""
    title: str
    caption: str
    gap: bool
    """Whether a gap is about it."""


def report_html(record: MissionRecord, folder: Path) -> str:
    """The report as HTML; pictures and the top-down plot come from the run folder where they are there.

    All words from outside (labels, questions, answers) are escaped.
    """
    environment = Environment(
        loader=PackageLoader("mintpilot.recording"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    plot, speech = folder / "topdown.svg", Speech(record.language)
    environment.filters |= {"number": speech.number, "percent": lambda share: percent(share, speech)}
    return environment.get_template("report.html.j2").render(
        record=record,
        gaps=weightiest_first(record.gaps),
        tone="good" if record.outcome is Outcome.SUCCESS else "stopped" if record.outcome in _STOPPED else "bad",
        headline=speech(OUTCOME_WORDS[record.outcome]),
        stage_words=lambda stage: speech(stage_words(stage)),
        t=lambda template, **values: speech(Message(template, tuple(values.items()))),
        what_words=lambda seen: _what(seen, speech),
        rule_words=lambda rule: speech(rule_message(rule)),
        reply_words=lambda question: reply_words(question, speech),
        consequence=consequence,
        plot=_data_uri(plot.read_bytes(), "image/svg+xml") if plot.is_file() else "",
        tree=Markup(tree_svg(record.tree, speech=speech)) if record.tree else "",  # made here of escaped text
        pictures=pictures(record, folder),
        people=[*people_lines(record), *(look_line(look, record.language) for look in record.looks)],
        slowest_s=max(record.timings_s.values(), default=0.0),
        settings=list(_flat(record.settings)),
    )


_STOPPED = {Outcome.ABORTED, Outcome.NO_SAFE_PLAN, Outcome.PARTIAL}
"""Endings that are nobody's failure."""


def pictures(record: MissionRecord, folder: Path) -> list[Picture]:
    """Close-ups of what was found, at most `MAX_PICTURES`: people, what a gap is about, what is rare."""
    subjects = {g.subject for g in record.gaps} | {v.value for g in record.gaps for v in g.values}
    store = FrameStore(folder / FRAMES)
    found: list[Picture] = []
    alike = Counter(seen.state for seen in record.seen)
    people = {seen.id for seen in people_seen(record)}
    rank = lambda s: (s.id not in people, s.id not in subjects, s.kind == "object", alike[s.state], s.id)  # noqa: E731
    order = sorted(record.seen, key=rank)
    for seen in order:
        crop = crop_jpeg(store.file(seen.view[0]), seen.view[1:]) if seen.view and len(found) < MAX_PICTURES else None
        if crop is not None:
            caption = _caption(seen, Speech(record.language))
            uri = _data_uri(crop, "image/jpeg")
            found.append(Picture(data=uri, title=seen.id, caption=caption, gap=seen.id in subjects))
    return found


def weightiest_first(gaps: Iterable[GapRecord]) -> list[GapRecord]:
    """Gaps in the order in which they interest people: asked, then relevant, then the rest."""
    return sorted(gaps, key=lambda gap: (not gap.asked, not gap.relevant))


def rule_message(rule: RuleRecord) -> Message:
    """Whether a rule was kept."""
    if rule.kept is None:
        return message("rule not judged: {rule}", rule=rule.text)
    return message("rule kept: {rule}", rule=rule.text) if rule.kept else message("rule BROKEN: {rule}", rule=rule.text)


def _what(seen: SeenRecord, speech: Speech) -> str:
    known = _KNOWN_WORDS.get((seen.kind, seen.state))
    return speech.thing(seen.state) if known is None else speech(known)


def _caption(seen: SeenRecord, speech: Speech) -> str:
    x, y, _ = seen.position_m
    sightings = message("seen in {count} pictures", count=seen.sightings)
    at = message(
        "at {x:.1f} m east, {y:.1f} m north (picture {number})", x=x, y=y, number=seen.view[0] if seen.view else 0
    )
    return "; ".join([seen.description, speech(_KNOWN_WORDS.get((seen.kind, seen.state)) or sightings), speech(at)])


def _data_uri(data: bytes, media: str) -> str:
    return f"data:{media};base64,{base64.b64encode(data).decode()}"


def _flat(value: JsonValue, name: str = "") -> Iterable[tuple[str, str]]:
    """Nested settings as (dotted name, value) lines."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _flat(item, f"{name}.{key}" if name else key)
    else:
        yield name, "–" if value is None else str(value)
