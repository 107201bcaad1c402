"""Answers of a vision-language model kept in a file, so that pictures can be named again without it."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from mintpilot.core.errors import DeviceError, RecordError
from mintpilot.core.ports import VisionModel

FORMAT = "mintpilot-vision 1"


class RecordedVision(VisionModel):
    """Answers from a file; what is not in it is asked of a model, and kept.

    Args:
        path: one JSON object a line; made where it is missing.
        model: asked about what is not in the file; None: nobody, such pictures have no answer.

    Raises:
        RecordError: the file cannot be read, or is something else.
    """

    def __init__(self, path: Path, model: VisionModel | None = None) -> None:
        self._path = path
        self._model = model
        self._answers = _read(path)

    def look(self, prompt: str, picture_png: bytes, *, schema: type, timeout_s: float) -> str:
        """See `VisionModel.look`."""
        key = hashlib.sha256(prompt.encode() + b"\0" + picture_png).hexdigest()
        if key not in self._answers:
            if self._model is None:
                raise DeviceError(f"{self._path.name} has no answer about this picture: going on without it")
            self._answers[key] = self._model.look(prompt, picture_png, schema=schema, timeout_s=timeout_s)
            line = json.dumps({"format": FORMAT, "key": key, "answer": self._answers[key]}, ensure_ascii=False)
            try:
                with self._path.open("a", encoding="utf-8") as file:
                    file.write(line + "\n")
            except OSError as error:
                raise DeviceError(f"cannot keep answers in {self._path}: {error.strerror}") from error
        return self._answers[key]


def _read(path: Path) -> dict[str, str]:
    if not path.exists():
        return {}
    answers: dict[str, str] = {}
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"cannot read {path}: {error}; give the file of an earlier run, or a new name") from error
    for number, line in enumerate(lines, start=1):
        try:
            kept = json.loads(line)
            if kept["format"] != FORMAT:
                raise ValueError(f"format {kept['format']!r}, this program reads {FORMAT!r}")
            answers[str(kept["key"])] = str(kept["answer"])
        except (ValueError, KeyError, TypeError, RecursionError) as error:
            if number == len(lines):
                break  # broken off while it was written
            raise RecordError(f"{path}:{number} is no answer of a vision model ({error}); give another file") from error
    return answers
