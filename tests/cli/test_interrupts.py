"""No wish to stop gets lost."""

import signal

import pytest

from mintpilot.cli import interrupts
from mintpilot.core.events import MissionEnded, Timed
from mintpilot.core.message import verbatim
from mintpilot.core.mission import Outcome, Verdict

EVENT = Timed(stage="survey", seconds=0.0)
END = MissionEnded(verdict=Verdict(outcome=Outcome.SUCCESS, reason=verbatim("done")))


@pytest.fixture
def listening():
    before = [(number, signal.getsignal(number)) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]
    interrupts.listen()
    yield
    for number, handler in before:
        signal.signal(number, handler)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupt_that_a_library_drops_counts_at_the_next_event(listening, number):
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(number)  # as if this were dropped by a destructor
    interrupts.stop_if_wanted(END)  # an end that is being recorded is not disturbed
    with pytest.raises(KeyboardInterrupt):
        interrupts.stop_if_wanted(EVENT)
    interrupts.stop_if_wanted(EVENT)  # once


def test_nothing_stops_where_nobody_wants_it(listening):
    interrupts.stop_if_wanted(EVENT)


def test_an_ignored_ctrl_c_stays_ignored(listening):
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    interrupts.listen()
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
