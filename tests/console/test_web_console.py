"""The real server over real sockets, without a browser."""

from __future__ import annotations

import http.client
import json
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from urllib.parse import urlsplit

import numpy as np
import pytest
from tests.language.questions import SMOKE
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from mintpilot.assembly.talk import Talk
from mintpilot.conformance import check_operator
from mintpilot.console import Address, Role, WebConsole
from mintpilot.core.errors import DeviceError
from mintpilot.core.events import ViewTaken
from mintpilot.core.inputs import Answered, Ordered, QuestionShown
from mintpilot.core.observation import CameraModel, Frame
from mintpilot.core.query import Order, Reply

ASKED = replace(SMOKE, id="q1")


def made() -> WebConsole:
    talk = Talk()
    return WebConsole(understand=talk.understand, order_of=talk.order_of)


@pytest.fixture
def console() -> Iterator[WebConsole]:
    with made() as one:
        yield one


@contextmanager
def link(
    console: WebConsole, role: Role | None = Role.ANSWER, *, browser: str = "a" * 16, **options
) -> Iterator[ClientConnection]:
    url = urlsplit(console.url(role or Role.ANSWER))
    origin = options.pop("origin", f"http://{url.netloc}")
    token = url.fragment if role is not None else "x" * 22
    with connect(f"ws://{url.netloc}/live", origin=origin, max_size=None, **options) as opened:
        opened.send(json.dumps({"kind": "hello", "token": token, "browser": browser}))
        yield opened


def until(opened: ClientConnection, found, most: int = 500):
    """The first message that fits; pictures are passed over."""
    for _ in range(most):
        message = opened.recv(timeout=10)
        if isinstance(message, str) and found(said := json.loads(message)):
            return said
    raise AssertionError("it never came")


def pane(opened: ClientConnection, name: str, fits=lambda data: True):
    return until(opened, lambda m: m.get("pane") == name and fits(m["data"]))["data"]


def polled(console: WebConsole, kind: type, time_s: float = 1.0):
    for _ in range(500):
        for event in console.poll(time_s):
            if isinstance(event, kind):
                return event
        time.sleep(0.01)
    raise AssertionError(f"no {kind.__name__} came")


def test_sound_of_the_browser_that_answers_is_taken_and_a_flood_of_it_ends_the_link(console: WebConsole):
    with link(console) as browser, link(console, Role.WATCH, browser="b" * 16) as watcher:
        until(browser, lambda m: m.get("pane") == "seat" and m["data"]["seated"])
        browser.send(json.dumps({"kind": "microphone", "n": 1, "on": True}))
        assert until(browser, lambda m: m.get("ack") == 1)["taken"]
        console.microphone.collect()
        watcher.send(b"\x02" * 640)
        browser.send(b"\x01" * 640)
        for _ in range(500):
            if came := console.microphone.collect():
                break
            time.sleep(0.01)
        assert came == b"\x01" * 640
        with suppress(ConnectionClosed):
            for _ in range(2000):
                browser.send(bytes(3200))
        with pytest.raises(ConnectionClosed) as ended:
            until(browser, lambda _: False)
        assert ended.value.rcvd is None or ended.value.rcvd.code == 4429


@pytest.mark.parametrize("size", [4097, 100_000])
def test_a_message_of_sound_that_is_too_long_ends_the_link(console: WebConsole, size: int):
    with link(console) as browser:
        browser.send(bytes(size))
        with pytest.raises(ConnectionClosed):
            until(browser, lambda _: False)


def test_it_keeps_the_contract_of_operators():
    consoles: list[WebConsole] = []

    def make() -> WebConsole:
        consoles.append(made())
        return consoles[-1]

    try:
        check_operator(make)
    finally:
        for one in consoles:
            one.close()


def test_a_question_is_answered(console):
    with link(console) as opened:
        console.show(ASKED, 30.0)
        card = pane(opened, "question", lambda d: d["id"] == "q1")
        assert card["text"] == ASKED.text
        opened.send(json.dumps({"kind": "seen", "n": 1, "question": "q1"}))
        assert polled(console, QuestionShown).question == "q1"
        opened.send(json.dumps({"kind": "reply", "n": 2, "question": "q1", "reply": "no"}))
        assert until(opened, lambda m: m.get("ack") == 2)["taken"]
        answered = polled(console, Answered)
        assert answered.answer.reply is Reply.NO
        assert answered.operator == "console:aaaaaaaa@127.0.0.1"
        console.withdraw("q1", "it was answered")
        assert pane(opened, "question", lambda d: not d["id"])["closed"] == "it was answered"


def test_who_comes_later_gets_the_open_question(console):
    console.show(ASKED, 30.0)
    for browser in ("a" * 16, "b" * 16):
        with link(console, browser=browser) as opened:
            assert pane(opened, "question", lambda d: d["id"] == "q1")


def test_a_command_that_comes_again_after_a_broken_link_counts_once(console):
    console.show(ASKED, 30.0)
    said = json.dumps({"kind": "order", "n": 7, "order": "hold"})
    for _ in range(2):
        with link(console) as opened:
            opened.send(said)
            assert until(opened, lambda m: m.get("ack") == 7)["taken"]
    assert polled(console, Ordered).order is Order.HOLD
    assert console.poll(2.0) == ()


def test_a_watcher_sees_and_can_do_nothing(console):
    with link(console, Role.WATCH) as opened:
        assert not pane(opened, "seat")["may_answer"]
        console.show(ASKED, 30.0)
        assert pane(opened, "question", lambda d: d["id"] == "q1")
        for n, said in enumerate(
            ({"kind": "reply", "question": "q1", "reply": "yes"}, {"kind": "order", "order": "land"},
             {"kind": "take-seat"}, {"kind": "say", "text": "land"}), 1,
        ):  # fmt: skip
            opened.send(json.dumps({**said, "n": n}))
            assert not until(opened, lambda m, n=n: m.get("ack") == n)["taken"]
    assert console.poll(1.0) == ()


def closed_with(opened: ClientConnection) -> int:
    try:
        for _ in range(300):
            opened.recv(timeout=10)
    except ConnectionClosed as error:
        return error.rcvd.code if error.rcvd is not None else 0
    raise AssertionError("the link was not closed")


def test_a_wrong_token_opens_nothing(console):
    with link(console, None) as opened:
        assert closed_with(opened) == 4401
    assert not console.wait_for_somebody(0.0)


@pytest.mark.parametrize("origin", ["http://evil.example", "null", None, "https://127.0.0.1"])
def test_pages_of_other_origins_are_refused(console, origin):
    with pytest.raises(InvalidStatus, match="403"), link(console, origin=origin):
        pass


@pytest.mark.long
@pytest.mark.parametrize(
    "said",
    ["", "[]", '{"kind":"reply"}', '{"kind":"order","n":1,"order":"explode"}',
     '{"kind":"order","n":1,"order":"hold","x":1}',
     '{"kind":"say","n":1,"text":"' + "a" * 401 + '"}', '{"kind":"reply","n":0,"question":"q1","reply":"yes"}'],
)  # fmt: skip
def test_malformed_messages_end_the_link_and_nothing_else(console, said):
    with link(console) as opened:
        pane(opened, "seat")
        opened.send(said)
        assert closed_with(opened) == 4401
    assert console.poll(1.0) == ()
    with link(console) as opened:
        assert pane(opened, "seat")["may_answer"]


def test_messages_that_are_too_long_or_too_many_end_the_link(console):
    with link(console) as opened:
        pane(opened, "seat")
        opened.send(json.dumps({"kind": "say", "n": 1, "text": "a" * 9000}))
        assert closed_with(opened) == 1009
    with link(console) as opened:
        for n in range(1, 60):
            with suppress(ConnectionClosed):  # it may have had enough before all are sent
                opened.send(json.dumps({"kind": "more-time", "n": n, "question": "q1"}))
        assert closed_with(opened) == 4429


@pytest.mark.long
def test_a_browser_that_reads_nothing_holds_nobody_up(console):
    with link(console, browser="d" * 16, max_queue=1), link(console) as opened:
        for _ in range(3000):
            console.tell("a long story " * 20)
        console.show(ASKED, 30.0)
        assert pane(opened, "question", lambda d: d["id"] == "q1")


@pytest.mark.long
def test_a_slow_browser_loses_pictures_and_no_question(console):
    """It reads after three hundred pictures: some of them are gone, and the question is there."""
    lens = CameraModel(width=320, height=240, fx=277.0, fy=277.0, cx=160.0, cy=120.0)
    noise = np.random.default_rng(0).integers(0, 255, (240, 320, 3), np.uint8)
    with link(console, max_queue=1) as opened:
        pane(opened, "seat")
        for number in range(300):
            frame = Frame(
                time_s=number / 5, rgb=noise, depth_m=np.ones((240, 320), np.float32), camera=lens,
                world_from_camera=np.eye(4),
            )  # fmt: skip
            console.record(ViewTaken(frame=frame))
            time.sleep(0.005)
        console.show(replace(ASKED, id="q9"), 30.0)
        pictures, asked = 0, False
        while not asked:
            message = opened.recv(timeout=10)
            pictures += isinstance(message, bytes)
            asked = isinstance(message, str) and json.loads(message).get("data", {}).get("id") == "q9"
        assert 1 <= pictures < 300


def fetched(console: WebConsole, path: str, **headers: str) -> http.client.HTTPResponse:
    url = urlsplit(console.url())
    asked = http.client.HTTPConnection(url.hostname or "", url.port, timeout=10)
    try:
        asked.request("GET", path, headers=headers)
        answer = asked.getresponse()
        answer.body = answer.read()  # type: ignore[attr-defined]
        return answer
    finally:
        asked.close()


def test_the_page_is_served_with_a_strict_policy(console):
    for path in ("/", "/static/app.js", "/static/app.css"):
        answer = fetched(console, path)
        assert answer.status == 200
        policy = answer.headers["content-security-policy"]
        assert policy.startswith("default-src 'none'")
        assert "unsafe" not in policy
        assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize(
    "path", ["/static/../server.py", "/static/%2e%2e%2fserver.py", "/server.py", "/docs", "/openapi.json"]
)
def test_nothing_else_is_served(console, path):
    assert fetched(console, path).status == 404


def test_other_host_names_are_refused(console):
    assert fetched(console, "/", Host="evil.example").status == 421


def test_the_page_is_small(console):
    from importlib.resources import files

    shipped = files("mintpilot.console").joinpath("static").iterdir()
    assert sum(len(file.read_bytes()) for file in shipped) < 100_000


def test_a_taken_port_is_told_with_the_next_step(console):
    port = urlsplit(console.url()).port or 0
    talk = Talk()
    with pytest.raises(DeviceError, match="--port"):
        WebConsole(understand=talk.understand, order_of=talk.order_of, address=Address(port=port))


def test_after_its_end_it_says_so_and_closing_again_is_safe():
    console = made()
    console.close()
    console.close()
    with pytest.raises(DeviceError, match="serves no more"):
        console.poll(1.0)
