"""A small peer that speaks ArduPilot's JSON interface over UDP, and flies our world with it."""

from __future__ import annotations

import json
import math
import socket
import struct
import threading
from collections.abc import Iterator

import numpy as np
import pytest

from mintpilot.assembly.simulating import world_of
from mintpilot.assembly.sources import open_source
from mintpilot.cli.simulating import address_of
from mintpilot.core.errors import DeviceError, InputError, MapError
from mintpilot.core.ports import SourceOptions
from mintpilot.simulation.ardupilot_json import ArdupilotServer, read_servos

pytest.importorskip("mujoco", reason="needs MuJoCo")
RATE_HZ = 400


pytestmark = pytest.mark.long  # they share one drone, in this order


class Peer:
    """What ArduCopter does at this interface: sends servo packets, reads lines of JSON."""

    def __init__(self, port: int) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(5.0)
        self.address, self.number = ("127.0.0.1", port), 0

    def send(self, pulses: list[float], *, number: int | None = None) -> dict:
        self.number = self.number + 1 if number is None else number
        channels = [*pulses, *[1000.0] * 12]
        packet = struct.pack("<HHI16H", 18458, RATE_HZ, self.number, *(round(p) for p in channels))
        self.socket.sendto(packet, self.address)
        text = self.socket.recv(65536).decode()
        assert " " not in text, "ArduPilot reads no spaces"
        return json.loads(text)


def mixed(thrust: float, roll: float, pitch: float, yaw: float) -> list[float]:
    """ArduPilot's X frame: front right, rear left, front left, rear right; thrust and torques as shares."""
    shares = (
        thrust - roll + pitch + yaw,
        thrust + roll - pitch + yaw,
        thrust + roll + pitch - yaw,
        thrust - roll - pitch - yaw,
    )
    return [1000 + 1000 * math.sqrt(min(1.0, max(0.0, share))) for share in shares]


def angles(quaternion: list[float]) -> tuple[float, float, float]:
    w, x, y, z = quaternion
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    return roll, pitch, math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def hover(peer: Peer, wanted: tuple[float, float, float], heading: float, seconds: float, state: dict) -> dict:
    """Flies to a place (north, east, down) by what the interface says, as an autopilot would."""
    for _ in range(int(seconds * RATE_HZ)):
        roll, pitch, yaw = angles(state["quaternion"])
        error = np.clip(np.subtract(wanted, state["position"]), -1.5, 1.5)
        push = 0.9 * error - 1.1 * np.asarray(state["velocity"])
        ahead = math.cos(yaw) * push[0] + math.sin(yaw) * push[1]
        right = -math.sin(yaw) * push[0] + math.cos(yaw) * push[1]
        p, q, r = state["imu"]["gyro"]
        turn = math.remainder(heading - yaw, 2 * math.pi)
        state = peer.send(
            mixed(
                0.40 - 0.10 * push[2],
                0.25 * (np.clip(0.12 * right, -0.3, 0.3) - roll) - 0.05 * p,
                0.25 * (np.clip(-0.12 * ahead, -0.3, 0.3) - pitch) - 0.05 * q,
                0.15 * turn - 0.10 * r,
            )
        )
    return state


@pytest.fixture(scope="module")
def served() -> Iterator[tuple[ArdupilotServer, Peer]]:
    server = ArdupilotServer(world_of("medicine-boxes", 1), port=0, camera_port=0)
    ends = threading.Event()
    thread = threading.Thread(target=lambda: server.serve(until=ends.is_set, wait_s=0.05))
    thread.start()
    peer = Peer(server.port)
    yield server, peer
    ends.set()
    thread.join()
    peer.socket.close()
    server.close()
    server.close()


def test_it_stands_rises_turns_and_goes_where_it_is_sent(served: tuple[ArdupilotServer, Peer]) -> None:
    _, peer = served
    state = peer.send([1000.0] * 4, number=0)
    for _ in range(200):
        state = peer.send([1000.0] * 4)
    assert np.linalg.norm(state["position"]) < 0.03
    assert state["imu"]["accel_body"][2] == pytest.approx(-9.81, abs=0.3), "standing, it feels the ground"
    east = angles(state["quaternion"])[2]
    assert east == pytest.approx(math.pi / 2, abs=0.05), "it looks along x, which is east"
    begun_s = state["timestamp"]
    up = hover(peer, (0.0, 0.0, -1.5), east, 6.0, state)
    assert up["timestamp"] - begun_s == pytest.approx(6.0, abs=0.01), "in lock-step"
    assert up["position"] == pytest.approx([0.0, 0.0, -1.5], abs=0.15)
    north = hover(peer, (1.0, 0.0, -1.5), 0.0, 8.0, up)
    assert north["position"] == pytest.approx([1.0, 0.0, -1.5], abs=0.2)
    assert angles(north["quaternion"])[2] == pytest.approx(0.0, abs=0.1)
    side = hover(peer, (1.0, 0.8, -1.2), 0.0, 8.0, north)
    assert side["position"] == pytest.approx([1.0, 0.8, -1.2], abs=0.2)


def test_a_repeated_packet_makes_no_step_and_a_restart_begins_anew(served: tuple[ArdupilotServer, Peer]) -> None:
    _, peer = served
    one = peer.send([1400.0] * 4)
    assert peer.send([1400.0] * 4, number=peer.number) == one
    peer.socket.sendto(b"", peer.address)
    peer.socket.sendto(b"\x00" * 40, peer.address)
    assert peer.send([1400.0] * 4)["timestamp"] > one["timestamp"]
    again = peer.send([1000.0] * 4, number=0)
    assert again["timestamp"] == pytest.approx(1 / RATE_HZ)
    assert np.linalg.norm(again["position"]) < 0.02


def test_pictures_are_of_the_place_where_it_is(served: tuple[ArdupilotServer, Peer]) -> None:
    server, peer = served
    peer.send([1000.0] * 4)
    source = open_source(f"sim://127.0.0.1:{server.camera_port}", SourceOptions(longest=1))
    (frame,) = list(source.frames())
    assert frame.rgb.shape == (240, 320, 3)
    assert (frame.depth_m > 0).mean() > 0.3
    assert frame.source_from_camera is not None
    assert frame.source_from_camera[2, 3] < 0.5, "it stands on the floor"
    connection = socket.create_connection(("127.0.0.1", server.camera_port or 0))
    connection.close()
    assert len(list(source.frames())) == 1


def test_wrong_addresses_and_packets_are_refused() -> None:
    assert address_of(":9002") == ("127.0.0.1", 9002)
    for text in ("9002", "here:", ":99999", "a:b"):
        with pytest.raises(InputError, match="HOST:PORT"):
            address_of(text)
    with pytest.raises(MapError, match="no address"):
        open_source("sim://nowhere", SourceOptions())
    with pytest.raises(DeviceError, match="sim serve"):
        list(open_source("sim://127.0.0.1:1", SourceOptions()).frames())
    assert read_servos(struct.pack("<HHI16H", 18458, 0, 1, *[1000] * 16)) is None
    assert read_servos(struct.pack("<HHI16H", 1, 400, 1, *[1000] * 16)) is None
    assert read_servos(struct.pack("<HHI32H", 29569, 400, 1, *[1000] * 32)) is not None
