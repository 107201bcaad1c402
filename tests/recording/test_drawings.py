"""Tree, plot, report: well-formed, bounded, and safe against hostile words."""

from __future__ import annotations

import io
import re
import shutil
import subprocess
from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rich.console import Console

from mintpilot.core.query import Reply
from mintpilot.recording.history import History
from mintpilot.recording.in_memory import HistoryRecorder
from mintpilot.recording.record import MissionRecord, TreeRecord
from mintpilot.recording.report import report_html
from mintpilot.recording.run_folder import RunFolder
from mintpilot.recording.terminal_report import print_report
from mintpilot.recording.topdown import flight_band, save_topdown, view_of
from mintpilot.recording.tree_drawing import percent, prune, tree_dot, tree_text
from mintpilot.recording.tree_svg import tree_svg

from .conftest import HOSTILE

VOID = {"meta", "img", "br", "link"}


class Checker(HTMLParser):
    """Closes what it opens, and keeps the tags."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def record_of(events) -> MissionRecord:
    recorder = HistoryRecorder()
    for event in events:
        recorder.record(event)
    return recorder.close()


def full_tree(depth: int, probability: float = 1.0) -> TreeRecord:
    children = tuple(full_tree(depth - 1, probability * share) for share in (0.7, 0.3)) if depth else ()
    return TreeRecord(given={}, words=f"case of {depth}", probability=probability, children=children)


def size(tree: TreeRecord) -> int:
    return 1 + tree.left_out + sum(map(size, tree.children))


@pytest.mark.long
def test_the_report_is_well_formed_and_needs_no_network(tmp_path, make_events):
    with RunFolder(tmp_path) as folder:
        for event in make_events():
            folder.record(event)
    text = (tmp_path / "report.html").read_text("utf-8")
    checker = Checker(text)
    assert checker.open == []
    sources = [attrs["src"] for tag, attrs in checker.tags if tag == "img"]
    assert len(sources) >= 5
    assert all(source is not None and source.startswith("data:image/") for source in sources)
    assert "http" not in re.sub(r'http-equiv|xmlns="http://www.w3.org/2000/svg"|base64,[^"]*', "", text)
    for words in ("Mission accomplished", "I fly around it, 25 s", "14.9 s more", "One way to fly"):
        assert words in text
    assert report_html(folder.close(), tmp_path) == text, "made of the run folder alone"


@pytest.mark.long
def test_hostile_words_stay_words(tmp_path, make_events):
    told = make_events(label=HOSTILE, description=HOSTILE, words=HOSTILE)
    with RunFolder(tmp_path) as folder:
        for event in told:
            folder.record(event)
    text = (tmp_path / "report.html").read_text("utf-8")
    assert not [tag for tag, _ in Checker(text).tags if tag == "script"]
    assert "&lt;script&gt;" in text
    for name in ("tree.svg", "topdown.svg"):
        tags = {element.tag.rpartition("}")[2] for element in ElementTree.parse(tmp_path / name).iter()}
        assert "script" not in tags
    for name in ("tree.txt", "tree.dot", "tree.svg"):
        assert "\x1b" not in (tmp_path / name).read_text("utf-8")
    assert [n.kind for n in folder.close().notices] == ["new-object"], "every drawing was made"


def test_the_tree_tells_what_was_asked_ruled_out_and_flown(make_events):
    tree = record_of(make_events()).tree
    assert tree is not None
    assert tree.asked
    assert [(c.ruled_out, c.flown) for c in tree.children] == [(True, False), (False, True)]
    text = tree_text(tree)
    assert "┗━ the grey smoke near the gate cannot be flown through (50 %)  ✔ flown" in text
    assert "✘ ruled out" in text
    svg = ElementTree.fromstring(tree_svg(tree))
    paths = [e.get("class") for e in svg.iter() if e.tag.endswith("path")]
    assert sorted(paths) == ["asked", "open"]
    yes = record_of(make_events(reply=Reply.YES, words="y")).tree
    assert yes is not None
    assert [(c.ruled_out, c.flown) for c in yes.children] == [(False, True), (True, False)]
    unsure = record_of(make_events(reply=Reply.UNSURE)).tree
    assert unsure is not None
    assert not any(c.ruled_out for c in unsure.children)


@settings(deadline=None, max_examples=30)
@given(depth=st.integers(0, 7), bound=st.integers(1, 90))
def test_big_trees_are_cut_and_the_rest_is_counted(depth, bound):
    tree = full_tree(depth)
    shown = prune(tree, bound)
    drawn = size(shown) - sum(int(n) for n in re.findall(r"(\d+) more nodes", tree_text(tree, max_nodes=bound)))
    assert size(shown) == size(tree) == 2 ** (depth + 1) - 1
    assert drawn <= bound
    assert tree_dot(tree, max_nodes=bound).count("[label=") == drawn
    assert tree_svg(tree, max_nodes=bound).count("<rect") == drawn


def test_cards_of_the_tree_do_not_overlap():
    svg = ElementTree.fromstring(tree_svg(full_tree(4)))
    boxes = [
        [float(e.get(k) or 0) for k in ("x", "y", "width", "height")] for e in svg.iter() if e.tag.endswith("rect")
    ]
    assert len(boxes) == 31
    for i, (x, y, w, h) in enumerate(boxes):
        assert y >= 0
        assert y + h <= float(svg.get("height") or 0) + 1
        for u, v, _, k in boxes[i + 1 :]:
            assert abs(x - u) >= w or v >= y + h or y >= v + k


@pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz is not installed")
def test_graphviz_takes_the_dot_file(make_events):
    tree = record_of(make_events(description=HOSTILE)).tree
    assert tree is not None
    done = subprocess.run(["dot", "-Tsvg"], input=tree_dot(tree).encode(), capture_output=True, timeout=30, check=False)
    assert done.returncode == 0, done.stderr


def test_dot_strings_are_closed(make_events):
    tree = record_of(make_events(description=HOSTILE + "\\")).tree
    assert tree is not None
    dot = tree_dot(tree)
    without_strings = re.sub(r'"(?:[^"\\]|\\.)*"', "", dot)
    assert '"' not in without_strings
    assert "script" not in without_strings
    assert without_strings.count("{") == without_strings.count("}") == 1


@pytest.mark.long
def test_the_plot_is_the_same_for_the_same_mission(tmp_path, make_events):
    for name in ("a.svg", "b.svg"):
        history = History()
        for event in make_events():
            history.add(event)
        view = view_of(history)
        assert view is not None
        save_topdown(view, tmp_path / name)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    ElementTree.parse(tmp_path / "a.svg")
    assert len(view.alternatives_m) == 1
    band = flight_band(view)
    assert (band.start, band.stop) == (4, 8), "1.2 to 1.8 m in layers of 0.25 m: neither floor nor roof"


def test_no_map_no_plot():
    assert view_of(History()) is None


@pytest.mark.parametrize("reply", [reply for reply in Reply if reply is not Reply.OPTION])
def test_the_terminal_report_fits_and_holds_no_control_codes(make_events, reply):
    out = io.StringIO()
    print_report(record_of(make_events(reply=reply, label=HOSTILE, description=HOSTILE)), Console(file=out, width=160))
    text = out.getvalue()
    assert "\x1b" not in text
    assert max(map(len, text.splitlines())) <= 100
    for words in ("MISSION ACCOMPLISHED", "What it asked", "14.9 s more", "irrelevant", "One way to fly", "planned"):
        assert words in text


def test_the_terminal_report_of_nothing():
    out = io.StringIO()
    print_report(HistoryRecorder().close(), Console(file=out, width=60))
    assert "ENDED BEFORE IT WAS FINISHED" in out.getvalue()


def test_percentages_never_pretend_certainty():
    assert [percent(p) for p in (0.0, 0.001, 0.5, 0.999, 1.0)] == ["0 %", "under 1 %", "50 %", "over 99 %", "100 %"]
