"""The process that holds an embedded model: one JSON request a line in, one JSON answer a line out.

A process of its own, so that a time-out can end it and its memory is not the mission's.
Run as ``python -m mintpilot.models.embedded_worker MODEL.gguf``.
"""

from __future__ import annotations

import json
import os
import secrets
import sys
from typing import IO, Any

_CONTEXT_TOKENS = 2048


def main() -> None:
    """Loads the model, says so with answer 0, then answers until its input ends."""
    answers = _own_output()
    server = _load(sys.argv[1])
    _say(answers, {"id": 0})
    for line in sys.stdin:
        request = json.loads(line)
        try:
            answer = _answer(server, request)
        except Exception as error:  # a bad request must not end the process; the caller is told
            answer = {"error": type(error).__name__}
        _say(answers, {"id": request["id"], **answer})


def _own_output() -> IO[str]:
    """Keeps standard output for answers: what the native library prints goes to standard error."""
    kept = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return kept


def _load(path: str) -> Any:
    import xllamacpp

    parameters = xllamacpp.CommonParams()
    parameters.model.path = path
    parameters.n_ctx = _CONTEXT_TOKENS
    parameters.n_parallel = 1
    # Two threads that write spin and stall beside a simulator on two cores; reading the prompt is short, and halved.
    parameters.cpuparams.n_threads = 1
    parameters.cpuparams_batch.n_threads = 2
    parameters.warmup = False
    # The library listens on a local port besides; nobody else may use it.
    parameters.api_keys = [secrets.token_urlsafe(32)]
    return xllamacpp.Server(parameters)


def _answer(server: Any, request: dict[str, Any]) -> dict[str, Any]:
    body: dict[str, Any] = {
        "messages": [{"role": "user", "content": request["prompt"]}],
        "max_tokens": request["max_tokens"],
        "temperature": 0,
        "cache_prompt": True,
    }
    if request.get("schema"):
        form = {"name": "answer", "schema": request["schema"]}
        body["response_format"] = {"type": "json_schema", "json_schema": form}
    reply = server.handle_chat_completions(body)
    return {
        "text": reply["choices"][0]["message"]["content"],
        "tokens": reply.get("usage", {}).get("completion_tokens", 0),
    }


def _say(answers: IO[str], answer: dict[str, Any]) -> None:
    answers.write(json.dumps(answer) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
