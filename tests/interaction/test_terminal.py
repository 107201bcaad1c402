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
from tests.driving import ask as put
from tests.language.questions import BOX
from tests.language.test_options import BOX as CHOICE

from mintpilot.assembly.talk import Talk
from mintpilot.core.errors import DeviceError, InputError
from mintpilot.core.query import NO_PART, YES_PART, Order, Question, Reply, Standing
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
    return TerminalOperator(
        Console(file=shown, width=100), pipe, understand=Talk().understand, order_of=Talk().order_of
    ), shown


@pytest.mark.parametrize(
    ("typed", "reply"),
    [(b"y", Reply.YES), (b" YES!", Reply.YES), (b"n", Reply.NO), (b"No.", Reply.NO), (b"?", Reply.UNSURE),
     (b"unsure", Reply.UNSURE), ("don’t know".encode(), Reply.UNSURE), (b"I  don't know", Reply.UNSURE)],
)  # fmt: skip
def test_replies(pipe, typed, reply):
    asked, shown = operator(pipe)
    pipe.say(typed + b"\n")
    answer = put(asked, ASKED, 5.0, real=True)
    assert answer.reply is reply
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
    answer = put(asked, ASKED, 5.0, real=True)
    assert answer is command


@pytest.mark.parametrize(
    ("typed", "option", "standing"),
    [(b"2", 1, Standing.PLAIN), (b"the second one", 1, Standing.PLAIN), (b"the red one", 0, Standing.UNCONFIRMED)],
)
def test_a_choice_is_answered_by_number_or_by_what_tells_the_thing(pipe, typed, option, standing):
    asked, shown = operator(pipe)
    pipe.say(b"yes\n" + typed + b"\n")
    answer = put(asked, CHOICE, 5.0, real=True)
    assert (answer.option, answer.standing) == (option, standing)
    text = shown.getvalue()
    assert "2  the large blue box" in text
    assert "give the number of an option" in text


def test_what_is_not_understood_is_asked_for_again(pipe):
    asked, shown = operator(pipe)
    pipe.say(b"\xff\xfe\x00\n\n\nyes\n")
    assert put(asked, ASKED, 5.0, real=True).reply is Reply.YES
    assert shown.getvalue().count("Please say yes, no") == 1


def test_but_only_once(pipe):
    asked, shown = operator(pipe)
    pipe.say(b"yesno\nbananas\nyes\n")
    answer = put(asked, ASKED, 5.0, real=True)
    assert (answer.reply, answer.text) == (Reply.UNSURE, "bananas")
    assert shown.getvalue().count("Please say yes, no") == 1


def test_what_is_understood_goes_with_the_answer(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"Not the red one, the blue one\n")
    answer = put(asked, BOX, 5.0, real=True)
    assert (answer.reply, answer.understood_by) == (Reply.NO, "rules")
    said = [(x.query.literals[0].values, x.part) for x in answer.also]
    assert said == [(frozenset({"box-1"}), NO_PART), (frozenset({"box-3", "box-2"}), YES_PART)]
    assert answer.standing is Standing.UNCONFIRMED, "what it leaves is read back before it counts"


class Later:
    """Better words that come when the test says so."""

    def __init__(self) -> None:
        self.words: Question | None = None

    def __call__(self, waited_s: float) -> Question | None:
        words, self.words = self.words, None
        return words


def test_better_words_are_shown_below_the_first_ones_with_the_consequences(pipe):
    asked, shown = operator(pipe)
    later = Later()

    def come() -> None:
        later.words = replace(ASKED, text="Is the smoke safe?\x1b[2J")
        threading.Timer(0.3, pipe.say, [b"y\n"]).start()

    threading.Timer(0.2, come).start()
    answer = put(asked, ASKED, 20.0, better=later, real=True)
    first, _, second = shown.getvalue().partition("The same in other words:")
    assert "Can I fly through" in first
    assert "Your answer" in first
    for words in ("Is the smoke safe? [2J", "→ I fly through it", "→ I fly around it", "Your answer"):
        assert words in second
    assert answer.reply is Reply.YES


def test_who_answers_before_the_better_words_come_is_heard_at_once(pipe):
    asked, shown = operator(pipe)
    pipe.say(b"n\n")
    answer = put(asked, ASKED, 20.0, better=Later(), real=True)
    assert answer.reply is Reply.NO
    assert "other words" not in shown.getvalue()


@pytest.mark.parametrize(("lang", "yes"), [("de", "ja"), ("fr", "oui"), ("es", "sí"), ("en", "y")])
def test_the_screen_speaks_the_operators_language_and_hears_what_it_offers(pipe, lang, yes):
    shown, words = io.StringIO(), screen_words(lang)
    talk = Talk(lang=lang)
    console = Console(file=shown, width=200)
    asked = TerminalOperator(console, pipe, understand=talk.understand, order_of=talk.order_of, lang=lang)
    for key, reply in ((yes, Reply.YES), (words.no.split()[0], Reply.NO), ("?", Reply.UNSURE)):
        pipe.say(f"xyzzy\n{key}\n".encode())
        assert put(asked, ASKED, 5.0, real=True).reply is reply
    for offered in words.orders.partition(":")[2].partition(".")[0].split(","):
        pipe.say(f"{offered.strip()}\n".encode())
        assert isinstance(put(asked, ASKED, 5.0, real=True), Order)
    for fixed in (words.asks, words.repeat, words.unsure_means, words.prompt):
        assert fixed in shown.getvalue()


def test_a_language_that_nobody_speaks_is_refused(pipe):
    with pytest.raises(InputError, match="unknown language 'dee'"):
        TerminalOperator(
            Console(file=io.StringIO()), pipe, understand=Talk().understand, order_of=Talk().order_of, lang="dee"
        )


def test_orders_are_heard_while_nothing_is_asked_and_other_lines_are_not(pipe):
    asked, shown = operator(pipe)
    pipe.say(b"hold\n\ncontinue\n")
    orders = [event.order for event in asked.poll(4.0)]
    assert orders == [Order.HOLD, Order.CONTINUE]
    pipe.say(b"yes\n")
    assert asked.poll(5.0) == ()
    assert "asked now" not in shown.getvalue()
    assert put(asked, ASKED, 5.0, real=True).reply is Reply.YES, "a line of a pipe is kept for the next question"


def test_a_question_that_was_answered_elsewhere_is_withdrawn(pipe):
    asked, shown = operator(pipe)
    asked.show(replace(ASKED, id="q1"), 5.0)
    assert [type(event).__name__ for event in asked.poll(0.0)] == ["QuestionShown"]
    asked.withdraw("q0", "another one")
    asked.withdraw("q1", "it was answered")
    assert shown.getvalue().count("it was answered") == 1


def test_garbage_alone_ends_in_silence(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"hm hm hm\n")
    answer = put(asked, ASKED, 0.2, real=True)
    assert answer.reply is Reply.TIMEOUT
    assert answer.latency_s >= 0.2


def test_silence_ends_and_half_a_word_is_no_answer_to_the_next_question(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"ye")
    assert put(asked, ASKED, 0.1, real=True).reply is Reply.TIMEOUT
    pipe.say(b"s\n")
    assert put(asked, ASKED, 0.1, real=True).reply is Reply.TIMEOUT


def test_an_endless_line_is_not_kept(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"y" * 60_000 + b"\n")
    assert put(asked, ASKED, 0.5, real=True).reply is Reply.TIMEOUT


@pytest.mark.long
def test_lines_of_a_pipe_answer_one_question_each_and_its_end_is_silence(pipe):
    asked, _ = operator(pipe)
    pipe.say(b"y\nn\n?")
    pipe.end()
    replies = [put(asked, ASKED, 1.0, real=True).reply for _ in range(5)]
    assert replies == [Reply.YES, Reply.NO, Reply.UNSURE, Reply.TIMEOUT, Reply.TIMEOUT]


def test_messages_are_shown_without_control_codes(pipe):
    asked, shown = operator(pipe)
    asked.tell("[bold]new\x1b[2J thing")
    assert shown.getvalue() == "[bold]new [2J thing\n"


def test_a_closed_input_is_refused():
    with pytest.raises(DeviceError, match="scripted operator"):
        TerminalOperator(
            Console(file=io.StringIO()), io.StringIO(), understand=Talk().understand, order_of=Talk().order_of
        )


CHILD = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
from rich.console import Console
from tests.driving import ask as put
from tests.interaction.test_terminal import ASKED
from mintpilot.assembly.talk import Talk
from mintpilot.interaction.terminal import TerminalOperator
asked = TerminalOperator(Console(), sys.stdin, understand=Talk().understand, order_of=Talk().order_of)
print("ready", flush=True)
try:
    for _ in range(2):
        print("got", put(asked, ASKED, 5.0, real=True).reply.value, flush=True)
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


@pytest.mark.long
def test_at_a_terminal_only_what_is_typed_after_the_question_answers_it(terminal):
    terminal.expect("Your answer")
    terminal.type(b"y\nn\nn\n")
    terminal.expect("got yes")
    terminal.expect("The drone asks", times=2)
    terminal.expect("5 s  Your answer", times=2)
    terminal.type(b"?\n")
    terminal.expect("got unsure")
    assert "got no" not in terminal.seen


@pytest.mark.long
def test_at_a_terminal_a_letter_answers_alone_and_not_while_more_is_typed(terminal):
    terminal.expect("Your answer")
    terminal.type(b"y")
    terminal.expect("got yes")
    terminal.expect("The drone asks", times=2)
    terminal.expect("5 s  Your answer", times=2)
    terminal.type(b"n")
    time.sleep(0.1)
    terminal.type(b"\x7fye")
    time.sleep(0.8)
    assert "got" not in terminal.seen.partition("got yes")[2], "two letters wait for Enter"
    terminal.type(b"\x15?")
    terminal.expect("got unsure")
    assert terminal.seen.count("4 s  Your answer") >= 1, "the seconds that are left are counted down"


@pytest.mark.long
def test_at_a_terminal_ctrl_d_is_answered(terminal):
    terminal.expect("Your answer")
    terminal.type(b"\x04")
    terminal.expect("nobody answers here any more")
    terminal.expect("got timeout")


@pytest.mark.long
def test_a_letter_that_answers_nothing_waits_for_the_rest_of_its_word(terminal):
    terminal.expect("Your answer")
    terminal.type(b"w")
    time.sleep(0.8)
    terminal.type(b"ait\n")
    time.sleep(0.2)
    terminal.type(b"no\n")
    terminal.expect("got no")
    assert "do not understand" not in terminal.seen


class FewNotes:
    """A map and a reason."""

    def draw(self, question: Question) -> tuple[Path, ...]:
        return (Path("runs/1/questions/q-1-map.png"),)

    def why(self, question: Question) -> tuple[str, ...]:
        return ("The best plan takes 16.0 s or 18.3 s.",)


@pytest.mark.parametrize(("back", "told"), [(b"show", "q-1-map.png"), (b"why", "16.0 s or 18.3 s")])
def test_questions_back_are_answered_and_the_question_stays_open(pipe, back, told):
    shown, talk = io.StringIO(), Talk()
    console = Console(file=shown, width=80)
    asked = TerminalOperator(console, pipe, understand=talk.understand, order_of=talk.order_of, notes=FewNotes())
    pipe.say(back + b"\nno\n")
    assert put(asked, ASKED, 5.0, real=True).reply is Reply.NO
    assert told in shown.getvalue()
    bare, quiet = operator(pipe)
    pipe.say(back + b"\nno\n")
    assert put(bare, ASKED, 5.0, real=True).reply is Reply.NO
    assert "Nothing more is known" in quiet.getvalue()


@pytest.mark.long
def test_ctrl_c_at_a_terminal_ends_the_wait_at_once(terminal):
    terminal.expect("Your answer")
    terminal.type(b"\x03")
    terminal.expect("interrupted")


@pytest.mark.long
def test_ctrl_d_at_a_terminal_is_silence(terminal):
    terminal.expect("Your answer")
    terminal.type(b"\x04")
    terminal.expect("got timeout", times=2)


def test_an_answer_that_comes_late_is_waited_for(pipe):
    asked, _ = operator(pipe)
    threading.Timer(0.15, pipe.say, [b"no\n"]).start()
    answer = put(asked, ASKED, 10.0, real=True)
    assert answer.reply is Reply.NO
    assert answer.latency_s >= 0.1


@pytest.mark.long
def test_a_signal_while_waiting_does_not_hang(pipe):
    """Ctrl-C sent as a signal to a process that waits at a pipe."""
    process = subprocess.Popen([sys.executable, "-c", CHILD], stdin=pipe.fileno(), stdout=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stdout.readline() == b"ready\n"
    while b"Your answer" not in os.read(process.stdout.fileno(), 4096):
        pass
    process.send_signal(signal.SIGINT)
    assert b"interrupted" in process.communicate(timeout=60)[0]
