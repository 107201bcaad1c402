"""Pictures of the double's world, drawn where the double says it is."""

import math
import time

import numpy as np
import pytest

from mintpilot.conformance.vehicle_double.camera import DoubleCamera
from mintpilot.core.ports import SourceOptions
from mintpilot.simulation.picture_server import RemotePictures
from mintpilot.simulation.scenarios import make_scenario

pytest.importorskip("mujoco", reason="needs MuJoCo")
pytestmark = [pytest.mark.sim, pytest.mark.slow]


def test_the_picture_is_taken_where_the_double_is():
    scenario = make_scenario("medicine-boxes", 0)
    camera = DoubleCamera(scenario.scene, scenario.rules, 0)
    try:
        pictures = RemotePictures(f"//127.0.0.1:{camera.port}", SourceOptions())
        x, y, _ = scenario.scene.start_m
        views = []
        for ned, heading in [((0.0, 0.0, -1.2), 0.0), ((1.0, 0.5, -1.5), math.pi / 2)]:
            camera.move(3.0, ned, heading)
            frame = pictures.picture()
            north, east, down = ned
            ahead = np.array([math.sin(heading), math.cos(heading)])
            eye = frame.source_from_camera[:3, 3]
            assert eye[:2] == pytest.approx(np.array([x + east, y + north]) + 0.16 * ahead, abs=1e-3)
            assert eye[2] == pytest.approx(-down - 0.02, abs=1e-3)
            looks = frame.source_from_camera[:2, 2]
            assert looks / np.linalg.norm(looks) == pytest.approx(ahead, abs=1e-3)
            assert frame.time_s == pytest.approx(3.0)
            views.append(frame.rgb)
        assert np.abs(views[0].astype(int) - views[1]).mean() > 5
    finally:
        camera.close()


def test_a_double_in_a_process_has_one_too():
    from mintpilot.conformance.vehicle_double.parameters import Flavour
    from mintpilot.conformance.vehicle_double.serving import DoubleSetup, VehicleDouble, free_port

    pytest.importorskip("pymavlink", reason="needs pymavlink")
    scenario = make_scenario("medicine-boxes", 0)
    setup = DoubleSetup(
        flavour=Flavour.PX4, port=free_port(), scene=scenario.scene, rules=scenario.rules, camera_port=0
    )
    with VehicleDouble(setup) as double:
        time.sleep(0.2)
        port = double.state().camera_port
        frame = RemotePictures(f"//127.0.0.1:{port}", SourceOptions()).picture()
    assert frame.rgb.shape == (240, 320, 3)
    assert np.isfinite(frame.depth_m).any()
