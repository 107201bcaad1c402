"""ROS 2 bags written by rosbags: pictures, lens and poses come back as they were."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from frames.recordings import EYES, intrinsics, poses, quaternion, views
from mintpilot.assembly.sources import open_source
from mintpilot.core.errors import MapError
from mintpilot.core.ports import SourceOptions
from mintpilot.frames.aligned import AlignedFrames

pytest.importorskip("rosbags", reason="needs rosbags")

BODY_FROM_OPTICAL = np.array([[0.0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def write_bag(where: Path, *, mcap: bool, poses_by: str = "tf", depth: bool = True, compressed: bool = False) -> Path:
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    make = store.types
    plugin = StoragePlugin.MCAP if mcap else StoragePlugin.SQLITE3

    def header(t: float, frame: str):  # type: ignore[no-untyped-def]
        stamp = make["builtin_interfaces/msg/Time"](sec=int(t), nanosec=round((t % 1) * 1e9))
        return make["std_msgs/msg/Header"](stamp=stamp, frame_id=frame)

    def transform(t: float, parent: str, child: str, matrix: np.ndarray):  # type: ignore[no-untyped-def]
        x, y, z = (float(v) for v in matrix[:3, 3])
        qx, qy, qz, qw = quaternion(matrix)
        return make["geometry_msgs/msg/TransformStamped"](
            header=header(t, parent),
            child_frame_id=child,
            transform=make["geometry_msgs/msg/Transform"](
                translation=make["geometry_msgs/msg/Vector3"](x=x, y=y, z=z),
                rotation=make["geometry_msgs/msg/Quaternion"](x=qx, y=qy, z=qz, w=qw),
            ),
        )

    def image(t: float, pixels: np.ndarray, encoding: str):  # type: ignore[no-untyped-def]
        return make["sensor_msgs/msg/Image"](
            header=header(t, "camera_optical"),
            height=pixels.shape[0],
            width=pixels.shape[1],
            encoding=encoding,
            is_bigendian=0,
            step=pixels.strides[0],
            data=np.frombuffer(pixels.tobytes(), np.uint8),
        )

    with Writer(where, version=9, storage_plugin=plugin) as writer:
        topics = {}

        def write(topic: str, kind: str, message, t: float) -> None:  # type: ignore[no-untyped-def]
            if topic not in topics:
                topics[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(topics[topic], round(t * 1e9), store.serialize_cdr(message, kind))

        mounting = np.eye(4)
        mounting[:3, 3] = (0.1, 0.0, 0.05)
        mounting = mounting @ BODY_FROM_OPTICAL
        if poses_by == "tf":
            fixed = make["tf2_msgs/msg/TFMessage"](transforms=[transform(0.0, "base", "camera_optical", mounting)])
            write("/tf_static", "tf2_msgs/msg/TFMessage", fixed, 9.0)
        for i, (frame, pose) in enumerate(zip(views(), poses(), strict=True)):
            t = 10.0 + 0.25 * i
            if poses_by == "tf":
                body = pose @ np.linalg.inv(mounting)
                message = make["tf2_msgs/msg/TFMessage"](transforms=[transform(t, "odom", "base", body)])
                write("/tf", "tf2_msgs/msg/TFMessage", message, t)
            lens, info = intrinsics(), make["sensor_msgs/msg/CameraInfo"]
            k = np.array([lens["fx"], 0, lens["cx"], 0, lens["fy"], lens["cy"], 0, 0, 1.0])
            roi = make["sensor_msgs/msg/RegionOfInterest"](x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
            message = info(
                header=header(t, "camera_optical"),
                height=frame.camera.height,
                width=frame.camera.width,
                distortion_model="plumb_bob",
                d=np.zeros(5),
                k=k,
                r=np.eye(3).ravel(),
                p=np.zeros(12),
                binning_x=0,
                binning_y=0,
                roi=roi,
            )
            write("/camera/color/camera_info", "sensor_msgs/msg/CameraInfo", message, t)
            if compressed:
                write(*_compressed(make, header(t, "camera_optical"), frame.rgb), t)
            else:
                bgr = np.ascontiguousarray(frame.rgb[..., ::-1])
                write("/camera/color/image_raw", "sensor_msgs/msg/Image", image(t, bgr, "bgr8"), t)
            if depth:
                steps = np.round(np.nan_to_num(frame.depth_m) * 1000).astype(np.uint16)
                topic = "/camera/aligned_depth_to_color/image_raw"
                write(topic, "sensor_msgs/msg/Image", image(t + 0.01, steps, "16UC1"), t + 0.01)
    return where


def _compressed(make, header, rgb):  # type: ignore[no-untyped-def]
    import io

    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(rgb).save(buffer, "png")
    message = make["sensor_msgs/msg/CompressedImage"](
        header=header, format="rgb8; png compressed", data=np.frombuffer(buffer.getvalue(), np.uint8)
    )
    return "/camera/color/image_raw/compressed", "sensor_msgs/msg/CompressedImage", message


def read(where: Path) -> tuple[list, AlignedFrames]:
    source = AlignedFrames(open_source(str(where), SourceOptions()))
    return list(source), source


@pytest.mark.long
@pytest.mark.parametrize("mcap", [True, False])
@pytest.mark.parametrize("compressed", [True, False])
def test_pictures_lens_and_poses_come_back(tmp_path: Path, mcap: bool, compressed: bool) -> None:
    frames, _ = read(write_bag(tmp_path / "bag", mcap=mcap, compressed=compressed))
    assert len(frames) == len(EYES)
    for frame, true, pose in zip(frames, views(), poses(), strict=True):
        assert (frame.rgb == true.rgb).all()
        assert np.abs(frame.depth_m - np.nan_to_num(true.depth_m)).max() < 6e-4
        assert np.allclose(frame.world_from_camera, pose, atol=1e-5)
        assert frame.camera == true.camera


def test_without_poses_the_first_picture_is_seen_and_the_rest_counted(tmp_path: Path) -> None:
    frames, source = read(write_bag(tmp_path / "bag", mcap=True, poses_by="none"))
    assert len(frames) == 1
    assert any("without a pose" in text for text in source.warnings)


def test_a_bag_without_depth_is_refused_with_its_topics(tmp_path: Path) -> None:
    with pytest.raises(MapError, match=r"no pictures of depth.*camera/color/image_raw"):
        read(write_bag(tmp_path / "bag", mcap=True, depth=False))


@pytest.mark.long
@pytest.mark.parametrize("mcap", [True, False])
def test_a_bag_that_is_cut_short_is_read_to_the_cut_or_refused(tmp_path: Path, mcap: bool) -> None:
    bag = write_bag(tmp_path / "bag", mcap=mcap)
    (file,) = bag.glob("*.mcap" if mcap else "*.db3")
    file.write_bytes(file.read_bytes()[: file.stat().st_size * 6 // 10])
    said = ""
    frames: list = []
    try:
        frames, source = read(bag)
        said = " ".join(source.warnings)
    except MapError as error:
        said = str(error)
    assert len(frames) < len(EYES)
    assert "cut short" in said
