"""Keeps the drone from hearing itself: echo cancellation, or deafness while it speaks."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import from_pcm, to_pcm16
from mintpilot.voice.ports import RATE_HZ

FRAME = RATE_HZ // 100
"""Samples that are processed at a time: 10 ms."""
_STILL_HEARD = 30
"""Frames after its own speech in which a half-duplex drone stays deaf: the room's echo."""


class EchoCanceller:
    """Takes what is played out of what the microphone hears, frame by frame.

    With the package ``livekit`` the echo is cancelled, and the person may interrupt; without it the drone is deaf while
    it speaks (half-duplex).

    Attributes:
        is_full_duplex: whether the person is heard while the drone speaks.
    """

    def __init__(self, *, is_full_duplex: bool | None = None) -> None:
        there = find_spec("livekit") is not None
        self.is_full_duplex = there if is_full_duplex is None else is_full_duplex and there
        self._deaf = 0
        if self.is_full_duplex:
            from livekit.rtc import AudioProcessingModule

            self._module = AudioProcessingModule(echo_cancellation=True, high_pass_filter=True)

    def process(self, heard: Floats, played: Floats) -> Floats:
        """One frame of the microphone (`FRAME`,) without the echo of what is played in the same 10 ms (`FRAME`,)."""
        if self.is_full_duplex:
            from livekit.rtc import AudioFrame

            far, near = (AudioFrame(bytearray(to_pcm16(x)), RATE_HZ, 1, FRAME) for x in (played, heard))
            self._module.process_reverse_stream(far)
            self._module.set_stream_delay_ms(0)
            self._module.process_stream(near)
            return from_pcm(bytes(near.data))
        self._deaf = _STILL_HEARD if np.any(played) else max(0, self._deaf - 1)
        return np.zeros_like(heard) if self._deaf else heard
