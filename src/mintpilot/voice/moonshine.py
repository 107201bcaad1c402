"""Moonshine's tiny English model: a second opinion."""

from __future__ import annotations

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.voice.models import MOONSHINE, checked_files
from mintpilot.voice.ports import RATE_HZ, Hypothesis, Recogniser

_LEAD_S = 0.3
"""Silence put before and after: the model loses short words at the very edge, seconds."""


class MoonshineRecogniser(Recogniser):
    """Gives one text, without a score.

    Raises:
        MissingPartError: the package ``moonshine-voice`` is not installed.
        InputError: its model is not the pinned one.
    """

    def __init__(self) -> None:
        folder = checked_files("moonshine_voice", MOONSHINE)
        from moonshine_voice.moonshine_api import ModelArch
        from moonshine_voice.transcriber import Transcriber

        self._model = Transcriber(str(folder / "assets" / "tiny-en"), ModelArch.TINY)

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        """See `Recogniser.hypotheses`; the probability is always 1."""
        quiet = np.zeros(int(_LEAD_S * RATE_HZ))
        try:
            found = self._model.transcribe_without_streaming(
                np.concatenate([quiet, samples, quiet]).astype(np.float32).tolist(), RATE_HZ
            )
        except Exception as error:  # whatever the library raises, the caller learns of one kind
            raise DeviceError(f"the second recogniser failed: {error}") from error
        text = " ".join(line.text.strip() for line in found.lines).strip()
        return (Hypothesis(text=text, probability=1.0),) if text else ()
