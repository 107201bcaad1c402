"""The figures of trust: what should be none is none in a few worlds, and the command says them."""

from __future__ import annotations

import json

import pytest

from mintpilot.benchmark.trust import measure_trust
from mintpilot.cli.main import main
from mintpilot.mission import belief_state


@pytest.mark.long
def test_a_few_worlds_have_no_pestering_and_keep_delta() -> None:
    rows = {row.name: row for row in measure_trust(3)}
    pestered = next(row for name, row in rows.items() if "asked twice" in name)
    assert (pestered.value, pestered.n) == (0, 3)
    assert all(row.value == 0 for name, row in rows.items() if "delta_c" in name)
    mean = next(row for name, row in rows.items() if "mean" in name)
    assert mean.value > 0
    assert mean.low is not None
    assert mean.low <= mean.value


@pytest.mark.long
def test_pestering_is_found_where_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the update as it was once, when an unsure answer withdrew the very query only."""
    monkeypatch.setattr(belief_state, "topics", lambda query: frozenset({query.id}))
    rows = measure_trust(6)
    assert next(row for row in rows if "asked twice" in row.name).value > 0


def test_the_command_prints_one_object(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "trust", "--trials", "1", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["rows"]) == 5
    assert main(["bench", "trust", "--trials", "0"]) == 2
