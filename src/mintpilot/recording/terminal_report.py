"""The mission report at the end of a run, on a terminal or in a log file."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from pathlib import Path

from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from mintpilot.core.message import Named, joined, message
from mintpilot.core.mission import Outcome, Sight
from mintpilot.core.query import Reply
from mintpilot.recording.people import look_line, people_lines
from mintpilot.recording.record import GapRecord, MissionRecord, QuestionRecord
from mintpilot.recording.report import REPORT_FILE, consequence, reply_words, rule_message, weightiest_first
from mintpilot.recording.tree_drawing import tree_text
from mintpilot.recording.words import OUTCOME_WORDS, printable, stage_words
from mintpilot.wording.speech import Speech

WIDTH = 100
"""Columns that the report fits into."""
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
    speech = Speech(record.language)
    for part in (
        _head(record, speech),
        _saw(record, speech),
        _gaps(record, width, speech),
        _asked(record, speech),
        _decided(record, speech),
        _flown(record, speech),
    ):
        console.print(part, width=width)


def _head(record: MissionRecord, speech: Speech) -> RenderableType:
    styles = {Outcome.SUCCESS: "bold green", Outcome.PARTIAL: "bold yellow"}
    style = styles.get(record.outcome, "bold red")
    lines = [Text(speech(OUTCOME_WORDS[record.outcome]).upper(), style), _plain(record.reason)]
    if record.instruction:
        lines.append(_plain(f"{speech.label('Order')}: {record.instruction}", "dim"))
    return Group(Text(), *lines)


def _saw(record: MissionRecord, speech: Speech) -> RenderableType:
    kinds: dict[str, int] = {}
    for seen in record.seen:
        name = seen.state if seen.kind == "object" else seen.kind
        kinds[name] = kinds.get(name, 0) + 1
    things = [message("{count} × {what}", count=count, what=Named(name)) for name, count in sorted(kinds.items())]
    found = joined(things, ", ") or message("nothing was found")
    line = message("{count} pictures: {found}.", count=record.frames, found=found)
    return _section(speech.label("What it saw"), [_plain(speech(line))])


def _gaps(record: MissionRecord, width: int, speech: Speech) -> RenderableType:
    title = speech.label("What it did not know")
    if not record.gaps:
        return _section(title, [Text(speech.label("Nothing that bears on the task was unknown."))])
    return _section(title, [line for gap in weightiest_first(record.gaps) for line in _gap(gap, width, speech)])


def _state(gap: GapRecord, speech: Speech) -> str:
    if gap.asked:
        return speech.label("asked")
    if gap.relevant is None:
        return speech.label("not decided")
    return speech.label("mattered, not asked") if gap.relevant else speech.label("irrelevant")


def _gap(gap: GapRecord, width: int, speech: Speech) -> Iterator[Text]:
    state = _state(gap, speech)
    yield Text.assemble(
        ("• ", "bold"), printable(gap.description), "  ", (f"[{state}]", "cyan" if gap.asked else "dim")
    )
    yield _indented(gap.why, width)
    if not gap.asked and not gap.relevant:
        return
    worst = speech.number(gap.cost_if_unfavourable_s, "s") if gap.cost_if_unfavourable_s is not None else "–"
    figures = message(
        "best way {best} if as hoped, {worst} if not; {apart} apart; asking gains {gain}, saves {saved}",
        best=speech.number(gap.cost_if_favourable_s, "s"),
        worst=worst,
        apart=speech.number(gap.divergence_m, "m"),
        gain=speech.number(gap.gain_bits, "bit", 2),
        saved=speech.number(gap.regret_saved_s, "s"),
    )
    yield _indented(speech(figures), width, "dim")


def _asked(record: MissionRecord, speech: Speech) -> RenderableType:
    title = speech.label("What it asked")
    if not record.questions:
        return _section(title, [Text(speech.label("Nothing."))])
    return _section(title, [line for q in record.questions for line in _question(q, speech)])


def _question(question: QuestionRecord, speech: Speech) -> Iterator[Text]:
    said = reply_words(question, speech)
    means = consequence(question)
    yield _plain(f"? {question.text}", "bold")
    arrow = f" → {printable(means)}" if means else ""
    after = message(
        "after {seconds}, {gain}",
        seconds=speech.number(question.latency_s, "s"),
        gain=speech.number(question.gain_bits, "bit", 2),
    )
    yield Text.assemble("  ", (said, _STYLES[question.reply]), arrow, (f"  ({speech(after)})", "dim"))
    for also in question.also:
        yield _plain(f"  {speech(message('also said: {what}', what=also))}")


def _decided(record: MissionRecord, speech: Speech) -> RenderableType:
    lines: list[Text] = []
    if record.tree is not None and record.tree.children:
        tree = tree_text(record.tree, max_nodes=15, speech=speech).splitlines()
        lines.extend(Text(line, no_wrap=True, overflow="ellipsis") for line in tree)
    if record.certificate is not None:
        lines.append(_plain(record.certificate.text))
    return _section(speech.label("How it decided"), lines or [Text(speech.label("It was not decided."))])


def _flown(record: MissionRecord, speech: Speech) -> RenderableType:
    flight = record.flight
    table = Table.grid(padding=(0, 2))
    lengths = (speech.number(flight.planned_m, "m"), speech.number(flight.flown_m, "m"))
    table.add_row(speech.label("planned"), lengths[0], speech.label("flown"), lengths[1])
    off = speech.number(flight.rms_error_m, "m RMS", 3)
    table.add_row(speech.label("time"), speech.number(flight.seconds, "s"), speech.label("off the path"), off)
    timings = ", ".join(
        f"{speech(stage_words(printable(stage)))} {speech.number(s, 's', 2)}" for stage, s in record.timings_s.items()
    )
    lines: list[RenderableType] = [table]
    if timings:
        lines.append(Text(f"{speech.label('Computing and waiting')}: {timings}", "dim"))
    if record.waiting is not None and record.waiting.delay_s:
        waited = message(
            "waited {waited} for answers, {hidden} of it hidden by flying on meanwhile",
            waited=speech.number(record.waiting.delay_s, "s"),
            hidden=speech.number(record.waiting.hidden_s, "s"),
        )
        lines.append(_plain(speech(waited)))
    lines.extend(_plain(line) for line in people_lines(record))
    lines.extend(_plain(speech(rule_message(rule)), _RULE_STYLES[rule.kept]) for rule in record.rules)
    lines.extend(
        _plain(speech(message("done after {seconds}: {what}", seconds=speech.number(one.at_s, "s"), what=one.text)))
        for one in record.achieved
    )
    lines.extend(
        _plain(look_line(one, record.language), "yellow" if one.result is Sight.UNSEEN else "") for one in record.looks
    )
    lines.extend(
        _plain(speech(message("left undone: {what} ({why})", what=one.text, why=one.reason)), "yellow")
        for one in record.left
    )
    lines.extend(_plain(f"! {notice.text}", "yellow") for notice in record.notices)
    if record.run_dir and (Path(record.run_dir) / REPORT_FILE).is_file():
        report = f"{speech.label('Report')}: {printable(record.run_dir)}/{REPORT_FILE}"
        lines.append(Text(report, "bold", overflow="fold"))
    return _section(speech.label("What it flew"), lines)


def _section(title: str, lines: list[RenderableType] | list[Text]) -> RenderableType:
    return Group(Text(), Text(title, "bold underline"), *lines)


def _indented(text: str, width: int, style: str = "") -> Text:
    return Text(textwrap.indent(textwrap.fill(printable(text), max(width - 2, 20)), "  "), style)


def _plain(text: str, style: str = "") -> Text:
    return Text(printable(text), style)
