"""A small language-model server on this machine, for tests: real HTTP, an answer by a function."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer


class LlmServer:
    """Serves chat completions until it is shut down.

    Attributes:
        answer: what it says to a prompt.
        keys: the Authorization headers that came.
        prompts: what was asked, oldest first.
    """

    def __init__(self, answer: Callable[[str], str]) -> None:
        self.answer = answer
        self.keys: list[str] = []
        self.prompts: list[str] = []
        server = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                prompt = body["messages"][0]["content"]
                server.keys.append(self.headers.get("Authorization", ""))
                server.prompts.append(prompt)
                message = {"role": "assistant", "content": server.answer(prompt)}
                raw = json.dumps({"choices": [{"message": message}], "usage": {"completion_tokens": 7}}).encode()
                self.send_response(200)
                self.send_header("Content-Length", str(len(raw)))
                self.end_headers()
                self.wfile.write(raw)

            def log_message(self, *_: object) -> None:
                """Keeps the test's output clean."""

        self._http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._http.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._http.server_address[1]}/v1"
        threading.Thread(target=self._http.serve_forever, args=(0.01,), daemon=True).start()

    def shut_down(self) -> None:
        """From now on nothing answers at that address. Safe to call again."""
        self._http.shutdown()
        self._http.server_close()


def asked_in(prompt: str) -> str:
    """The question that a prompt for better words is about; empty for other prompts."""
    return prompt.rsplit("Question:", 1)[1].split("\n")[0].strip() if "Rewritten:" in prompt else ""


def friendly(prompt: str) -> str:
    """Puts a question in other words that mean the same."""
    question = asked_in(prompt)
    if question.startswith("Is it one of the ") and question.endswith(" boxes?"):
        return f"Is the box that you mean {question.removeprefix('Is it one of the ').removesuffix(' boxes?')}?"
    return question.replace(" safe to fly through?", " passable?")
