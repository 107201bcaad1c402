"""Outcomes, reasons, tree, log, terminal and report speak the mission's language; keys, ids and values stay English."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from rich.console import Console

from assembly.test_instruction_missions import written
from mintpilot.assembly.api import plan_mission, run_mission
from mintpilot.assembly.replaying import verify_run
from mintpilot.cli.progress import Narrator
from mintpilot.cli.think import lines_of
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Order, Reply
from mintpilot.interaction.scripted import RecordedOperator
from mintpilot.recording.record import MissionRecord, TreeRecord
from mintpilot.recording.report import report_html
from mintpilot.recording.terminal_report import print_report
from mintpilot.wording.speech import Speech

pytestmark = pytest.mark.long
QUOTED = re.compile("„[^“]*“|«[^»]*»|“[^”]*”|'[^']*'|\"[^\"]*\"|`[^`]*`")
ENGLISH = re.compile(
    r"\b(the|is|are|of|and|with|nothing|it|from|that|which|there|asked|known|whatever|takes|leaves|because|reached|"
    r"undone|people|seen|back|hold|return|answered)\b",
    re.IGNORECASE,
)
"""Words of English sentences that are none of the other languages."""
INSTRUCTION = "Look into the garage, look into the pantry and go to the crate."


def mission(tmp_path: Path, **changes: object) -> Path:
    path = written(tmp_path, INSTRUCTION, **changes)
    text = path.read_text().replace("lamp-1", "crate-1").replace("label: lamp", "label: crate")
    text = text.replace("world:\n", "world:\n  regions: [{id: haze, kind: smoke, description: the grey smoke, box: "
                        "{lo_m: [5, 0, 0], hi_m: [7, 8, 1]}}]\n")  # fmt: skip
    path.write_text(text)
    return path


KINDS = {
    "success": ({"truth": {"haze": "passable", "garage": "present", "pantry": "absent"}}, None, {Outcome.SUCCESS}),
    "blocked": ({"truth": {"haze": "blocked"}}, None, {Outcome.PARTIAL}),
    "battery": (
        {"truth": {"haze": "passable"}, "vehicle": {"endurance_s": 16}},
        None,
        {Outcome.PARTIAL, Outcome.NO_SAFE_PLAN},
    ),
    "silent": ({}, Reply.TIMEOUT, {Outcome.PARTIAL, Outcome.NO_SAFE_PLAN}),
    **{f"order {order.value}": ({}, order, {Outcome.ABORTED}) for order in (Order.RETURN, Order.LAND, Order.ABORT)},
}


def nodes(tree: TreeRecord | None) -> Iterator[str]:
    """The words of a tree."""
    if tree is not None:
        yield from (tree.words, tree.branch_words)
        for child in tree.children:
            yield from nodes(child)


def texts_of(record: MissionRecord, folder: Path, told: list[str]) -> list[str]:
    """Everything that a person reads of one mission."""
    screen = io.StringIO()
    print_report(record, Console(file=screen, width=100))
    html = re.sub(r"<style.*?</style>|<[^>]*>", "\n", report_html(record, folder), flags=re.DOTALL)
    html = html.split(Speech(record.language).label("Settings, seed and versions"))[
        0
    ]  # settings and versions are for programs
    found = [record.reason, *told, *screen.getvalue().splitlines(), *html.splitlines(), *nodes(record.tree)]
    found += [text for gap in record.gaps for text in (gap.description, gap.why, *(v.means for v in gap.values))]
    found += [text for q in record.questions for text in (q.text, q.yes_means, q.no_means)]
    found += [notice.text for notice in record.notices] + [order.answer for order in record.orders]
    found += [one.text for one in (*record.achieved, *record.looks)]
    found += [text for one in record.left for text in (one.text, one.reason)]
    found += [text for one in record.plan_classes for text in one.words]
    found += [record.certificate.text] if record.certificate else []
    return [text.strip() for text in found if text.strip()]


def flown(folder: Path, kind: str, lang: str) -> tuple[MissionRecord, list[str]]:
    changes, said, _ = KINDS[kind]
    folder.mkdir()
    lines, run = io.StringIO(), folder / "run"
    caller = None if said is None else RecordedOperator([said] * 20)
    with Narrator(Console(file=lines, width=200)) as narrator:
        record = run_mission(
            mission(folder, **changes),
            vehicle="kinematic",
            operator=caller or "scripted",
            out=run,
            lang=lang,
            progress=narrator,
            briefs=False,
        )
    told = [*(caller.told if caller else []), *lines.getvalue().splitlines()]
    return record, texts_of(record, run, told)


def bare(text: str) -> str:
    """Without quoted names, files, and the person's own words."""
    return re.sub(r"\S*/\S*", "", QUOTED.sub("", text.replace(INSTRUCTION, "")))


QUICK = ("success", "battery", "order return")


@pytest.mark.parametrize("kind", [k if k in QUICK else pytest.param(k, marks=pytest.mark.slow) for k in KINDS])
def test_no_sentence_of_a_mission_is_english_in_another_language(tmp_path: Path, kind: str) -> None:
    _, english = flown(tmp_path / "en", kind, "en")
    for lang in ("de", "fr", "es"):
        record, local = flown(tmp_path / lang, kind, lang)
        assert record.outcome in KINDS[kind][2], record.reason
        assert not [text for text in local if ENGLISH.search(bare(text))]
        same = {text for text in set(local) & set(english) if len(re.findall(r"[A-Za-z]{3,}", bare(text))) > 1}
        assert not {text for text in same if not text.startswith("/")}
        assert verify_run(tmp_path / lang / "run").verification.difference is None


@pytest.mark.parametrize("lang", ["de", "fr", "es"])
def test_a_plan_is_told_in_the_language_too(tmp_path: Path, lang: str) -> None:
    path = mission(tmp_path)
    lines = list(lines_of(plan_mission(path, lang=lang)))
    named = re.compile(r"(passable|blocked|present|absent) \d+%")  # values of a gap, as in the JSON
    assert not [line for line in lines if ENGLISH.search(bare(named.sub("", line)))]


@pytest.mark.parametrize("lang", ["de", "fr", "es"])
def test_the_briefing_is_told_in_the_language(tmp_path: Path, lang: str) -> None:
    caller = RecordedOperator([Reply.NO])
    record = run_mission(
        mission(tmp_path), vehicle="kinematic", operator=caller, out=tmp_path / "run", lang=lang, briefs=True
    )
    assert record.outcome is Outcome.ABORTED
    assert len(caller.told) > 4
    assert not [text for text in (*caller.told, record.reason) if ENGLISH.search(bare(text))]
