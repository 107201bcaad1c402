"""Opening a MAVLink connection: no port, a port in use, nobody there are told apart, and waited for only so long."""

from __future__ import annotations

import os
import socket
from pathlib import Path
from typing import TYPE_CHECKING

from mintpilot.core.errors import DeviceError, MissingPartError
from mintpilot.vehicle.address import Address
from mintpilot.vehicle.failsafes import OUR_SYSTEM_ID

if TYPE_CHECKING:
    from mavsdk.mavsdk import Mavsdk
    from mavsdk.system import System

HEARD_S = 10.0
"""Longest wait for the first heartbeat, seconds."""
OUR_COMPONENT_ID = 190
"""A ground station: PX4 counts the data link by the heartbeats of ground stations alone, and is not armed without one
where its loss is acted on."""


def connected(address: Address) -> tuple[Mavsdk, System]:
    """The library with an open connection, and the autopilot at its other end."""
    try:
        from mavsdk.logging import log_subscribe
        from mavsdk.mavsdk import Configuration, Mavsdk
    except ImportError:
        raise MissingPartError("flying needs MAVSDK; install it: pip install 'mintpilot[vehicle]'") from None
    _check_port(address)
    log_subscribe(lambda *_: True)  # what it has to say reaches the person as errors
    mavsdk = Mavsdk(Configuration.create_manual(OUR_SYSTEM_ID, OUR_COMPONENT_ID, True))
    try:
        mavsdk.add_any_connection(address.connection)
    except Exception as error:
        mavsdk.destroy()
        raise _closed(address, str(error)) from None
    system = mavsdk.first_autopilot(HEARD_S)
    if system is None:
        mavsdk.destroy()
        cause = "the autopilot sends to another port" if address.listens else "nobody answers there"
        raise DeviceError(
            f"no heartbeat on {address.connection} within {HEARD_S:g} s: most likely {cause}, or it is switched off; "
            "compare the address with the one that the autopilot (or its router) is set to"
        )
    return mavsdk, system


def _check_port(address: Address) -> None:
    """The library shares a port with whoever has it already, and then hears nothing: that must be told before."""
    transport, _, place = address.connection.partition("://")
    host, _, port = place.rpartition(":")
    if transport == "serial" and host.startswith("/") and not os.access(host, os.R_OK | os.W_OK):
        raise _closed(address, "it may not be read and written" if Path(host).exists() else "there is no such device")
    if not address.listens:
        return
    kind = socket.SOCK_DGRAM if transport == "udpin" else socket.SOCK_STREAM
    try:
        with socket.socket(socket.AF_INET, kind) as probe:
            probe.bind((host, int(port)))
    except OSError as error:
        raise _closed(address, error.strerror or str(error)) from None


def _closed(address: Address, why: str) -> DeviceError:
    cause = "another program (a ground station, an earlier run) uses it, or it does not exist"
    return DeviceError(f"{address.connection} cannot be opened ({why}): most likely {cause}")
