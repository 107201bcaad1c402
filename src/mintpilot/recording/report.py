"""The report for people: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from pydantic import JsonValue

from mintpilot.core.mission import Outcome
from mintpilot.core.query import Reply
from mintpilot.recording.frames import FRAMES, FrameStore, crop_jpeg
from mintpilot.recording.people import look_line, people_lines, people_seen
from mintpilot.recording.record import GapRecord, MissionRecord, QuestionRecord, SeenRecord
from mintpilot.recording.spoken import heading, outcome_words
from mintpilot.recording.tree_drawing import percent
from mintpilot.recording.tree_svg import tree_svg

REPORT_FILE = "report.html"
MAX_PICTURES = 18
"""Close-ups shown; what bears on a gap comes first."""
_REPLY_WORDS = {Reply.YES: "Yes", Reply.NO: "No", Reply.UNSURE: "Don't know", Reply.TIMEOUT: "No answer"}
"""Replies as a person would say them."""


def reply_words(question: QuestionRecord) -> str:
    """The reply in a word or two: ``Yes``, the label of an option."""
    if question.option is not None:
        return question.replies[question.option]
    return _REPLY_WORDS[question.reply]


def consequence(question: QuestionRecord) -> str:
    """What the reply did to the flight; empty for one that named no part of the query."""
    if question.option is not None:
        return question.option_means[question.option] if question.option < len(question.option_means) else ""
    return {Reply.YES: question.yes_means, Reply.NO: question.no_means}.get(question.reply, "")


_KNOWN_WORDS = {
    ("region", "open"): "not known whether it can be flown through",
    ("region", "yes"): "known to be free",
    ("region", "no"): "known to be blocked",
    ("room", "open"): "not known whether somebody is inside",
    ("room", "yes"): "somebody is inside",
    ("room", "no"): "nobody is inside",
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
    environment.filters |= {"number": number, "percent": percent}
    plot = folder / "topdown.svg"
    return environment.get_template("report.html.j2").render(
        record=record,
        gaps=weightiest_first(record.gaps),
        tone="good" if record.outcome is Outcome.SUCCESS else "stopped" if record.outcome in _STOPPED else "bad",
        headline=outcome_words(record.outcome, record.language),
        heading=partial(heading, lang=record.language),
        reply_words=reply_words,
        consequence=consequence,
        plot=_data_uri(plot.read_bytes(), "image/svg+xml") if plot.is_file() else "",
        tree=Markup(tree_svg(record.tree)) if record.tree else "",  # made here of escaped text
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
            caption = _caption(seen)
            uri = _data_uri(crop, "image/jpeg")
            found.append(Picture(data=uri, title=seen.id, caption=caption, gap=seen.id in subjects))
    return found


def weightiest_first(gaps: Iterable[GapRecord]) -> list[GapRecord]:
    """Gaps in the order in which they interest people: asked, then relevant, then the rest."""
    return sorted(gaps, key=lambda gap: (not gap.asked, not gap.relevant))


def number(value: float | None, unit: str = "", digits: int = 1) -> str:
    """A figure with its unit, or a dash where there is none; a space that does not break keeps them together."""
    if value is None:
        return "–"
    return f"{value:.{digits}f}\N{NO-BREAK SPACE}{unit}" if unit else f"{value:.{digits}f}"


def _caption(seen: SeenRecord) -> str:
    x, y, _ = seen.position_m
    what = _KNOWN_WORDS.get((seen.kind, seen.state)) or f"seen in {seen.sightings} pictures"
    view = seen.view[0] if seen.view else 0
    return f"{seen.description}; {what}; at {x:.1f} m east, {y:.1f} m north (picture {view})"


def _data_uri(data: bytes, media: str) -> str:
    return f"data:{media};base64,{base64.b64encode(data).decode()}"


def _flat(value: JsonValue, name: str = "") -> Iterable[tuple[str, str]]:
    """Nested settings as (dotted name, value) lines."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _flat(item, f"{name}.{key}" if name else key)
    else:
        yield name, "–" if value is None else str(value)
