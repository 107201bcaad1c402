from __future__ import annotations

import base64
import gzip
import json
import re
from pathlib import Path

import pytest

from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.experiments import gaps
from mintpilot.benchmark.records import AskedRecord, TrialRecord, WorldRecord
from mintpilot.benchmark.report import write_report
from mintpilot.core.errors import RecordError

HOSTILE = "Is it <script>alert(1)</script></script> the red box?"


def folder() -> tuple[Experiment, list[TrialRecord], list[WorldRecord], str]:
    whole = gaps(trials=2, seed=0, vehicle="kinematic")
    made = whole.model_copy(update={"cells": (*whole.cells[:2], whole.cells[-1])})
    trials, worlds = [], []
    for cell in made.cells:
        for seed in (0, 1):
            worlds.append(
                WorldRecord(
                    experiment="gaps",
                    cell=cell.name,
                    seed=seed,
                    possible=True,
                    best_s=9.0,
                    gaps=(),
                    least_questions=1.0,
                    outline_m=(0, 0, 10, 10),
                )
            )
            for i, method in enumerate(cell.methods):
                trials.append(
                    TrialRecord(
                        experiment="gaps",
                        cell=cell.name,
                        seed=seed,
                        method=method.name,
                        vehicle="kinematic",
                        outcome="success" if i else "person-missed",
                        success=bool(i),
                        reason=HOSTILE,
                        questions=i,
                        flight_s=10.0 + seed,
                        flown_m=8.0,
                        asked=(AskedRecord(text=HOSTILE, query="q", reply="yes", gain_bits=1.0, wording_s=0.0),),
                        path_m=((0.0, 0.0), (5.0, 5.0)),
                    )
                )
    return made, trials, worlds, "runs/<here>"


@pytest.mark.long
def test_page_stands_alone_and_holds_every_trial(tmp_path: Path) -> None:
    made = folder()
    page = tmp_path / "deep" / "page.html"
    write_report([made, made], page)
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"""(src|href)=["'](?!#)""", re.sub(r"<svg.*?</svg>", "", text, flags=re.S))
    assert "http://" not in re.sub(r"http://www\.w3\.org/\S+", "", re.sub(r"<svg.*?</svg>", "", text, flags=re.S))
    assert "<script>alert" not in text
    assert text.count("<svg") == 2 * 3
    assert "100.0 % [34.2, 100.0]" in text
    packed = re.search(r'<script id="data" type="text/plain">([^<]*)</script>', text)
    assert packed
    data = json.loads(gzip.decompress(base64.b64decode(packed[1])))
    assert len(data["trials"]) == 2 * len(made[1])
    assert data["trials"][0]["asked"][0][0] == HOSTILE
    assert len(data["worlds"]) == 2 * len(made[2])


@pytest.mark.long
def test_page_is_the_same_every_time(tmp_path: Path) -> None:
    made = folder()
    for name in ("a", "b"):
        write_report([made], tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_nothing_to_show_is_said(tmp_path: Path) -> None:
    made, _, worlds, name = folder()
    with pytest.raises(RecordError, match="no trials"):
        write_report([(made, [], worlds, name)], tmp_path / "page.html")
