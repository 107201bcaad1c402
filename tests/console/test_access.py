"""Tokens, addresses and rates."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.console.access import Address, Rate, Role, Tokens
from mintpilot.core.errors import InputError


def test_each_token_opens_its_role_only():
    tokens = Tokens()
    assert tokens.role(tokens.answer) is Role.ANSWER
    assert tokens.role(tokens.watch) is Role.WATCH
    assert tokens.answer not in repr(tokens)
    assert tokens.watch not in repr(tokens)


@given(st.text(max_size=40))
def test_nothing_else_opens_anything(guess):
    assert Tokens(answer="a" * 22, watch="w" * 22).role(guess) is None


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.7", "::", "console.example"])
def test_other_machines_need_tls(host, tmp_path):
    with pytest.raises(InputError, match="--tls-cert"):
        Address(host=host)
    pem = tmp_path / "pair.pem"
    pem.write_text("x")
    assert not Address(host=host, tls_cert=pem, tls_key=pem).is_local


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "127.0.0.9"])
def test_this_machine_does_not(host):
    assert Address(host=host).is_local


def test_half_a_pair_and_missing_files_are_refused(tmp_path):
    with pytest.raises(InputError, match="both"):
        Address(tls_cert=tmp_path / "cert.pem")
    with pytest.raises(InputError, match="no file"):
        Address(tls_cert=tmp_path / "cert.pem", tls_key=tmp_path / "key.pem")


def test_origins_are_those_of_the_page():
    assert "http://127.0.0.1:8800" in Address().origins(8800)
    assert "http://127.0.0.1:8801" not in Address().origins(8800)
    assert "https://127.0.0.1:8800" not in Address().origins(8800)
    assert "[::1]:8800" in Address(host="::1").hosts(8800)


def test_a_rate_allows_a_burst_and_then_so_many_a_second():
    now = [0.0]
    rate = Rate(burst=3, per_second=2.0, clock=lambda: now[0])
    assert [rate.allows() for _ in range(4)] == [True, True, True, False]
    now[0] = 1.0
    assert [rate.allows() for _ in range(3)] == [True, True, False]
