"""A vision-language server on this machine, for tests: real HTTP, answers from the truth about the picture it gets."""

from __future__ import annotations

import base64
import io
import json
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
from PIL import Image

INKS = {1: (230, 25, 75), 2: (0, 130, 200), 3: (60, 180, 75), 4: (245, 130, 48), 5: (145, 30, 180), 6: (0, 128, 128)}
"""Colours of the marks, as they are seen in the picture."""


def marks_in(png: bytes) -> dict[int, tuple[float, float]]:
    """Where the marks are, as shares of width and height: what a model would have to see for itself."""
    picture = np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)
    found = {}
    for number, ink in INKS.items():
        rows, columns = np.nonzero((picture == ink).all(-1))
        if len(rows) > 20:
            found[number] = (float(np.median(columns)) / picture.shape[1], float(np.median(rows)) / picture.shape[0])
    return found


class VisionServer:
    """Serves chat completions about pictures until it is shut down.

    Attributes:
        answer: what it says to a prompt and a picture.
        prompts: what was asked, oldest first.
        slow_s: how long it takes, seconds.
        status: what it answers with.
    """

    def __init__(self, answer: Callable[[str, bytes], str]) -> None:
        self.answer, self.slow_s, self.status = answer, 0.0, 200
        self.prompts: list[str] = []
        server = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                parts = body["messages"][0]["content"]
                (prompt,) = [part["text"] for part in parts if part["type"] == "text"]
                (address,) = [part["image_url"]["url"] for part in parts if part["type"] == "image_url"]
                png = base64.b64decode(address.removeprefix("data:image/png;base64,"))
                server.prompts.append(prompt)
                time.sleep(server.slow_s)
                message = {"role": "assistant", "content": server.answer(prompt, png)}
                raw = json.dumps({"choices": [{"message": message}], "usage": {"completion_tokens": 7}}).encode()
                self.send_response(server.status)
                self.send_header("Content-Length", str(len(raw)))
                self.end_headers()
                with suppress(BrokenPipeError, ConnectionResetError):  # the asker went away
                    self.wfile.write(raw)

            def log_message(self, *_: object) -> None:
                """Keeps the test's output clean."""

        self._http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._http.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._http.server_address[1]}/v1"
        threading.Thread(target=self._http.serve_forever, args=(0.01,), daemon=True).start()

    def shut_down(self) -> None:
        """From now on nothing answers at that address."""
        self._http.shutdown()
        self._http.server_close()


def naming(by_place: Callable[[float, float], str], certainty: float = 0.95) -> Callable[[str, bytes], str]:
    """Answers with the name of what is at the place of each mark."""

    def answer(_: str, png: bytes) -> str:
        things = [
            {"number": number, "names": [{"label": by_place(x, y), "certainty": certainty}]}
            for number, (x, y) in marks_in(png).items()
        ]
        return json.dumps({"things": things})

    return answer
