"""A small language model on this machine's processor, in a process of its own."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from importlib.util import find_spec
from typing import IO, Any

from pydantic import BaseModel

from mintpilot.core.errors import DeviceError, MissingPartError
from mintpilot.core.ports import Completion, LanguageModel
from mintpilot.models.gguf import find_model

_MOST_TOKENS = 200
_LOAD_S = 60.0
_HANGS_S = 60.0
"""A process that is silent for so long is ended."""


class EmbeddedModel(LanguageModel):
    """Runs a GGUF file with llama.cpp. It starts to load when it is made, so that it is warm when it is needed.

    A completion that comes too late is thrown away; a process that hangs or dies is started again at the next call.

    Args:
        path: the GGUF file; default: see `mintpilot.models.gguf.find_model`.
        environment: where the path is looked for.

    Raises:
        InputError: the file is not there or is not the one that is pinned.
        MissingPartError: the part that runs it, or the model itself, is not installed.
    """

    def __init__(self, path: str = "", *, environment: Mapping[str, str] = os.environ) -> None:
        if find_spec("xllamacpp") is None:
            raise MissingPartError("the embedded language model needs 'xllamacpp': pip install 'mintpilot[llm]'")
        self._path = find_model(path, environment)
        self._lock = threading.Lock()
        self._start()

    @property
    def name(self) -> str:
        """The model's name: its file's."""
        return self._path.stem

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:
        """One completion; see `LanguageModel.complete`."""
        started_s = time.monotonic()
        if not self._lock.acquire(timeout=max(0.0, timeout_s)):
            raise DeviceError(f"embedded model '{self.name}' is busy: going on without it")
        try:
            return self._complete(prompt, schema, started_s, timeout_s)
        finally:
            self._lock.release()

    def _complete(self, prompt: str, schema: type | None, started_s: float, timeout_s: float) -> Completion:
        form = schema.model_json_schema() if schema is not None and issubclass(schema, BaseModel) else None
        if self._process.poll() is not None:
            self._start()
        self._await(self._sent, started_s + timeout_s)  # what was asked before and came too late
        self._send({"id": self._sent + 1, "prompt": prompt, "schema": form, "max_tokens": _MOST_TOKENS})
        answer = self._await(self._sent, started_s + timeout_s)
        if "text" not in answer:
            raise DeviceError(f"embedded model '{self.name}' failed ({answer.get('error')}): going on without it")
        seconds = time.monotonic() - started_s
        return Completion(text=str(answer["text"]), model=self.name, seconds=seconds, tokens=int(answer["tokens"]))

    def wait(self, timeout_s: float = _LOAD_S) -> None:
        """Waits until the model is loaded. Raises `DeviceError` when it is not in time."""
        self._await(self._sent, time.monotonic() + timeout_s)

    def close(self) -> None:
        """Ends the process."""
        self._process.kill()
        self._process.wait()
        self._reader.join(1.0)
        if self._process.stdin is not None:
            with suppress(OSError):
                self._process.stdin.close()

    def __del__(self) -> None:
        """No process outlives its owner."""
        if hasattr(self, "_process"):
            self.close()

    def _start(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "mintpilot.models.embedded_worker", str(self._path)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            encoding="utf-8",
        )
        self._answers: queue.Queue[dict[str, Any] | None] = queue.Queue()
        self._sent, self._heard, self._since_s = 0, -1, time.monotonic()
        self._reader = threading.Thread(target=_listen, args=(self._process.stdout, self._answers), daemon=True)
        self._reader.start()

    def _send(self, request: dict[str, Any]) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(request) + "\n")
            self._process.stdin.flush()
        except OSError as error:
            raise DeviceError(f"embedded model '{self.name}' is gone: it is started again at the next call") from error
        self._sent, self._since_s = self._sent + 1, time.monotonic()

    def _await(self, number: int, until_s: float) -> dict[str, Any]:
        """The answer with that number (0: the model is loaded); earlier ones, which came too late, are thrown away."""
        answer: dict[str, Any] | None = {}
        while self._heard < number:
            try:
                answer = self._answers.get(timeout=max(0.0, until_s - time.monotonic()))
            except queue.Empty:
                if time.monotonic() - self._since_s > _HANGS_S:
                    self.close()
                raise DeviceError(f"embedded model '{self.name}' did not answer in time: going on without it") from None
            if answer is None:
                raise DeviceError(f"embedded model {self._path} could not be loaded or run: is it a GGUF file?")
            self._heard = int(answer["id"])
        return answer or {}


def _listen(pipe: IO[str] | None, answers: queue.Queue[dict[str, Any] | None]) -> None:
    """Passes the process's answers on; None at its end."""
    if pipe is not None:
        with suppress(OSError, ValueError), pipe:
            for line in pipe:
                answers.put(json.loads(line))
    answers.put(None)
