"""Laws of missions that give what they can, over worlds of Table 1 (method, section 9)."""

from __future__ import annotations

import pytest

from mintpilot.benchmark.records import TrialRecord
from mintpilot.core.mission import Outcome

from .small import experiment, here


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 8, 10, 11])
def test_asking_never_reaches_fewer_people_than_never_asking(seed: int) -> None:
    made = experiment("passive-conservative", "mint", trials=1, seed=seed)
    records = [record for record in here(made) if isinstance(record, TrialRecord)]
    never, asking = records
    assert asking.people_there == never.people_there > 0
    assert asking.people_found >= never.people_found
    if asking.outcome == Outcome.PARTIAL.value:
        assert 0 < asking.people_found < asking.people_there
        assert "Done: " in asking.reason
        assert "Left undone: " in asking.reason
        assert "the battery gives" in asking.reason
    if asking.outcome == Outcome.SUCCESS.value:
        assert asking.people_found == asking.people_there
