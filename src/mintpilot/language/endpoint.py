"""Any OpenAI-compatible server: a vendor's, or Ollama, vLLM, llama.cpp on one's own machine.

Plain HTTP from the standard library: no client with retries of its own stands between the time-out and the wire, no
redirect carries the key elsewhere, and nothing is logged.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Mapping
from enum import StrEnum
from http.client import HTTPException
from typing import Any
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit
from urllib.request import HTTPRedirectHandler, Request, build_opener

from pydantic import BaseModel, ValidationError

from mintpilot.core.errors import DeviceError, InputError
from mintpilot.core.ports import Completion, LanguageModel
from mintpilot.language.deadline import within

URL_VARIABLE = "MINTPILOT_LLM_URL"
MODEL_VARIABLE = "MINTPILOT_LLM_MODEL"
KEY_VARIABLES = ("MINTPILOT_LLM_KEY", "OPENAI_API_KEY")
"""Where the key is looked for; nowhere else."""

_MOST_BYTES = 1_000_000
_MOST_TOKENS = 400


class OutputMode(StrEnum):
    """How a server is told to answer in JSON; servers differ."""

    NATIVE = "native"
    """``response_format`` with the JSON schema."""
    PROMPTED = "prompted"
    """The schema is written into the prompt."""


class EndpointModel(LanguageModel):
    """A chat model behind an OpenAI-compatible address.

    Args:
        url: base address up to and with ``/v1``; default: the environment's ``MINTPILOT_LLM_URL``.
        model: the server's name for the model; default: the environment's ``MINTPILOT_LLM_MODEL``.
        mode: how JSON is asked for.
        environment: where address, name and key come from; the key is read for each call and kept nowhere.

    Raises:
        InputError: no usable address, or no model name.
    """

    def __init__(
        self,
        url: str = "",
        model: str = "",
        *,
        mode: OutputMode = OutputMode.PROMPTED,
        environment: Mapping[str, str] = os.environ,
    ) -> None:
        self._environment = environment
        self._url = (url or environment.get(URL_VARIABLE, "")).rstrip("/")
        self._model = model or environment.get(MODEL_VARIABLE, "")
        self._mode = mode
        parts = urlsplit(self._url)
        if parts.scheme not in ("http", "https") or not parts.hostname or parts.username or parts.password:
            raise InputError(
                f"language model address '{parts.scheme}://{parts.hostname}' cannot be used: set {URL_VARIABLE} to an "
                "http or https address without a key in it, e.g. http://localhost:11434/v1"
            )
        if not self._model:
            raise InputError(f"no language model is named for {parts.hostname}: set {MODEL_VARIABLE}, e.g. 'qwen3:4b'")

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:
        """One completion; see `LanguageModel.complete`."""
        started_s = time.monotonic()
        body = json.dumps(self._body(prompt, schema)).encode()
        raw = within(lambda: self._post(body, timeout_s), timeout_s, f"language model '{self._model}'")
        try:
            reply = _Reply.model_validate_json(raw)
            text = reply.choices[0].message.content
        except (ValidationError, IndexError) as error:
            raise DeviceError(
                f"language model '{self._model}' sent no chat completion: check that {URL_VARIABLE} ends in /v1"
            ) from error
        return Completion(
            text=text,
            model=self._model,
            seconds=time.monotonic() - started_s,
            tokens=reply.usage.completion_tokens if reply.usage else 0,
        )

    def _body(self, prompt: str, schema: type | None) -> dict[str, Any]:
        body: dict[str, Any] = {"model": self._model, "temperature": 0, "max_tokens": _MOST_TOKENS}
        if schema is not None and issubclass(schema, BaseModel):
            form = schema.model_json_schema()
            if self._mode is OutputMode.NATIVE:
                json_schema = {"name": schema.__name__.strip("_"), "schema": form}
                body["response_format"] = {"type": "json_schema", "json_schema": json_schema}
            else:
                prompt = f"{prompt}\n\nAnswer with JSON of this schema only: {json.dumps(form)}"
        return {**body, "messages": [{"role": "user", "content": prompt}]}

    def _post(self, body: bytes, timeout_s: float) -> bytes:
        headers = {"Content-Type": "application/json"}
        key = next((self._environment[name] for name in KEY_VARIABLES if self._environment.get(name)), "")
        if key:
            headers["Authorization"] = f"Bearer {key}"
        request = Request(f"{self._url}/chat/completions", data=body, headers=headers, method="POST")
        try:
            with build_opener(_NoRedirect).open(request, timeout=timeout_s) as response:
                raw: bytes = response.read(_MOST_BYTES + 1)
        except HTTPError as error:
            error.close()
            raise DeviceError(
                f"language model server answered {error.code}: check key, address and the model's name '{self._model}'"
            ) from None
        except (URLError, HTTPException, OSError, ValueError) as error:
            reason = type(getattr(error, "reason", error)).__name__
            raise DeviceError(f"language model server cannot be reached ({reason}): check {URL_VARIABLE}") from None
        if len(raw) > _MOST_BYTES:
            raise DeviceError(f"language model server sent more than {_MOST_BYTES} bytes: its answer was thrown away")
        return raw


class _NoRedirect(HTTPRedirectHandler):
    def redirect_request(self, *_: object) -> None:
        """Follows none: the key must not travel to another address."""


class _Message(BaseModel):
    content: str


class _Choice(BaseModel):
    message: _Message


class _Usage(BaseModel):
    completion_tokens: int = 0


class _Reply(BaseModel):
    choices: list[_Choice]
    usage: _Usage | None = None
