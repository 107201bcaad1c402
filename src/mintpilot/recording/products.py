"""Everything that is drawn at the end of a mission."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from mintpilot.recording.history import History
from mintpilot.recording.record import MissionRecord, TreeRecord
from mintpilot.recording.report import report_html
from mintpilot.recording.topdown import save_topdown, view_of
from mintpilot.recording.tree_drawing import tree_dot, tree_json, tree_text
from mintpilot.recording.tree_svg import tree_svg
from mintpilot.wording.speech import Speech


def write_products(record: MissionRecord, history: History, folder: Path) -> list[str]:
    """Writes tree, top-down plot and report into the folder; returns what failed, each in a few words.

    A drawing that fails must take neither the record nor the other drawings with it, whatever its mistake is.
    """
    steps: list[tuple[str, Callable[[], object]]] = []
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
            steps.append((file.name, lambda f=file, d=draw: f.write_text(d(tree), encoding="utf-8")))  # type: ignore[misc]
    view = view_of(history)
    if view is not None:
        steps.append(("topdown", lambda: save_topdown(view, folder / "topdown.svg", folder / "topdown.png")))
    steps.append(("report.html", lambda: (folder / "report.html").write_text(report_html(record, folder), "utf-8")))
    return [failure for name, step in steps if (failure := _failure(name, step))]


def _failure(name: str, step: Callable[[], object]) -> str:
    try:
        step()
    except Exception as error:
        return f"{name} ({error or type(error).__name__})"
    return ""
