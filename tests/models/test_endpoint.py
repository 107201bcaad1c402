"""The endpoint adapter against a real server on this machine."""

from __future__ import annotations

import asyncio
import json
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.util import find_spec
from typing import Any

import pytest
from pydantic import BaseModel
from tests.language import questions

from mintpilot.core.errors import DeviceError, InputError, MissingPartError
from mintpilot.core.query import Reply
from mintpilot.language.answer_model import AnswerReading, read_with_model
from mintpilot.language.instruction_model import parse_with_model
from mintpilot.models import gguf
from mintpilot.models.endpoint import EndpointModel, OutputMode
from mintpilot.models.forms import read_form
from mintpilot.wording.rewording import ModelWording

pytest.importorskip("pydantic_ai", reason="the client is not installed: pip install 'mintpilot[llm]'")

KEY = "key-that-must-not-leak"


class Answer(BaseModel):
    yes: bool


class Server:
    """Answers each request with what ``respond`` makes of it; keeps what it was sent."""

    def __init__(self) -> None:
        self.requests: list[tuple[str, dict[str, str], dict[str, Any]]] = []
        self.respond: Callable[[BaseHTTPRequestHandler], None] = lambda handler: reply(handler, completion("hello"))
        server = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                server.requests.append((self.path, dict(self.headers), body))
                server.respond(self)

            def do_GET(self) -> None:
                server.requests.append((self.path, dict(self.headers), {}))
                server.respond(self)

            def log_message(self, *_: object) -> None:
                """Keeps the test's output clean."""

        self._http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._http.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._http.server_address[1]}/v1"
        threading.Thread(target=self._http.serve_forever, args=(0.01,), daemon=True).start()

    def close(self) -> None:
        self._http.shutdown()
        self._http.server_close()


def reply(handler: BaseHTTPRequestHandler, body: bytes, status: int = 200, **headers: str) -> None:
    handler.send_response(status)
    for name, value in headers.items():
        handler.send_header(name, value)
    handler.send_header("Content-Length", str(len(body)))
    handler.end_headers()
    handler.wfile.write(body)


def completion(text: str) -> bytes:
    answer = {"choices": [{"message": {"role": "assistant", "content": text}}], "usage": {"completion_tokens": 7}}
    return json.dumps(answer).encode()


@pytest.fixture
def server() -> Iterator[Server]:
    running = Server()
    yield running
    running.close()


def model(server: Server, mode: OutputMode = OutputMode.PROMPTED) -> EndpointModel:
    return EndpointModel(server.url, "tiny", mode=mode, environment={"MINTPILOT_LLM_KEY": KEY})


def test_a_completion_comes_back_with_its_figures(server: Server) -> None:
    answer = model(server).complete("Say hello.", schema=None, timeout_s=5)
    assert (answer.text, answer.model, answer.tokens) == ("hello", "tiny", 7)
    path, headers, body = server.requests[0]
    assert path == "/v1/chat/completions"
    assert headers["Authorization"] == f"Bearer {KEY}"
    assert body["messages"] == [{"role": "user", "content": "Say hello."}]
    assert body["temperature"] == 0


def test_json_is_asked_for_in_the_way_that_the_server_knows(server: Server) -> None:
    model(server).complete("Yes?", schema=Answer, timeout_s=5)
    model(server, OutputMode.NATIVE).complete("Yes?", schema=Answer, timeout_s=5)
    prompted, native = (body for _, _, body in server.requests)
    assert '"yes"' in prompted["messages"][0]["content"]
    assert "response_format" not in prompted
    assert native["messages"][0]["content"] == "Yes?"
    assert native["response_format"]["json_schema"]["schema"]["properties"].keys() == {"yes"}


def test_a_server_that_knows_no_schema_is_asked_in_words_from_then_on(server: Server) -> None:
    asked = model(server, OutputMode.NATIVE)
    server.respond = lambda h: reply(h, b"{}", 400)
    with pytest.raises(DeviceError, match="answered 400"):
        asked.complete("Yes?", schema=Answer, timeout_s=5)
    server.respond = lambda h: reply(h, completion("{}"))
    asked.complete("Yes?", schema=Answer, timeout_s=5)
    bodies = [body for _, _, body in server.requests]
    assert ["response_format" in body for body in bodies] == [True, False]


def test_the_environment_chooses_how_json_is_asked_for(server: Server) -> None:
    chosen = {"MINTPILOT_LLM_OUTPUT": "prompted"}
    EndpointModel(server.url, "tiny", environment=chosen).complete("Yes?", schema=Answer, timeout_s=5)
    assert "response_format" not in server.requests[0][2]
    with pytest.raises(InputError, match="native, prompted"):
        EndpointModel(server.url, "tiny", environment={"MINTPILOT_LLM_OUTPUT": "yaml"})


def _drip(handler: BaseHTTPRequestHandler) -> None:
    """Sends a byte now and then: each read is quick, the whole never ends."""
    handler.send_response(200)
    handler.end_headers()
    for _ in range(100):
        handler.wfile.write(b" ")
        handler.wfile.flush()
        time.sleep(0.02)


def _hang(handler: BaseHTTPRequestHandler) -> None:
    time.sleep(2)


@pytest.mark.parametrize(
    ("respond", "message"),
    [
        (_hang, "did not answer within|cannot be reached"),
        (_drip, "did not answer within"),
        (lambda h: reply(h, b"not json"), "no chat completion"),
        (lambda h: reply(h, b'{"choices": []}'), "no chat completion"),
        (lambda h: reply(h, b"[]", 500), "answered 500"),
        (lambda h: reply(h, b"", 401), "answered 401: check key"),
        (lambda h: reply(h, b"x" * 1_000_010), "more than 1000000 bytes"),
        (lambda h: h.wfile.write(b"garbage\r\n\r\n"), "cannot be reached"),
    ],
)
def test_whatever_goes_wrong_is_one_error_without_the_key(
    server: Server, respond: Callable[[BaseHTTPRequestHandler], None], message: str
) -> None:
    server.respond = respond
    timeout_s = 0.3 if respond in (_hang, _drip) else 20
    with pytest.raises(DeviceError, match=message) as caught:
        model(server).complete("Hello?", schema=None, timeout_s=timeout_s)
    assert KEY not in str(caught.value)
    assert len(server.requests) == 1, "nothing is tried twice"


def test_a_redirect_does_not_carry_the_key_away(server: Server) -> None:
    other = Server()
    server.respond = lambda h: reply(h, b"", 302, Location=f"{other.url}/chat/completions")
    with pytest.raises(DeviceError, match="answered 302"):
        model(server).complete("Hello?", schema=None, timeout_s=5)
    assert other.requests == []
    other.close()


def test_nobody_listening_is_told(server: Server) -> None:
    server.close()
    with pytest.raises(DeviceError, match="cannot be reached"):
        model(server).complete("Hello?", schema=None, timeout_s=2)


@pytest.mark.parametrize(
    ("url", "name", "message"),
    [
        ("", "tiny", "MINTPILOT_LLM_URL"),
        ("ftp://host/v1", "tiny", "cannot be used"),
        ("http://user:secret@host/v1", "tiny", "cannot be used"),
        ("http://host/v1", "", "MINTPILOT_LLM_MODEL"),
    ],
)
def test_a_bad_address_is_refused_at_once(url: str, name: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        EndpointModel(url, name, environment={})
    assert "secret" not in str(caught.value)


def test_the_environment_names_the_server(server: Server) -> None:
    environment = {"MINTPILOT_LLM_URL": server.url, "MINTPILOT_LLM_MODEL": "tiny"}
    assert EndpointModel(environment=environment).complete("?", schema=None, timeout_s=5).text == "hello"
    assert "Authorization" not in server.requests[0][1]


def test_nothing_else_of_the_environment_is_sent(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("OPENAI_ORG_ID", "OPENAI_PROJECT_ID", "OPENAI_ADMIN_KEY", "OPENAI_CUSTOM_HEADERS"):
        monkeypatch.setenv(name, "X-Own: must-not-travel")
    model(server).complete("?", schema=None, timeout_s=5)
    _, headers, _ = server.requests[0]
    assert "must-not-travel" not in str(headers)
    assert {name.lower() for name in headers} <= {
        *("host", "content-type", "content-length", "accept", "connection", "user-agent"),
        *("authorization", "accept-encoding"),
    }


def test_it_works_inside_a_running_event_loop(server: Server) -> None:
    async def inside() -> str:
        return model(server).complete("?", schema=None, timeout_s=5).text

    assert asyncio.run(inside()) == "hello"


@pytest.mark.long
def test_the_client_is_imported_only_where_a_server_is_configured() -> None:
    code = (
        "import sys, mintpilot.language, mintpilot.models.endpoint, mintpilot.assembly.talk; "
        "print(sorted({'pydantic_ai', 'openai', 'httpx2'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_without_the_client_the_install_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mintpilot.models.endpoint.find_spec", lambda _: None)
    with pytest.raises(MissingPartError, match=r"pip install 'mintpilot\[llm\]'"):
        EndpointModel("http://localhost:1/v1", "tiny", environment={})


SERVED = """
import sys, xllamacpp
p = xllamacpp.CommonParams()
p.model.path, p.n_ctx, p.n_parallel = sys.argv[1], 2048, 1
p.cpuparams.n_threads = p.cpuparams_batch.n_threads = 1
server = xllamacpp.Server(p)
print(server.listening_address, flush=True)
sys.stdin.read()
"""


@pytest.fixture(scope="module")
def llama() -> Iterator[str]:
    """A real OpenAI-compatible server on this machine, with the embedded model's file."""
    if find_spec("xllamacpp") is None or find_spec(gguf.PARTS[0]) is None:
        pytest.skip("xllamacpp or the embedded model's parts are not installed")
    path = str(gguf.find_model())
    process = subprocess.Popen(
        [sys.executable, "-c", SERVED, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        text=True,
    )  # fmt: skip
    assert process.stdout is not None
    address = next(line.strip() for line in process.stdout if line.startswith("http"))
    yield f"{address}/v1"
    process.kill()
    process.communicate()


@pytest.mark.slow
@pytest.mark.parametrize("mode", OutputMode)
def test_a_real_server_words_parses_proposes_and_reads(llama: str, mode: OutputMode) -> None:
    real = EndpointModel(llama, "qwen", mode=mode, environment={})
    wording = ModelWording(template=lambda *_, **__: questions.SMOKE, model=real, timeout_s=60)
    assert wording.improve(questions.SMOKE).query == questions.SMOKE.query
    assert len(wording.trials) == 1
    assert wording.trials[0].tokens > 0
    slang = "Hey, so the red box has got medicine that the injured person needs, would you be a dear"
    with suppress(InputError):
        assert parse_with_model(slang, real, timeout_s=60).subgoals
    heard = read_with_model("my uncle lies there", questions.ROOM, real, guarded=(Reply.NO,), timeout_s=60)
    assert heard.label in ("again", "read-back:yes", "read-back:no")
    answer = real.complete("Is Paris in France? Answer yes or no.", schema=AnswerReading, timeout_s=60)
    assert read_form(answer.text, AnswerReading) is not None or mode is OutputMode.PROMPTED
    with pytest.raises(DeviceError, match="did not answer within"):
        real.complete("Tell a long story.", schema=None, timeout_s=0.05)
