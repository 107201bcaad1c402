"""Which cells a rule's propositions speak of."""

from __future__ import annotations

import numpy as np
import pytest

from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.rule import Rule
from mintpilot.core.semantic_map import Cell, MapObject, Region, SemanticMap
from mintpilot.core.task import Task
from mintpilot.rules.compiling import compile_rules
from mintpilot.uncertainty import ruling_of

FRAME = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=1.0, shape=(1, 4, 4))


def region(name: str, *cells: int, kind: RegionKind = RegionKind.AREA) -> Region:
    return Region(id=name, kind=kind, cells=np.array(cells, np.int64))


def bound(proposition: str, *regions: Region) -> list[int]:
    box = MapObject(id="box-1", label="box", box_m=Box(lo_m=(3.2, 3.2, 0.0), hi_m=(3.8, 3.8, 1.0)))
    map = SemanticMap(frame=FRAME, cells=np.full(FRAME.shape, Cell.FREE, np.uint8), objects=(box,), regions=regions)
    rule = Rule(text="never", formula=f"G !{proposition}")
    task = Task(instruction="", subgoals=(), rules=(rule,))
    return ruling_of(map, task, compile_rules((rule,)), ()).cells[0].tolist()


@pytest.mark.parametrize("about", ["in({})", "touches({})", "within({}, 1)"])
def test_a_region_that_was_cut_into_parts_is_all_of_them(about: str) -> None:
    parts = (region("haze-1", 1, 2), region("haze-2", 5), region("hazel-1", 7), region("other", 9))
    assert bound(about.format("haze"), *parts) == [1, 2, 5]
    assert bound(about.format("haze-2"), *parts) == [5]


def test_one_of_that_very_name_goes_before_parts() -> None:
    assert bound("in(haze)", region("haze", 3), region("haze-1", 4)) == [3]


@pytest.mark.parametrize("words", ["box", "boxes", "the boxes", "box-1"])
def test_things_are_found_by_label_plural_and_id(words: str) -> None:
    assert bound(f"within({words}, 1)") == [15]
