"""The terminal operator on real pipes and a real pseudo-terminal."""

from __future__ import annotations

import io
import os
import pty
import select
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console
from tests.language.questions import BOX, SMOKE

from mintpilot.assembly.talk import Talk
from mintpilot.core.errors import DeviceError, InputError
from mintpilot.core.query import Order, Question, Reply
from mintpilot.interaction.screen_words import screen_words
from mintpilot.interaction.terminal import TerminalOperator

from .test_scripted import question

ROOT = Path(__file__).parents[2]
ASKED = Question(
    query=question(("x", {"a"})).query, text="Can I fly through the \x1b[31mgrey smoke?", gaps=(),
    yes_means="I fly through it", no_means="I fly around it",
)  # fmt: skip


class Pipe:
    """The reading end of a pipe; what is written comes from the test."""

    def __init__(self) -> None:
        self.reads, self.writes = os.pipe()

    def fileno(self) -> int:
        return self.reads

    def say(self, data: bytes) -> None:
        os.write(self.writes, data)

    def end(self) -> None:
        os.close(self.writes)
        self.writes = -1


@pytest.fixture
def pipe() -> Iterator[Pipe]:
    made = Pipe()
    yield made
    os.close(made.reads)
    if made.writes >= 0:
        made.end()


def operator(pipe: Pipe) -> tuple[TerminalOperator, io.StringIO]:
    shown = io.StringIO()
    return TerminalOperator(Console(file=shown, width=100), pipe, understand=Talk().understand), shown


@pytest.mark.parametrize(
    ("typed", "reply"),
    [(b"y", Reply.YES), (b" YES!", Reply.YES), (b"n", Reply.NO), (b"No.", Reply.NO), (b"?", Reply.UNSURE),
     (b"unsure", Reply.UNSURE), ("don’t know".encode(), Reply.UNSURE), (b"I  don't know", Reply.UNSURE)],
)  # fmt: skip
def test_replies(pipe, typed, reply):
    asked, shown = operator(pipe)
    pipe.say(typed + b"\n")
    answer = asked.ask(ASKED, 5.0)
    assert answer.reply is reply
    assert answer.command is None
    assert 0 <= answer.latency_s < 5
    text = shown.getvalue()
    assert "I fly through it" in text
    assert "I fly around it" in text
    assert "\x1b" not in text


@pytest.mark.parametrize(
    ("typed", "command"),
    [(b"stop", Order.HOLD), (b"HOLD!", Order.HOLD), (b"abort", Order.ABORT), (b"return", Order.RETURN)],
)
def test_orders_are_obeyed_at_once(pipe, typed, command):
    asked, _ = operator(pipe)
    pipe.say(typed + b"\n")
    answer = asked.ask(ASKED, 5.0)
    assert answer.command is command
    assert answer.reply is not Reply.YES


def test_what_is_not_understood_is_asked_for_again(pipe):
    asked, shown = operator(pipe)
    pipe.say(b"\xff\xfe\x00\n\n\nyes\n")
    assert asked.ask(ASKED, 5.0).reply is Reply.YES
    assert shown.getvalue().count("Please say yes, no") == 1


def test_but_only_once(pipe):
    asked, shown = operator(pipe)
    pipe.say(b"yesno\nbananas\nyes\n")
    answer = asked.ask(ASKED, 5.0)
    assert (answer.reply, answer.text) == (Reply.UNSURE, "bananas")
    assert shown.getvalue().count("Please say yes, no") == 1


def test_what_is_understood_goes_with_the_answer(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"Not the red one, the blue one\n")
    answer = asked.ask(BOX, 5.0)
    assert (answer.reply, answer.understood_by) == (Reply.NO, "rules")
    assert [(cut.literals[0].values, yes) for cut, yes in answer.also] == [
        (frozenset({"box-1"}), False),
        (frozenset({"box-2", "box-3"}), True),
    ]


@pytest.mark.parametrize("typed", [b"well yes, you can, thanks", b"carry on", b"show me", b"okay"])
def test_what_would_have_to_be_read_back_is_asked_for_again(pipe, typed):
    asked, shown = operator(pipe)
    pipe.say(typed + b"\nn\n")
    assert asked.ask(SMOKE, 5.0).reply is Reply.NO
    assert shown.getvalue().count("Please say yes, no") == 1


class Later:
    """Better words that come when the test says so."""

    def __init__(self, words: Question | None = None) -> None:
        self.words, self.done = words, words is not None

    def wait(self, timeout_s: float) -> Question | None:
        return self.words


def test_better_words_are_shown_below_the_first_ones_with_the_consequences(pipe):
    asked, shown = operator(pipe)
    later = Later()

    def come() -> None:
        later.words, later.done = replace(ASKED, text="Is the smoke safe?\x1b[2J"), True
        threading.Timer(0.3, pipe.say, [b"y\n"]).start()

    threading.Timer(0.2, come).start()
    answer = asked.ask(ASKED, 20.0, later)
    first, _, second = shown.getvalue().partition("The same in other words:")
    assert "Can I fly through" in first
    assert "Your answer" in first
    for words in ("Is the smoke safe? [2J", "→ I fly through it", "→ I fly around it", "Your answer"):
        assert words in second
    assert answer.reply is Reply.YES
    assert answer.better_s is not None
    assert 0.1 < answer.better_s < answer.latency_s


def test_who_answers_before_the_better_words_come_is_heard_at_once(pipe):
    asked, shown = operator(pipe)
    pipe.say(b"n\n")
    answer = asked.ask(ASKED, 20.0, Later())
    assert (answer.reply, answer.better_s) == (Reply.NO, None)
    assert "other words" not in shown.getvalue()


@pytest.mark.parametrize(("lang", "yes"), [("de", "ja"), ("fr", "oui"), ("es", "sí"), ("en", "y")])
def test_the_screen_speaks_the_operators_language_and_hears_what_it_offers(pipe, lang, yes):
    shown, words = io.StringIO(), screen_words(lang)
    asked = TerminalOperator(Console(file=shown, width=200), pipe, understand=Talk(lang=lang).understand, lang=lang)
    for key, reply in ((yes, Reply.YES), (words.no.split()[0], Reply.NO), ("?", Reply.UNSURE)):
        pipe.say(f"xyzzy\n{key}\n".encode())
        assert asked.ask(ASKED, 5.0).reply is reply
    for offered in words.orders.partition(":")[2].partition(".")[0].split(","):
        pipe.say(f"{offered.strip()}\n".encode())
        assert asked.ask(ASKED, 5.0).command is not None
    for fixed in (words.asks, words.repeat, words.unsure_means, words.prompt):
        assert fixed in shown.getvalue()


def test_a_language_that_nobody_speaks_is_refused(pipe):
    with pytest.raises(InputError, match="unknown language 'dee'"):
        TerminalOperator(Console(file=io.StringIO()), pipe, understand=Talk().understand, lang="dee")


def test_no_better_words_are_not_shown(pipe):
    asked, shown = operator(pipe)
    later = Later()
    later.done = True
    threading.Timer(0.2, pipe.say, [b"y\n"]).start()
    assert asked.ask(ASKED, 20.0, later).better_s is None
    assert "other words" not in shown.getvalue()


def test_garbage_alone_ends_in_silence(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"hm hm hm\n")
    answer = asked.ask(ASKED, 0.2)
    assert answer.reply is Reply.TIMEOUT
    assert answer.latency_s >= 0.2


def test_silence_ends_and_half_a_word_is_no_answer_to_the_next_question(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"ye")
    assert asked.ask(ASKED, 0.1).reply is Reply.TIMEOUT
    pipe.say(b"s\n")
    assert asked.ask(ASKED, 0.1).reply is Reply.TIMEOUT


def test_an_endless_line_is_not_kept(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"y" * 60_000 + b"\n")
    assert asked.ask(ASKED, 0.5).reply is Reply.TIMEOUT


def test_lines_of_a_pipe_answer_one_question_each_and_its_end_is_silence(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"y\nn\n?")
    pipe.end()
    replies = [asked.ask(ASKED, 30.0).reply for _ in range(5)]
    assert replies == [Reply.YES, Reply.NO, Reply.UNSURE, Reply.TIMEOUT, Reply.TIMEOUT]


def test_messages_are_shown_without_control_codes(pipe):
    asked, shown = operator(pipe)
    asked.tell("[bold]new\x1b[2J thing")
    assert shown.getvalue() == "[bold]new [2J thing\n"


def test_a_closed_input_is_refused():
    with pytest.raises(DeviceError, match="scripted operator"):
        TerminalOperator(Console(file=io.StringIO()), io.StringIO(), understand=Talk().understand)


CHILD = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
from rich.console import Console
from tests.interaction.test_terminal import ASKED
from mintpilot.assembly.talk import Talk
from mintpilot.interaction.terminal import TerminalOperator
asked = TerminalOperator(Console(), sys.stdin, understand=Talk().understand)
print("ready", flush=True)
try:
    for _ in range(2):
        print("got", asked.ask(ASKED, 20.0).reply.value, flush=True)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


class Terminal:
    """A child process at a pseudo-terminal of its own."""

    def __init__(self) -> None:
        pid, self.fd = pty.fork()
        if pid == 0:
            os.execv(sys.executable, [sys.executable, "-c", CHILD])
        self.pid = pid
        self.seen = ""

    def expect(self, words: str, *, times: int = 1) -> None:
        end = time.monotonic() + 60
        while self.seen.count(words) < times:
            assert select.select([self.fd], [], [], max(0.0, end - time.monotonic()))[0], (
                f"no '{words}' in {self.seen!r}"
            )
            self.seen += os.read(self.fd, 4096).decode("utf-8", "replace")

    def type(self, keys: bytes) -> None:
        os.write(self.fd, keys)

    def leave(self) -> None:
        os.close(self.fd)
        os.waitpid(self.pid, 0)


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    made = Terminal()
    yield made
    made.leave()


def test_at_a_terminal_only_what_is_typed_after_the_question_answers_it(terminal):
    terminal.expect("Your answer")
    terminal.type(b"y\nn\nn\n")
    terminal.expect("got yes")
    terminal.expect("Your answer", times=2)
    terminal.type(b"?\n")
    terminal.expect("got unsure")
    assert "got no" not in terminal.seen


def test_ctrl_c_at_a_terminal_ends_the_wait_at_once(terminal):
    terminal.expect("Your answer")
    terminal.type(b"\x03")
    terminal.expect("interrupted")


def test_ctrl_d_at_a_terminal_is_silence(terminal):
    terminal.expect("Your answer")
    terminal.type(b"\x04")
    terminal.expect("got timeout", times=2)


def test_an_answer_that_comes_late_is_waited_for(pipe):
    asked, _ = operator(pipe)
    threading.Timer(0.15, pipe.say, [b"no\n"]).start()
    answer = asked.ask(ASKED, 10.0)
    assert answer.reply is Reply.NO
    assert answer.latency_s >= 0.1


def test_a_signal_while_waiting_does_not_hang(pipe):
    """Ctrl-C sent as a signal to a process that waits at a pipe."""
    process = subprocess.Popen([sys.executable, "-c", CHILD], stdin=pipe.fileno(), stdout=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stdout.readline() == b"ready\n"
    while b"Your answer" not in os.read(process.stdout.fileno(), 4096):
        pass
    process.send_signal(signal.SIGINT)
    assert b"interrupted" in process.communicate(timeout=60)[0]
