"""``mintpilot plan``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from mintpilot.cli.exits import ExitCode

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
    yield f"Mission {report.mission}, strategy {report.strategy}: {_count(len(report.gaps), 'knowledge gap')}"
    yield from (f"  {step.n} {step.text}" for step in report.steps)
    if report.slowly:
        yield "  the whole flight slowly"
    if report.keep_out:
        yield f"  keep out of: {', '.join(report.keep_out)}"
    for gap in report.gaps:
        yield from _gap_lines(gap)
    if report.tree_text:
        yield ""
        yield "Tree"
        yield from (f"  {line}" for line in report.tree_text.splitlines())
    if report.plan_classes:
        yield ""
        yield "Flights that may be needed"
        for plan in report.plan_classes:
            cost = "nothing can be flown" if plan.cost_s is None else f"{plan.cost_s:.1f} s"
            yield f"  {plan.probability:6.1%}  {cost}, in {_count(len(plan.hypotheses), 'case')}"
    yield ""
    yield from _decision_lines(report)
    played = report.expected_questions_played
    bound = "" if not played else f" (± {report.expected_questions_error:.2f}, over {played} played missions)"
    for note in report.left_out:
        yield f"A bound on the work was reached: {note}."
    yield f"Questions to be expected: {report.expected_questions:.2f}{bound}. Thought for {report.seconds:.2f} s."


def _gap_lines(gap: GapReport) -> Iterator[str]:
    yield ""
    yield f"  {gap.description} ({'critical' if gap.critical else 'irrelevant'})"
    yield "    " + ", ".join(f"{value} {prior:.0%}" for value, prior in gap.values.items())
    yield f"    {gap.why}"


def _decision_lines(report: DeliberationReport) -> Iterator[str]:
    if report.query is None:
        yield f"Nothing to ask ({report.stop_reason}): {report.certificate}"
        return
    query = report.query
    yield f"It would ask: {query.text}"
    if query.option_means:
        yield from (f"  {reply}: {means}" for reply, means in zip(query.replies, query.option_means, strict=True))
    else:
        yield f"  yes: {query.yes_means}"
        yield f"  no:  {query.no_means}"
    yield f"  worth {query.gain_bits:.2f} bits and {query.regret_saved_s:.1f} s of flight"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
