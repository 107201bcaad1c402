"""Confidences of namers made true by counting."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.core.errors import InputError
from mintpilot.core.observation import Frame, NameGuess, Segment
from mintpilot.core.ports import Namer
from mintpilot.perception.calibration import (
    LEAST_PAIRS,
    MOST_CERTAIN,
    CalibratedNamer,
    Calibration,
    LabelScale,
    fit,
    read_calibration,
)


class Says(Namer):
    def __init__(self, **said: float) -> None:
        self._said = tuple(NameGuess(label=label, probability=p) for label, p in said.items())

    def names(self, frame: Frame, segments: list[Segment]) -> tuple[tuple[NameGuess, ...], ...]:  # type: ignore[override]
        return (self._said,)


def said_by(namer: Namer) -> dict[str, float]:
    (guesses,) = namer.names(None, [None])  # type: ignore[arg-type,list-item]
    return {g.label: g.probability for g in guesses}


def test_an_overconfident_namer_is_brought_down_and_a_timid_one_up() -> None:
    rng = np.random.default_rng(2)
    said = rng.uniform(0.2, 0.95, 4000)
    for bend in (0.5, 1.8):
        right = rng.random(4000) < said**bend
        scale = fit(said.tolist(), right.tolist())
        assert scale is not None
        for p in (0.4, 0.6, 0.8):
            near = np.abs(said - p) < 0.05
            got = said_by(CalibratedNamer(Says(can=p), {"can": scale}))["can"]
            assert got == pytest.approx(float(right[near].mean()), abs=0.07)


def test_few_examples_change_nothing_and_names_without_a_measurement_stay() -> None:
    assert fit([0.5] * (LEAST_PAIRS - 1), [True] * (LEAST_PAIRS - 1)) is None
    scales = {"can": LabelScale(scale=1.0, shift=-5.0, examples=30)}
    got = said_by(CalibratedNamer(Says(can=0.5, box=0.3), scales))
    assert got["box"] == 0.3
    assert got["can"] < 0.02


def test_what_was_found_in_drawn_rooms_takes_certainty_away_and_never_gives_any() -> None:
    scales = {
        "person": LabelScale(scale=1.5, shift=2.8, examples=370),
        "bowl": LabelScale(scale=1.0, shift=-2.0, examples=60),
    }
    said = said_by(CalibratedNamer(Says(person=0.17, bowl=0.35), scales, only_lowers=True))
    assert said["person"] == pytest.approx(0.17)
    assert said["bowl"] < 0.1


def test_what_was_never_wrong_is_not_certain() -> None:
    scale = fit([0.6] * 400, [True] * 400)
    assert scale is not None
    assert said_by(CalibratedNamer(Says(person=0.6), {"person": scale}))["person"] == MOST_CERTAIN
    assert said_by(CalibratedNamer(Says(person=0.97), {"person": scale}))["person"] == 0.97


@given(
    st.dictionaries(st.sampled_from("abc"), st.floats(0, 1), min_size=1),
    st.floats(0.05, 20),
    st.floats(-20, 20),
)
def test_names_stay_a_distribution_whatever_the_scale(said: dict[str, float], scale: float, shift: float) -> None:
    scales = {label: LabelScale(scale=scale, shift=shift, examples=30) for label in "ab"}
    got = said_by(CalibratedNamer(Says(**said), scales))
    assert got.keys() == said.keys()
    assert all(0 <= p <= 1 for p in got.values())
    assert sum(got.values()) <= 1.0 + 1e-9


def test_a_file_is_read_back_and_a_broken_one_is_named(tmp_path: Path) -> None:
    made = Calibration(namers={"geometry": {"can": LabelScale(scale=2.0, shift=0.5, examples=40)}})
    path = tmp_path / "mine.json"
    path.write_text(made.model_dump_json())
    assert read_calibration(path) == made
    for broken in ("", "{}", '{"namers": {"geometry": {"can": {"scale": -1, "shift": 0, "examples": 1}}}}'):
        path.write_text(broken)
        with pytest.raises(InputError, match="bench perception --calibrate"):
            read_calibration(path)
