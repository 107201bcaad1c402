"""Models without a model: none at all, a function, a recording."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path

from mintpilot.core.errors import DeviceError, InputError
from mintpilot.core.ports import Completion, LanguageModel


class NoModel(LanguageModel):
    """No language model: everything is worded by template and read by rules."""

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:  # noqa: ARG002
        """Always raises `DeviceError`: there is nothing to ask."""
        raise DeviceError("no language model is configured: words come from templates")


class FunctionModel(LanguageModel):
    """A function as a model, for tests: it gets the prompt and returns the text, or raises."""

    def __init__(self, function: Callable[[str], str], *, name: str = "function") -> None:
        self._function = function
        self._name = name

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:  # noqa: ARG002
        """What the function makes of the prompt; its errors are the model's."""
        return Completion(text=self._function(prompt), model=self._name, seconds=0.0)


class ReplayModel(LanguageModel):
    """Gives recorded completions, in order; without the network a flight can be told again word for word."""

    def __init__(self, completions: Iterable[Completion]) -> None:
        self._left = list(completions)

    @classmethod
    def from_file(cls, path: Path) -> ReplayModel:
        """From a file of JSON lines, each with ``text`` and, if wished, ``model``, ``seconds``, ``tokens``.

        Raises:
            InputError: the file cannot be read or a line is malformed.
        """
        found = []
        try:
            lines = path.read_text("utf-8").splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"recorded completions {path} cannot be read: {error}") from error
        for number, line in enumerate(lines, start=1):
            try:
                row = json.loads(line)
                found.append(
                    Completion(
                        text=str(row["text"]),
                        model=str(row.get("model", "replay")),
                        seconds=float(row.get("seconds", 0)),
                        tokens=int(row.get("tokens", 0)),
                    )
                )
            except (ValueError, TypeError, KeyError, AttributeError) as error:
                raise InputError(f"{path}:{number}: not a JSON object with 'text': record it again") from error
        return cls(found)

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:  # noqa: ARG002
        """The next recorded completion. Raises `DeviceError` at the end of the recording."""
        if not self._left:
            raise DeviceError("the recording of the language model is at its end: record more, or go on with templates")
        return self._left.pop(0)
