"""Faults of the double, by switch, and what they do to the packets on their way."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from random import Random

from mintpilot.core.errors import InputError, UnknownNameError

DELAY_S = 0.3
"""How late packets come, seconds."""


class Fault(StrEnum):
    """What may go wrong. Each lasts from its time on."""

    SILENCE = "silence"
    """Nothing is sent and nothing heard any more: the link is cut."""
    HEARTBEAT = "heartbeat"
    """No heartbeat is sent any more."""
    REFUSE_ARM = "refuse-arm"
    """It refuses to be armed."""
    POSITION_LOST = "position-lost"
    """It does not know any more where it is."""
    POSITION_JUMP = "position-jump"
    """Its position jumps by 4 m."""
    DELAY = "delay"
    """Packets come 0.3 s late."""
    REORDER = "reorder"
    """Packets come in another order."""
    DUPLICATE = "duplicate"
    """Each packet comes twice."""
    CORRUPT = "corrupt"
    """One packet in five has a wrong byte."""
    PILOT = "pilot"
    """A pilot switches to a mode of their own."""
    BATTERY = "battery"
    """The battery drops to a tenth, and two hundredths less each second."""
    NO_GRIPPER = "no-gripper"
    """It has no gripper."""
    NO_GPS = "no-gps"
    """It is indoors: it knows its place in the room, and not on the earth."""
    SLOW_STREAMS = "slow-streams"
    """Another ground station sets all its messages to four a second."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedFault:
    """A fault and when it begins, seconds after the double has begun."""

    fault: Fault
    at_s: float = 0.0


def parse_fault(text: str) -> TimedFault:
    """A fault in the form ``NAME@SECONDS``.

    Raises:
        UnknownNameError: there is no such fault.
        InputError: the time is none.
    """
    name, _, at = text.partition("@")
    if name not in list(Fault):
        raise UnknownNameError("fault", name, list(Fault))
    if at and not re.fullmatch(r"\d+(\.\d+)?", at):
        raise InputError(f"fault '{text}': after @ stand the seconds after which it begins, e.g. {name}@20")
    return TimedFault(fault=Fault(name), at_s=float(at or 0.0))


class Wire:
    """Packets on their way: late, twice, in another order, with wrong bytes.

    Args:
        seed: of everything that is drawn.
    """

    def __init__(self, seed: int) -> None:
        self._random = Random(seed)
        self._late: list[tuple[float, int, bytes]] = []
        self._count = 0

    def put(self, packet: bytes, now_s: float, faults: frozenset[Fault]) -> None:
        """One packet sets out."""
        if Fault.CORRUPT in faults and self._random.random() < 0.2:
            at = self._random.randrange(len(packet))
            packet = packet[:at] + bytes([packet[at] ^ (1 + self._random.randrange(255))]) + packet[at + 1 :]
        due_s = now_s + (DELAY_S if Fault.DELAY in faults else 0.0)
        if Fault.REORDER in faults:
            due_s += self._random.choice((0.0, 0.03, 0.08))
        for _ in range(2 if Fault.DUPLICATE in faults else 1):
            self._count += 1
            self._late.append((due_s, self._count, packet))

    def due(self, now_s: float) -> Iterator[bytes]:
        """Packets that arrive by now, in the order in which they do."""
        ready = sorted(item for item in self._late if item[0] <= now_s)
        self._late = [item for item in self._late if item[0] > now_s]
        for _, _, packet in ready:
            yield packet
