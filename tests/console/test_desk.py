"""Who answers: one seat, taken over explicitly; watchers can do nothing."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from mintpilot.console.access import Role
from mintpilot.console.desk import Client, Desk
from mintpilot.console.protocol import LeaveSeat, Ordering, Replied, TakeSeat
from mintpilot.core.query import Order


def client(name: str, role: Role = Role.ANSWER) -> Client:
    return Client(browser=name * 8, role=role, address="127.0.0.1")


def yes(n: int) -> Replied:
    return Replied(n=n, question="q1", reply="yes")


def test_the_first_that_may_answer_has_the_seat_and_a_second_takes_it_over():
    desk, first, second = Desk(), client("a"), client("b")
    desk.enter(first)
    desk.enter(second)
    assert desk.seat(first).seated
    assert not desk.seat(second).seated
    assert not desk.take(second, yes(1))
    assert desk.take(second, TakeSeat(n=1))
    assert not desk.seat(first).seated
    assert desk.take(second, yes(2))
    assert not desk.take(first, yes(1))
    assert [asked.who for asked in desk.collect()] == ["console:bbbbbbbb@127.0.0.1"]


def test_the_seat_waits_for_a_browser_that_reloads():
    desk, first, second = Desk(), client("a"), client("b")
    desk.enter(first)
    desk.enter(second)
    desk.leave(first)
    assert not desk.seat(second).seated
    assert not desk.seat(second).taken
    again = client("a")
    desk.enter(again)
    assert desk.seat(again).seated


def test_a_watcher_can_do_nothing():
    desk, watcher = Desk(), client("w", Role.WATCH)
    desk.enter(watcher)
    assert not desk.wait(0.0)
    for command in (yes(1), Ordering(n=2, order=Order.ABORT), TakeSeat(n=3), LeaveSeat(n=4)):
        assert not desk.take(watcher, command)
    assert desk.collect() == ()
    assert not desk.seat(watcher).seated


def test_orders_need_no_seat():
    desk, first, second = Desk(), client("a"), client("b")
    desk.enter(first)
    desk.enter(second)
    assert desk.take(second, Ordering(n=1, order=Order.HOLD))
    assert len(desk.collect()) == 1


def test_what_comes_again_is_done_once():
    desk, first = Desk(), client("a")
    desk.enter(first)
    assert all(desk.take(first, yes(1)) for _ in range(3))
    assert len(desk.collect()) == 1


@given(st.lists(st.tuples(st.sampled_from("abc"), st.booleans()), max_size=30))
def test_at_most_one_browser_is_seated(moves):
    desk = Desk()
    clients = {name: client(name) for name in "abc"}
    for one in clients.values():
        desk.enter(one)
    for n, (name, takes) in enumerate(moves, 1):
        desk.take(clients[name], TakeSeat(n=n) if takes else LeaveSeat(n=n))
        assert sum(desk.seat(one).seated for one in clients.values()) <= 1
        assert desk.seat(clients[name]).seated is takes
