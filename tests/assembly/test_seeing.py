"""From pictures to map, objects, gaps and a folder that missions run on."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from assembly.vision_server import VisionServer, naming
from frames.recordings import BLOCKS, poses, save_folder, views
from frames.test_bags import write_bag
from mintpilot import plan_mission
from mintpilot.assembly.seeing import see
from mintpilot.assembly.sources import open_source
from mintpilot.cli.main import main
from mintpilot.core.gap import NOWHERE
from mintpilot.core.ports import SourceOptions
from mintpilot.frames.aligned import AlignedFrames
from mintpilot.mission_file.reader import find_problems
from mintpilot.mission_file.seen_map import load_map
from perception.real_things import DESK, REPORTED, RGBD, TABLETOP, place, room_places
from perception.scenes import Block

BEHIND = Block(lo_m=(-3.0, 0.0, 0.0), hi_m=(-2.5, 0.5, 0.5), colour=(0.5, 0.5, 0.5))


def report_on(where: Path | str, **words):  # type: ignore[no-untyped-def]
    options = {k: words.pop(k) for k in ("color", "depth", "depth_unit_m") if k in words}
    return see(open_source(str(where), SourceOptions(**options)), name="test", **words)


@pytest.mark.long
def test_a_recording_becomes_things_a_map_and_a_world_for_missions(tmp_path: Path, capsys) -> None:  # type: ignore[no-untyped-def]
    save_folder(tmp_path / "walk", views(), poses())
    assert main(["see", str(tmp_path / "walk"), "--out", str(tmp_path / "seen"), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert {"objects", "regions", "rooms", "gaps", "warnings"} <= printed.keys()
    for block in BLOCKS:
        middle = (np.asarray(block.lo_m) + block.hi_m) / 2
        (thing,) = [o for o in printed["objects"] if math.dist(o["position_m"], middle) < 0.15]
        assert {"id", "label", "confidence", "attributes", "position_m", "size_m", "frames"} <= thing.keys()
        assert thing["label"] == "box"
        assert np.allclose(thing["size_m"], np.subtract(block.hi_m, block.lo_m), atol=0.12)
    map_, _ = load_map(tmp_path / "seen")
    assert [o.id for o in map_.objects] == [o["id"] for o in printed["objects"]]
    mission = tmp_path / "mission.yaml"
    mission.write_text(
        "mintpilot: 1\nname: seen\ninstruction: pick up the box\nworld: {seen: seen}\nvehicle: {radius_m: 0.15}\n"
    )
    assert find_problems(mission) == []
    planned = plan_mission(mission)
    assert [gap.kind for gap in planned.gaps] == ["target"]
    assert set(planned.gaps[0].values) == {o.id for o in map_.objects if o.label == "box"} | set(NOWHERE)


@pytest.mark.long
def test_one_thing_that_may_be_meant_is_asked_about(tmp_path: Path) -> None:
    save_folder(tmp_path / "walk", views(blocks=BLOCKS[:1]), poses())
    report_on(tmp_path / "walk", out=tmp_path / "seen")
    mission = tmp_path / "mission.yaml"
    mission.write_text(
        "mintpilot: 1\nname: seen\ninstruction: pick up the box\nworld: {seen: seen}\nvehicle: {radius_m: 0.15}\n"
    )
    planned = plan_mission(mission)
    (gap,) = planned.gaps
    (box,) = gap.values.keys() - set(NOWHERE)
    assert set(NOWHERE) < gap.values.keys()
    assert planned.query is not None
    assert box in planned.query.id


@pytest.mark.long
def test_a_folder_that_is_none_and_one_that_is_broken_are_named(tmp_path: Path) -> None:
    mission = tmp_path / "mission.yaml"
    mission.write_text("mintpilot: 1\nname: seen\ninstruction: pick up the box\nworld: {seen: nowhere}\n")
    (problem,) = find_problems(mission)
    assert "mintpilot see" in problem.message
    save_folder(tmp_path / "walk", views()[:2], poses()[:2])
    report_on(tmp_path / "walk", out=tmp_path / "nowhere")
    assert find_problems(mission) == []
    (tmp_path / "nowhere" / "map.npz").write_bytes(b"x")
    (problem,) = find_problems(mission)
    assert "broken" in problem.message


def test_nothing_seen_is_said_with_the_likely_cause(tmp_path: Path) -> None:
    save_folder(tmp_path, views(blocks=[BEHIND])[:1], poses()[:1])
    report = report_on(tmp_path)
    assert report.objects == []
    assert any("Nothing was seen" in text for text in report.warnings)


needs_data = pytest.mark.skipif(not RGBD.is_dir(), reason="needs ../shared/data")


@pytest.mark.long
@needs_data
def test_in_a_living_room_the_obvious_is_found_and_nothing_dangerous() -> None:
    report = report_on(RGBD)
    assert not {o.label for o in report.objects} & {"person", "fire", "door"}
    assert report.regions == report.rooms == []
    matrix = np.array(report.world_from_source)
    places = [matrix[:3, :3] @ p + matrix[:3, 3] for p in room_places().values()]
    assert found(report, places) >= 0.7 * len(places)


@needs_data
def test_on_a_real_desk_the_things_are_found_and_the_can_is_asked_about() -> None:
    folder = RGBD / "tum_desk"
    given = {"color": folder / "2.png", "depth": folder / "2_depth.png", "depth_unit_m": 0.0002}
    report = report_on("", **given, instruction="pick up the can")
    (frame,) = AlignedFrames(open_source("", SourceOptions(**given)))
    places = [place(t, folder / "2_depth.png", 5000.0, frame.world_from_camera) for t in DESK]
    assert found(report, places) >= 0.7 * len(places)
    assert not {o.label for o in report.objects} & {"person", "fire", "door"}
    (gap,) = [g for g in report.gaps if g.kind == "target"]
    assert sum(gap.values.values()) == pytest.approx(1.0, abs=1e-3)
    assert {"none of them", "not yet seen"} <= gap.values.keys()
    cans = [o.id for o in report.objects if any(math.dist(o.position_m, p) < 0.15 for p in places[:2])]
    assert set(list(gap.values)[:2]) == set(cans)


@needs_data
@pytest.mark.parametrize("number", REPORTED[:3])
def test_things_on_a_real_table_are_found_whole(number: int) -> None:
    from PIL import Image

    from mintpilot.perception.bodies import bodies_of
    from mintpilot.perception.settings import PerceptionSettings
    from mintpilot.perception.view import look_at

    base = TABLETOP / f"learn{number}"
    given = SourceOptions(color=Path(f"{base}_color.jpg"), depth=Path(f"{base}_depth.png"))
    (frame,) = AlignedFrames(open_source("", given))
    label = np.asarray(Image.open(f"{base}_label.png")).astype(int)
    things = bodies_of(look_at(frame, PerceptionSettings()), 0.0).things
    for kind in {int(k) // 10 for k in np.unique(label) if k >= 10}:
        true = (label >= 10) & (label // 10 == kind)
        assert max((true & b.mask).sum() / (true | b.mask).sum() for b in things) > 0.5


def found(report, places) -> int:  # type: ignore[no-untyped-def]
    return sum(any(math.dist(o.position_m, p) < 0.15 for o in report.objects) for p in places)


@pytest.mark.long
def test_from_a_bag_to_the_question_with_a_model_that_sees(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("rosbags", reason="needs rosbags")
    eyes = VisionServer(naming(lambda *_: "medicine box"))
    monkeypatch.setenv("MINTPILOT_VLM_URL", eyes.url)
    monkeypatch.setenv("MINTPILOT_VLM_MODEL", "eyes")
    bag = write_bag(tmp_path / "bag", mcap=True)
    try:
        report = report_on(
            bag, namers=("geometry", "vision"), instruction="pick up the medicine box", out=tmp_path / "seen"
        )
    finally:
        eyes.shut_down()
    (gap,) = [gap for gap in report.gaps if gap.kind == "target"]
    assert len(gap.candidates) == len(BLOCKS)
    assert all("medicine box" in words for words in gap.candidates.values())
    mission = tmp_path / "mission.yaml"
    mission.write_text(
        "mintpilot: 1\nname: seen\ninstruction: pick up the medicine box\nworld: {seen: seen}\n"
        "goals:\n  - {action: pick, phrase: the medicine box}\nvehicle: {radius_m: 0.15}\n"
    )
    planned = plan_mission(mission)
    assert planned.query is not None
    assert set(planned.gaps[0].values) == set(gap.candidates)
