"""No flight sets out into a region that it cannot leave before the yes for it runs out (method, section 12)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from mintpilot.assembly.api import run_mission
from mintpilot.core.events import Asked, Event, LegFlown, Noticed

EXAMPLE = Path("examples/my-building")
BAND_M = (5.5, 9.0)
"""The region reaches from wall to wall, between these x."""


def flown(folder: Path, valid_s: float) -> list[Event]:
    """The example, with one region across the whole building and nothing to do but to cross it."""
    text = yaml.safe_load((EXAMPLE / "mission.yaml").read_text(encoding="utf-8"))
    text["instruction"] = "Go to the red box."
    text["goals"] = [{"action": "go", "phrase": "the red box", "label": "box", "truth": "box-red"}]
    text["seeks_people"] = False
    world = text["world"]
    world["map"] = str((EXAMPLE / "building.yaml").resolve())
    world["rooms"] = []
    lo, hi = BAND_M
    world["regions"][0]["polygon"] = [[lo, -0.9], [hi, -0.9], [hi, 20.0], [lo, 20.0]]
    text["asking"] = {"delta_c_s": 0.5, "answer_valid_s": valid_s}
    file = folder / "mission.yaml"
    file.write_text(yaml.safe_dump(text), encoding="utf-8")
    events: list[Event] = []
    run_mission(file, operator="scripted", vehicle="kinematic", think=2.0, progress=events.append)
    return events


@pytest.mark.long
@pytest.mark.parametrize(("valid_s", "crosses"), [(4.0, False), (5.0, False), (7.0, True), (30.0, True), (600.0, True)])
def test_a_yes_must_last_until_the_drone_is_through(tmp_path: Path, valid_s: float, crosses: bool) -> None:
    events = flown(tmp_path, valid_s)
    assert any(isinstance(event, Asked) for event in events)
    x_m = np.concatenate([event.log.position_m[:, 0] for event in events if isinstance(event, LegFlown)])
    inside = (x_m > BAND_M[0]) & (x_m < BAND_M[1])
    assert bool(inside.any()) is crosses
    rests_m = [event.log.position_m[-1, 0] for event in events if isinstance(event, LegFlown)]
    assert not any(BAND_M[0] < x < BAND_M[1] for x in rests_m), "it never stops in there because its yes ran out"
    told = [str(event.text) for event in events if isinstance(event, Noticed) and event.kind == "permission"]
    assert crosses or any("keeps out" in text for text in told)
