"""Recordings as others write them: what is read, what is refused by name, what is left out and said."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from frames.recordings import EYES, intrinsics, poses, save_folder, save_picture, save_tum, views
from mintpilot.assembly.sources import open_source
from mintpilot.core.errors import MapError
from mintpilot.core.ports import SourceOptions
from mintpilot.frames.aligned import AlignedFrames

Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
"""From a world with z up to one with y up, as computer graphics has it."""


def aligned(where: Path | str, **options) -> AlignedFrames:  # type: ignore[no-untyped-def]
    return AlignedFrames(open_source(str(where), SourceOptions(**options)))


def refusal(tmp_path: Path, matrices: list[np.ndarray], per_metre: float = 1000.0) -> str:
    save_folder(tmp_path, views(), matrices, per_metre)
    with pytest.raises(MapError) as caught:
        list(aligned(tmp_path))
    return str(caught.value)


@pytest.mark.long
def test_the_tum_layout_gives_metres_poses_and_a_floor(tmp_path: Path) -> None:
    save_tum(tmp_path, views(), poses())
    source = aligned(tmp_path)
    frames = list(source)
    assert len(frames) == len(EYES)
    for frame, true, matrix in zip(frames, views(), poses(), strict=True):
        seen = np.isfinite(true.depth_m) & (true.depth_m > 0)
        assert np.abs(frame.depth_m - true.depth_m)[seen].max() < 2e-4
        assert np.allclose(frame.world_from_camera, matrix, atol=1e-5)
        assert frame.camera == true.camera
    assert abs(source.setting.floor_m) < 0.03


@pytest.mark.long
def test_a_world_with_y_up_is_turned_so_that_the_floor_is_below(tmp_path: Path) -> None:
    moved = np.eye(4)
    moved[:3, 3] = (0.4, -2.0, 7.0)
    save_folder(tmp_path, views(), [moved @ Y_UP @ matrix for matrix in poses()])
    source = aligned(tmp_path)
    frames = list(source)
    for frame, true in zip(frames, poses(), strict=True):
        assert abs(frame.world_from_camera[2, 3] - true[2, 3]) < 0.03
        assert np.allclose(frame.world_from_camera[2, :3], true[2, :3], atol=0.03)
    assert any("z up" in text for text in source.warnings)


@pytest.mark.parametrize(("pitch", "height"), [(0.25, 1.6), (0.5, 0.9), (0.75, 2.0), (0.9, 1.2)])
def test_up_and_floor_of_a_single_picture_come_from_its_depth(tmp_path: Path, pitch: float, height: float) -> None:
    from perception.scenes import picture

    frame = picture([], eye=(0.0, 0.0, height), pitch_rad=pitch)
    color, depth = save_picture(tmp_path, "a", frame)
    (tmp_path / "lens.json").write_text(json.dumps(intrinsics()))
    (found,) = aligned("", color=color, depth=depth, intrinsics=tmp_path / "lens.json")
    pose = found.world_from_camera
    assert abs(pose[2, 3] - height) < 0.04
    assert abs(math.asin(-pose[2, 2]) - pitch) < math.radians(1.5)
    assert abs(pose[1, 2]) < 1e-6, "a single picture looks along x"


def test_inverted_poses_are_refused_by_name(tmp_path: Path) -> None:
    assert "inverted" in refusal(tmp_path, [np.linalg.inv(matrix) for matrix in poses()])


@pytest.mark.long
@pytest.mark.parametrize("scale", [1000.0, 5.0])
def test_poses_in_another_unit_are_refused_with_the_factor(tmp_path: Path, scale: float) -> None:
    matrices = poses()
    for matrix in matrices:
        matrix[:3, 3] *= scale
    assert f"by {scale:g}" in refusal(tmp_path, matrices)


def test_a_rotation_that_stretches_is_refused_as_scaled(tmp_path: Path) -> None:
    matrices = poses()
    for matrix in matrices:
        matrix[:3, :3] *= 1.3
    assert "scaled" in refusal(tmp_path, matrices)


def test_mirrored_poses_are_refused_by_name(tmp_path: Path) -> None:
    assert "mirrored" in refusal(tmp_path, [matrix @ np.diag([-1.0, 1, 1, 1]) for matrix in poses()])


def test_poses_of_the_body_are_refused_by_name(tmp_path: Path) -> None:
    optical_from_body = np.array([[0.0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0], [0, 0, 0, 1]])
    assert "body" in refusal(tmp_path, [matrix @ optical_from_body for matrix in poses()])


def test_depth_in_another_unit_is_refused(tmp_path: Path) -> None:
    save_folder(tmp_path, views(), poses())
    with pytest.raises(MapError, match="depth unit is wrong"):
        aligned(tmp_path, depth_unit_m=0.02)
    with pytest.raises(MapError, match="depth unit is wrong"):
        aligned(tmp_path, depth_unit_m=1e-6)


def test_a_unit_that_may_be_wrong_is_said(tmp_path: Path) -> None:
    color, depth = save_picture(tmp_path, "a", views([(0.0, 0.0, 3.2)])[0])
    assert any("depth unit" in text for text in aligned("", color=color, depth=depth, depth_unit_m=0.0018).warnings)
    assert not any("depth unit" in text for text in aligned("", color=color, depth=depth).warnings)


def test_a_lens_that_cannot_be_is_refused(tmp_path: Path) -> None:
    save_folder(tmp_path, views(), poses())
    lens = json.loads((tmp_path / "camera_intrinsics.json").read_text())
    for key, value in (("fx", 0), ("fy", -5), ("cx", 9999), ("fx", 5.0), ("width", 0), ("fx", "x")):
        (tmp_path / "camera_intrinsics.json").write_text(json.dumps(lens | {key: value}))
        with pytest.raises(MapError):
            aligned(tmp_path)


def test_frames_without_sense_are_left_out_and_counted(tmp_path: Path) -> None:
    frames, matrices = views(), poses()
    jumped = matrices[3].copy()
    jumped[:3, 3] += (1.5, -1.0, 0.4)
    source = _Given(frames, [*matrices[:3], jumped, matrices[4]], times=[0.0, 2.0, 1.0, 3.0, 4.0])
    kept = AlignedFrames(source)
    assert [f.time_s for f in kept] == [0.0, 2.0, 4.0]
    said = " ".join(kept.warnings)
    assert "out of order" in said
    assert "jumped" in said


@pytest.mark.long
def test_a_broken_picture_among_others_is_left_out_and_said(tmp_path: Path) -> None:
    save_folder(tmp_path, views(), poses())
    path = tmp_path / "depth" / "00002.png"
    path.write_bytes(path.read_bytes()[:400])
    source = aligned(tmp_path)
    assert len(list(source)) == len(EYES) - 1
    assert any("00002" in text for text in source.warnings)


@pytest.mark.long
def test_missing_frames_do_not_matter(tmp_path: Path) -> None:
    eyes = [(0.0, 0.04 * i, 1.5) for i in range(10)]
    save_tum(tmp_path, views(eyes), poses(eyes))
    (tmp_path / "depth.txt").write_text("\n".join((tmp_path / "depth.txt").read_text().splitlines()[:-1]) + "\n")
    source = aligned(tmp_path)
    assert len(list(source)) == 9
    assert any("no depth" in text for text in source.warnings)


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_pictures_without_depth_say_so(value: float) -> None:
    frames = [replace(f, depth_m=np.full_like(f.depth_m, value)) for f in views()]
    source = AlignedFrames(_Given(frames, poses()))
    list(source)
    assert any("depth" in text for text in source.warnings)


@pytest.mark.long
@pytest.mark.parametrize(("level", "word"), [(0, "black"), (255, "over-exposed")])
def test_black_and_over_exposed_pictures_say_so(level: int, word: str) -> None:
    frames = [replace(f, rgb=np.full_like(f.rgb, level)) for f in views()]
    assert any(word in text for text in AlignedFrames(_Given(frames, poses())).warnings)


@pytest.mark.long
def test_colour_and_depth_of_different_size(tmp_path: Path) -> None:
    frame = views()[0]
    color, depth = save_picture(tmp_path, "a", frame)
    Image.fromarray(frame.rgb).resize((640, 480)).save(color)
    (found,) = aligned("", color=color, depth=depth)
    assert found.rgb.shape[:2] == found.depth_m.shape == (240, 320)
    assert found.camera.width == 320
    Image.fromarray(frame.rgb).resize((640, 400)).save(color)
    with pytest.raises(MapError, match="proportions"):
        aligned("", color=color, depth=depth)


def test_floating_point_pictures(tmp_path: Path) -> None:
    frame = views()[0]
    color, _ = save_picture(tmp_path, "a", frame)
    depth = tmp_path / "metres.tiff"
    Image.fromarray(np.where(frame.depth_m > 3, np.nan, frame.depth_m)).save(depth)
    (found,) = aligned("", color=color, depth=depth)
    assert np.isfinite(found.depth_m).all()
    near = frame.depth_m <= 3
    assert np.allclose(found.depth_m[near], frame.depth_m[near], atol=1e-5)


def test_eight_bits_are_no_depth(tmp_path: Path) -> None:
    color, depth = save_picture(tmp_path, "a", views()[0])
    Image.fromarray(np.zeros((240, 320), np.uint8)).save(depth)
    with pytest.raises(MapError, match="8 bits"):
        aligned("", color=color, depth=depth)


def test_what_is_no_source_is_told_what_would_be(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="TUM"):
        open_source(str(tmp_path), SourceOptions())
    with pytest.raises(MapError, match="--depth"):
        open_source("", SourceOptions(color=tmp_path / "a.png"))


class _Given:
    """A source of frames that are there already."""

    z_is_up = True

    def __init__(self, frames, matrices, times=None):  # type: ignore[no-untyped-def]
        self._given = list(zip(frames, matrices, times or range(len(frames)), strict=True))

    def frames(self):  # type: ignore[no-untyped-def]
        from mintpilot.core.observation import RawFrame

        for frame, matrix, time_s in self._given:
            depth = np.nan_to_num(frame.depth_m).astype(np.float32)
            yield RawFrame(
                time_s=float(time_s),
                rgb=frame.rgb.copy(),
                depth_m=depth,
                camera=frame.camera,
                source_from_camera=matrix.copy(),
            )

    def remarks(self) -> tuple[str, ...]:
        return ()
