"""Any OpenAI-compatible server: a vendor's, or Ollama, vLLM, llama.cpp on one's own machine.

Spoken to through `pydantic-ai` and the `openai` client, without the client's own retries. One deadline holds for the
whole call, whatever the server does; no redirect carries the key elsewhere; the answer's bytes are counted before
they are read; nothing is logged. The clients are imported when the adapter is made, never before.
"""

from __future__ import annotations

import asyncio
import json
import os
import time
from collections.abc import Mapping
from enum import StrEnum
from importlib import import_module
from importlib.util import find_spec
from urllib.parse import urlsplit

from pydantic import BaseModel

from mintpilot.core.errors import DeviceError, InputError, MintPilotError, MissingPartError, UnknownNameError
from mintpilot.core.ports import Completion, LanguageModel, VisionModel
from mintpilot.models.deadline import within

URL_VARIABLE = "MINTPILOT_LLM_URL"
MODEL_VARIABLE = "MINTPILOT_LLM_MODEL"
KEY_VARIABLES = ("MINTPILOT_LLM_KEY", "OPENAI_API_KEY")
"""Where the key is looked for; nowhere else."""
OUTPUT_VARIABLE = "MINTPILOT_LLM_OUTPUT"
"""``native`` or ``prompted``; see `OutputMode`."""
_PARTS = ("pydantic_ai", "openai", "httpx2")


class OutputMode(StrEnum):
    """How a server is told to answer in JSON; servers differ."""

    NATIVE = "native"
    """``response_format`` with the JSON schema."""
    PROMPTED = "prompted"
    """The schema is written into the prompt."""


class EndpointModel(LanguageModel, VisionModel):
    """A chat model behind an OpenAI-compatible address.

    Args:
        url: base address up to and with ``/v1``; default: the environment's ``MINTPILOT_LLM_URL``.
        model: the server's name for the model; default: the environment's ``MINTPILOT_LLM_MODEL``.
        mode: how JSON is asked for; default: the environment's ``MINTPILOT_LLM_OUTPUT``, else native. A server that
            refuses the native way is asked the other way from the next call on.
        environment: where address, name and key come from; the key is read for each call and kept nowhere.

    Raises:
        InputError: no usable address, or no model name.
        MissingPartError: the client is not installed.
    """

    def __init__(
        self,
        url: str = "",
        model: str = "",
        *,
        mode: OutputMode | None = None,
        environment: Mapping[str, str] = os.environ,
    ) -> None:
        self._environment = environment
        self._url = (url or environment.get(URL_VARIABLE, "")).rstrip("/")
        self._model = model or environment.get(MODEL_VARIABLE, "")
        self._mode = mode or _mode_in(environment)
        parts = urlsplit(self._url)
        # Never the whole address: somebody may have put a key into it.
        shown = f"'{parts.scheme}://{parts.hostname or ''}'" if self._url else "that is not given"
        if parts.scheme not in ("http", "https") or not parts.hostname or parts.username or parts.password:
            raise InputError(
                f"language model address {shown} cannot be used: set {URL_VARIABLE} to an http or https address "
                "without a key in it, e.g. http://localhost:11434/v1"
            )
        if parts.query or parts.fragment:
            raise InputError(
                f"language model address {shown} has a query ('?') or a fragment ('#'), which cannot be used: set "
                f"{URL_VARIABLE} to the base address alone, e.g. http://localhost:11434/v1"
            )
        if not self._model:
            raise InputError(f"no language model is named for {parts.hostname}: set {MODEL_VARIABLE}, e.g. 'qwen3:4b'")
        if any(find_spec(part) is None for part in _PARTS):
            raise MissingPartError(
                "a language model server is spoken to with 'pydantic-ai': pip install 'mintpilot[llm]'"
            )
        # Two seconds of importing belong to the start, not to the deadline of the first question.
        self._client = import_module("mintpilot.models.endpoint_client")

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:
        """One completion; see `LanguageModel.complete`."""
        return self._completed(prompt, schema, timeout_s)

    def look(self, prompt: str, picture_png: bytes, *, schema: type, timeout_s: float) -> str:
        """One answer about a picture; see `mintpilot.core.ports.VisionModel.look`."""
        return self._completed(prompt, schema, timeout_s, picture_png).text

    def _completed(
        self, prompt: str, schema: type | None, timeout_s: float, picture_png: bytes | None = None
    ) -> Completion:
        started_s = time.monotonic()
        form = schema if schema is not None and issubclass(schema, BaseModel) else None
        if form is not None and self._mode is OutputMode.PROMPTED:
            prompt = f"{prompt}\n\nAnswer with JSON of this schema only: {json.dumps(_bare(form.model_json_schema()))}"
            form = None
        key = next((self._environment[name] for name in KEY_VARIABLES if self._environment.get(name)), "")
        call = self._client.Call(
            url=self._url,
            model=self._model,
            key=key,
            prompt=prompt,
            form=form,
            picture_png=picture_png,
            most_tokens=_WORDS if picture_png is None else _WORDS_OF_A_PICTURE,
        )
        who = f"language model '{self._model}'"

        def ask() -> tuple[str, int]:
            try:
                answer: tuple[str, int] = asyncio.run(asyncio.wait_for(self._client.ask(call), timeout_s))
            except TimeoutError:
                raise DeviceError(f"{who} did not answer within {timeout_s:g} s: going on without it") from None
            except MintPilotError:
                raise
            except Exception as error:  # whatever the client raises: its words may hold what was sent, so only the type
                if call.form is not None and self._client.is_refused(error):
                    self._mode = OutputMode.PROMPTED
                raise self._client.told(error, self._model, URL_VARIABLE) from None
            return answer

        # A thread of its own: the port stays synchronous inside any event loop, and a loop that hangs hangs alone.
        text, tokens = within(ask, timeout_s + _GRACE_S, who)
        return Completion(text=text, model=self._model, seconds=time.monotonic() - started_s, tokens=tokens)


_WORDS = 400
"""Longest answer, tokens."""
_WORDS_OF_A_PICTURE = 2000
"""… about a picture."""
_GRACE_S = 0.1
"""For closing the connection after the deadline."""


def _mode_in(environment: Mapping[str, str]) -> OutputMode:
    name = environment.get(OUTPUT_VARIABLE) or OutputMode.NATIVE
    if name not in list(OutputMode):
        raise UnknownNameError(OUTPUT_VARIABLE, name, list(OutputMode))
    return OutputMode(name)


def _bare(schema: object) -> object:
    """The schema without titles and descriptions, which small models repeat instead of answering."""
    if isinstance(schema, dict):
        return {k: _bare(v) for k, v in schema.items() if k not in ("title", "description", "additionalProperties")}
    return [_bare(v) for v in schema] if isinstance(schema, list) else schema
