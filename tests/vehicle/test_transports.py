"""Addresses other than UDP in: the double behind TCP, a serial line (a pseudo-terminal), and UDP that waits for us."""

from __future__ import annotations

import os
import select
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.serving import DoubleSetup, VehicleDouble, free_port
from mintpilot.vehicle.address import parse_address
from mintpilot.vehicle.mavsdk_link import MavsdkLink

pytest.importorskip("mavsdk", reason="needs mavsdk")
pytest.importorskip("pymavlink", reason="needs pymavlink")
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("mavlink")]

Wire = tuple[int, Callable[[], bytes], Callable[[bytes], object]]
"""File descriptor, how to read, how to write."""


@contextmanager
def carried(port: int, far: Wire) -> Iterator[None]:
    """Carries bytes between the double, which sends to that port, and the far side."""
    stop = threading.Event()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as near:
        near.bind(("127.0.0.1", port))
        thread = threading.Thread(target=_carry, args=(near, far, stop))
        thread.start()
        try:
            yield
        finally:
            stop.set()
            thread.join()


def _carry(near: socket.socket, far: Wire, stop: threading.Event) -> None:
    number, read, write = far
    double = None
    while not stop.is_set():
        ready, _, _ = select.select([near, number], [], [], 0.1)
        if near in ready:
            packet, double = near.recvfrom(4096)
            write(packet)
        if number in ready:
            said = read()
            if double is not None and said:
                near.sendto(said, double)


def flies(address: str, flavour: Flavour) -> None:
    """The autopilot is heard there, and answers."""
    link = MavsdkLink(parse_address(address))
    try:
        name = "COM_OF_LOSS_T" if flavour is Flavour.PX4 else "GUID_TIMEOUT"
        assert link.get_parameter(name) in (1.0, 3.0)
        assert link.stand_by() in ("", "temporarily rejected")
    finally:
        link.close()


@pytest.mark.parametrize("flavour", list(Flavour))
def test_tcp_to_an_autopilot_that_waits(flavour: Flavour):
    """As ArduCopter's simulation at 5760."""
    port = free_port()
    with socket.create_server(("127.0.0.1", 0)) as server, VehicleDouble(DoubleSetup(flavour=flavour, port=port)):
        peers: list[socket.socket] = []
        accepting = threading.Thread(target=lambda: peers.append(server.accept()[0]))
        accepting.start()
        address = f"mavlink://tcpout:127.0.0.1:{server.getsockname()[1]}"

        def later() -> None:
            accepting.join()
            peer = peers[0]
            with carried(port, (peer.fileno(), lambda: peer.recv(4096), peer.sendall)):
                done.wait()

        done = threading.Event()
        carrying = threading.Thread(target=later)
        carrying.start()
        try:
            flies(address, flavour)
        finally:
            done.set()
            carrying.join()
            peers[0].close()


def test_a_serial_line():
    port, (ours, theirs) = free_port(), os.openpty()
    setup = DoubleSetup(flavour=Flavour.PX4, port=port)
    wire = (ours, lambda: os.read(ours, 4096), lambda packet: os.write(ours, packet))
    try:
        with VehicleDouble(setup), carried(port, wire):
            flies(f"mavlink://serial:{os.ttyname(theirs)}:57600", Flavour.PX4)
    finally:
        os.close(ours)
        os.close(theirs)


def test_udp_to_an_autopilot_that_waits():
    port = free_port()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as there:
        there.bind(("127.0.0.1", 0))
        peer: list[object] = []

        def read() -> bytes:
            packet, address = there.recvfrom(4096)
            peer[:] = [address]
            return packet

        def write(packet: bytes) -> None:
            if peer:
                there.sendto(packet, peer[0])

        with VehicleDouble(DoubleSetup(flavour=Flavour.PX4, port=port)), carried(port, (there.fileno(), read, write)):
            flies(f"mavlink://udpout:127.0.0.1:{there.getsockname()[1]}", Flavour.PX4)
