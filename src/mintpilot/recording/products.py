"""Everything that is drawn at the end of a mission."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path

from mintpilot.recording.history import History
from mintpilot.recording.record import MissionRecord, TreeRecord
from mintpilot.recording.report import REPORT_FILE, report_html
from mintpilot.recording.topdown import save_topdown, view_of
from mintpilot.recording.tree_drawing import tree_dot, tree_json, tree_text
from mintpilot.recording.tree_svg import tree_svg
from mintpilot.wording.speech import Speech


def write_products(record: MissionRecord, history: History, folder: Path) -> list[str]:
    """Writes tree, top-down plot and report into the folder; returns what failed, each in a few words.

    A drawing that fails must take neither the record nor the other drawings with it, whatever its mistake is.
    """
    steps: list[tuple[str, list[Path], Callable[[], object]]] = []
    tree = record.tree
    if tree is not None:
        speech = Speech(record.language)
        drawings: dict[str, Callable[[TreeRecord], str]] = {
            "txt": partial(tree_text, speech=speech),
            "json": tree_json,
            "svg": partial(tree_svg, speech=speech),
            "dot": partial(tree_dot, speech=speech),
        }
        for ending, draw in drawings.items():
            file = folder / f"tree.{ending}"
            steps.append((file.name, [file], lambda f=file, d=draw: f.write_text(d(tree), encoding="utf-8")))  # type: ignore[misc]
    view = view_of(history)
    if view is not None:
        plots = [folder / "topdown.svg", folder / "topdown.png"]
        steps.append(("topdown", plots, lambda: save_topdown(view, *plots)))
    report = folder / REPORT_FILE
    steps.append((report.name, [report], lambda: report.write_text(report_html(record, folder), "utf-8")))
    return [failure for name, files, step in steps if (failure := _failure(name, files, step))]


def _failure(name: str, files: list[Path], step: Callable[[], object]) -> str:
    """What failed, if anything; half a file is worse than none."""
    try:
        step()
    except Exception as error:
        with suppress(OSError):
            for file in files:
                file.unlink(missing_ok=True)
        told = error.strerror if isinstance(error, OSError) else str(error)
        return f"{name} ({told or type(error).__name__})"
    return ""
