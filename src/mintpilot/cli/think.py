"""``mintpilot plan``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from mintpilot.cli.exits import ExitCode
from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT
from mintpilot.core.message import message, verbatim
from mintpilot.wording.speech import Speech

if TYPE_CHECKING:
    from mintpilot.assembly.deliberation_report import DeliberationReport, GapReport


def think(
    path: Path,
    *,
    strategy: str,
    strategy_args: Iterable[str],
    planner: str,
    seed: int | None,
    llm: str | None,
    lang: str | None,
    as_json: bool,
) -> ExitCode:
    """Deliberates on the mission in that file and prints what came of it."""
    from mintpilot.assembly.api import plan_mission
    from mintpilot.assembly.strategies import parse_arguments

    arguments = parse_arguments(strategy_args)
    report = plan_mission(
        path, strategy=strategy, strategy_arguments=arguments, planner=planner, seed=seed, llm=llm, lang=lang
    )
    print(report.model_dump_json() if as_json else "\n".join(lines_of(report)))
    return ExitCode.SUCCESS


def lines_of(report: DeliberationReport) -> Iterator[str]:
    """The report for people, line by line."""
    speech = Speech(report.language)
    head = message(
        "Mission {name}, strategy {strategy}, knowledge gaps: {count}",
        name=report.mission,
        strategy=report.strategy,
        count=len(report.gaps),
    )
    yield speech(head)
    yield from (f"  {line}" for line in report.understood)
    for gap in report.gaps:
        yield from _gap_lines(gap, speech)
    if report.tree_text:
        yield ""
        yield speech.label("Tree")
        yield from (f"  {line}" for line in report.tree_text.splitlines())
    if report.plan_classes:
        yield ""
        yield speech.label("Flights that may be needed")
        for plan in report.plan_classes:
            cost = (
                message("nothing safe can be flown")
                if plan.cost_s is None
                else message("{cost_s:.1f} s", cost_s=plan.cost_s)
            )
            line = message(
                "  {share:6.1%}  {cost}, cases: {count}",
                share=plan.probability,
                cost=cost,
                count=len(plan.hypotheses),
            )
            yield speech(line)
    yield ""
    yield from _decision_lines(report, speech)
    played = report.expected_questions_played
    for note in report.left_out:
        yield speech(message("A bound on the work was reached: {bound}.", bound=note))
    if played:
        played_out = message(
            "Questions to be expected: {expected:.2f} (± {error:.2f}, over {played} played missions).",
            expected=report.expected_questions,
            error=report.expected_questions_error or 0.0,
            played=played,
        )
        yield speech(played_out)
    else:
        yield speech(message("Questions to be expected: {expected:.2f}.", expected=report.expected_questions))
    yield speech(message("Thought for {seconds:.2f} s.", seconds=report.seconds))


_VALUES = {
    PASSABLE: message("passable"),
    BLOCKED: message("blocked"),
    PRESENT: message("present"),
    ABSENT: message("absent"),
}
"""What a gap's values are called; names of things stay as they are."""


def _gap_lines(gap: GapReport, speech: Speech) -> Iterator[str]:
    yield ""
    yield f"  {gap.description} ({speech.label('critical') if gap.critical else speech.label('irrelevant')})"
    shares = [
        message("{value} {prior:.0%}", value=_VALUES.get(value, verbatim(value)), prior=prior)
        for value, prior in gap.values.items()
    ]
    yield "    " + ", ".join(map(speech, shares))
    yield f"    {gap.why}"


def _decision_lines(report: DeliberationReport, speech: Speech) -> Iterator[str]:
    if report.query is None:
        yield speech(message("Nothing to ask: {why}", why=report.certificate))
        return
    query = report.query
    yield speech(message("It would ask: {question}", question=query.text))
    if query.option_means:
        yield from (f"  {reply}: {means}" for reply, means in zip(query.replies, query.option_means, strict=True))
    else:
        yield speech(message("  yes: {means}", means=query.yes_means))
        yield speech(message("  no:  {means}", means=query.no_means))
    worth = message(
        "  worth {gain_bits:.2f} bits and {saved_s:.1f} s of flight",
        gain_bits=query.gain_bits,
        saved_s=query.regret_saved_s,
    )
    yield speech(worth)
