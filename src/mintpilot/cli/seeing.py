"""``mintpilot see``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mintpilot.cli.exits import ExitCode
from mintpilot.core.ports import SourceOptions

if TYPE_CHECKING:
    from mintpilot.assembly.seen_report import SeenReport


def see_pictures(
    where: str,
    options: SourceOptions,
    *,
    perception: str,
    namers: Sequence[str],
    calibration: Path | None,
    instruction: str | None,
    out: Path | None,
    as_json: bool,
) -> ExitCode:
    """Sees what a source shows, and prints what came of it."""
    from mintpilot.assembly.seeing import see
    from mintpilot.assembly.sources import open_source

    name = where or str(options.color)
    report = see(
        open_source(where, options),
        name=name,
        perception=perception,
        namers=namers,
        calibration=calibration,
        instruction=instruction,
        out=out,
    )
    print(report.model_dump_json() if as_json else "\n".join(lines_of(report, out)))
    return ExitCode.SUCCESS


def lines_of(report: SeenReport, out: Path | None) -> Iterator[str]:
    """The report for people, line by line."""
    things = f"{len(report.objects)} thing{'' if len(report.objects) == 1 else 's'}"
    yield f"{report.source}: {report.frames} frame{'' if report.frames == 1 else 's'}, {things}"
    for thing in report.objects:
        x, y, z = thing.position_m
        words = " ".join(value for values in thing.attributes.values() for value in values)
        yield f"  {thing.id:12} {thing.confidence:4.0%}  at ({x:.2f}, {y:.2f}, {z:.2f}) m  {words}"
    for region in report.regions:
        yield f"  {region.id:12} {region.description}"
    for room in report.rooms:
        yield f"  {room.id:12} {room.description}"
    for gap in report.gaps:
        yield ""
        yield f"Not known: {gap.question or gap.description}"
        for value, chance in gap.values.items():
            yield f"  {chance:4.0%}  {gap.candidates.get(value, value)}"
    if report.warnings:
        yield ""
        yield from (f"Note: {warning}" for warning in report.warnings)
    if out is not None:
        yield ""
        yield f"Map and report are in {out}; a mission may use it: world: {{seen: {out}}}"
