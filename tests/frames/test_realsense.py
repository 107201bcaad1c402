"""The RealSense adapter, run on the library's own software device: no camera is needed."""

from __future__ import annotations

import numpy as np
import pytest

from frames.recordings import intrinsics, views
from mintpilot.core.errors import DeviceError, MissingPartError
from mintpilot.core.ports import SourceOptions
from mintpilot.frames.realsense import RealSense


def library():  # type: ignore[no-untyped-def]
    try:
        import pyrealsense2
    except ImportError as error:
        pytest.skip(f"needs pyrealsense2 and libusb: {error}")
    return pyrealsense2


def test_pictures_of_a_software_device_come_back() -> None:
    rs = library()
    true = views()[0]
    device = rs.software_device()
    lens = rs.intrinsics()
    given = intrinsics()
    lens.width, lens.height = int(given["width"]), int(given["height"])
    lens.fx, lens.fy, lens.ppx, lens.ppy = given["fx"], given["fy"], given["cx"], given["cy"]
    streams = {}
    sensors = {}
    for index, (kind, form, bpp) in enumerate(
        ((rs.stream.depth, rs.format.z16, 2), (rs.stream.color, rs.format.rgb8, 3))
    ):
        sensor = device.add_sensor(str(kind))
        stream = rs.video_stream()
        stream.type, stream.fmt, stream.bpp, stream.fps = kind, form, bpp, 30
        stream.width, stream.height, stream.uid, stream.index = lens.width, lens.height, index, 0
        stream.intrinsics = lens
        if kind == rs.stream.depth:
            sensor.add_read_only_option(rs.option.depth_units, 0.001)
        streams[kind], sensors[kind] = sensor.add_video_stream(stream), sensor
    device.create_matcher(rs.matchers.dlr_c)
    syncer = rs.syncer()
    for kind, sensor in sensors.items():
        sensor.open(streams[kind])
        sensor.start(syncer)
    steps = np.round(np.nan_to_num(true.depth_m) * 1000).astype(np.uint16)
    for number in (1, 2):
        for kind, pixels, bpp in ((rs.stream.depth, steps, 2), (rs.stream.color, true.rgb, 3)):
            frame = rs.software_video_frame()
            frame.pixels = np.ascontiguousarray(pixels)
            frame.stride, frame.bpp = lens.width * bpp, bpp
            frame.timestamp, frame.domain = 33.0 * number, rs.timestamp_domain.hardware_clock
            frame.frame_number, frame.profile = number, streams[kind].as_video_stream_profile()
            if kind == rs.stream.depth:
                frame.depth_units = 0.001
            sensors[kind].on_video_frame(frame)

    def take():  # type: ignore[no-untyped-def]
        ok, frameset = syncer.try_wait_for_frames(500)
        return frameset if ok else None

    found = list(RealSense("", SourceOptions(), library=rs, frames=take).frames())
    assert found
    assert (found[0].rgb == true.rgb).all()
    assert np.abs(found[0].depth_m - np.nan_to_num(true.depth_m)).max() < 6e-4
    assert found[0].camera == true.camera


@pytest.mark.long
def test_without_camera_or_library_it_says_what_to_do() -> None:
    with pytest.raises((DeviceError, MissingPartError), match="RealSense"):
        next(RealSense("", SourceOptions()).frames())
