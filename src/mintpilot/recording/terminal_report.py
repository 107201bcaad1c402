"""The mission report at the end of a run, on a terminal or in a log file."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from pathlib import Path

from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from mintpilot.core.mission import Outcome, Sight
from mintpilot.core.query import Reply
from mintpilot.recording.people import look_line, people_lines
from mintpilot.recording.record import GapRecord, MissionRecord, QuestionRecord
from mintpilot.recording.report import REPORT_FILE, consequence, number, reply_words, weightiest_first
from mintpilot.recording.spoken import heading, outcome_words
from mintpilot.recording.tree_drawing import tree_text
from mintpilot.recording.words import printable

WIDTH = 100
"""Columns that the report fits into."""
_KEPT = {True: "kept", False: "BROKEN", None: "not judged"}
"""What is said of a rule."""
_RULE_STYLES = {True: "", False: "bold red", None: "yellow"}
_STYLES = {
    Reply.YES: "bold green",
    Reply.NO: "bold red",
    Reply.OPTION: "bold cyan",
    Reply.UNSURE: "bold yellow",
    Reply.TIMEOUT: "bold yellow",
}


def print_report(record: MissionRecord, console: Console) -> None:
    """Prints the mission in short form, at most 100 columns wide.

    Without a terminal the console writes plain text; control characters in words from outside are taken out.
    """
    width = min(console.width, WIDTH)
    for part in (_head(record), _saw(record), _gaps(record, width), _asked(record), _decided(record), _flown(record)):
        console.print(part, width=width)


def _head(record: MissionRecord) -> RenderableType:
    styles = {Outcome.SUCCESS: "bold green", Outcome.PARTIAL: "bold yellow"}
    style = styles.get(record.outcome, "bold red")
    lines = [Text(outcome_words(record.outcome, record.language).upper(), style), _plain(record.reason)]
    if record.instruction:
        lines.append(_plain(f"{heading('Order', record.language)}: {record.instruction}", "dim"))
    return Group(Text(), *lines)


def _saw(record: MissionRecord) -> RenderableType:
    kinds: dict[str, int] = {}
    for seen in record.seen:
        name = seen.state if seen.kind == "object" else seen.kind
        kinds[name] = kinds.get(name, 0) + 1
    things = ", ".join(f"{count} {_plural(name, count)}" for name, count in sorted(kinds.items()))
    return _section(record, "What it saw", [_plain(f"{record.frames} pictures: {things or 'nothing was found'}.")])


def _plural(name: str, count: int) -> str:
    if count == 1:
        return name
    return {"box": "boxes", "person": "people"}.get(name, name if name in ("fire", "rubble") else f"{name}s")


def _gaps(record: MissionRecord, width: int) -> RenderableType:
    if not record.gaps:
        return _section(record, "What it did not know", [Text("Nothing that bears on the task was unknown.")])
    return _section(
        record,
        "What it did not know",
        [line for gap in weightiest_first(record.gaps) for line in _gap(gap, width)],
    )


def _gap(gap: GapRecord, width: int) -> Iterator[Text]:
    state = "asked" if gap.asked else "mattered, not asked" if gap.relevant else "irrelevant"
    state = "not decided" if gap.relevant is None and not gap.asked else state
    yield Text.assemble(
        ("• ", "bold"), printable(gap.description), "  ", (f"[{state}]", "cyan" if gap.asked else "dim")
    )
    yield _indented(gap.why, width)
    if not gap.asked and not gap.relevant:
        return
    worst = number(gap.cost_if_unfavourable_s, "s") if gap.cost_if_unfavourable_s is not None else "none"
    figures = (
        f"best way {number(gap.cost_if_favourable_s, 's')} if as hoped, {worst} if not; "
        f"{number(gap.divergence_m, 'm')} apart; asking gains {number(gap.gain_bits, 'bit', 2)}, "
        f"saves {number(gap.regret_saved_s, 's')}"
    )
    yield _indented(figures, width, "dim")


def _asked(record: MissionRecord) -> RenderableType:
    if not record.questions:
        return _section(record, "What it asked", [Text(heading("Nothing.", record.language))])
    return _section(record, "What it asked", [line for q in record.questions for line in _question(q)])


def _question(question: QuestionRecord) -> Iterator[Text]:
    said = reply_words(question)
    means = consequence(question)
    yield _plain(f"? {question.text}", "bold")
    arrow = f" → {printable(means)}" if means else ""
    facts = f"  (after {number(question.latency_s, 's')}, {number(question.gain_bits, 'bit', 2)})"
    yield Text.assemble("  ", (said, _STYLES[question.reply]), arrow, (facts, "dim"))
    for also in question.also:
        yield _plain(f"  also said: {also}")


def _decided(record: MissionRecord) -> RenderableType:
    lines: list[Text] = []
    if record.tree is not None and record.tree.children:
        tree = tree_text(record.tree, max_nodes=15).splitlines()
        lines.extend(Text(line, no_wrap=True, overflow="ellipsis") for line in tree)
    if record.certificate is not None:
        lines.append(_plain(record.certificate.text))
    return _section(record, "How it decided", lines or [Text("It was not decided.")])


def _flown(record: MissionRecord) -> RenderableType:
    flight = record.flight
    table = Table.grid(padding=(0, 2))
    table.add_row("planned", number(flight.planned_m, "m"), "flown", number(flight.flown_m, "m"))
    table.add_row("time", number(flight.seconds, "s"), "off the path", number(flight.rms_error_m, "m RMS", 3))
    timings = ", ".join(f"{printable(stage)} {number(s, 's', 2)}" for stage, s in record.timings_s.items())
    lines: list[RenderableType] = [table]
    if timings:
        lines.append(Text(f"Computing and waiting: {timings}", "dim"))
    if record.waiting is not None and record.waiting.delay_s:
        waited, hidden = number(record.waiting.delay_s, "s"), number(record.waiting.hidden_s, "s")
        lines.append(_plain(f"waited {waited} for answers, {hidden} of it hidden by flying on meanwhile"))
    lines.extend(_plain(line) for line in people_lines(record))
    lines.extend(_plain(f"rule {_KEPT[rule.kept]}: {rule.text}", _RULE_STYLES[rule.kept]) for rule in record.rules)
    lines.extend(_plain(f"done after {number(one.at_s, 's')}: {one.text}") for one in record.achieved)
    lines.extend(
        _plain(look_line(one, record.language), "yellow" if one.result is Sight.UNSEEN else "") for one in record.looks
    )
    lines.extend(_plain(f"left undone: {one.text} ({one.reason})", "yellow") for one in record.left)
    lines.extend(_plain(f"! {notice.text}", "yellow") for notice in record.notices)
    if record.run_dir and (Path(record.run_dir) / REPORT_FILE).is_file():
        lines.append(Text(f"Report: {printable(record.run_dir)}/{REPORT_FILE}", "bold", overflow="fold"))
    return _section(record, "What it flew", lines)


def _section(record: MissionRecord, title: str, lines: list[RenderableType] | list[Text]) -> RenderableType:
    return Group(Text(), Text(heading(title, record.language), "bold underline"), *lines)


def _indented(text: str, width: int, style: str = "") -> Text:
    return Text(textwrap.indent(textwrap.fill(printable(text), max(width - 2, 20)), "  "), style)


def _plain(text: str, style: str = "") -> Text:
    return Text(printable(text), style)
