"""The experiments: which worlds, which conditions, which methods. Fixed before the first run; nothing fits the paper.

Worlds are those of the scenario generators with their defaults (`mintpilot.simulation.scenarios`), which follow the
paper's description. Prices: a question counts as 10 s of flight, a failure as 600 s (the default of `AskingSettings`).
The scripted person thinks for 3 s about each question; that is stated, not waited for.
"""

from __future__ import annotations

import platform
from collections.abc import Sequence
from importlib import metadata
from typing import Literal

from mintpilot.assembly.registry import load
from mintpilot.assembly.talk import TEMPLATE
from mintpilot.benchmark.calibration import calibrated
from mintpilot.benchmark.experiment import Cell, Condition, Experiment
from mintpilot.benchmark.methods import Method, method_of
from mintpilot.core.errors import InputError

TABLE1 = (
    "passive-conservative",
    "passive-risky",
    "passive-mixture",
    "exhaustive",
    "mint",
    "mint-paper",
    "optimal",
)
"""The paper's Exhaustive and MINT, MINT by both rules, the two stances of its 'Pure LLM' and a mixture of them, and the
exact yardstick."""
BOXES = ("passive-conservative", "passive-mixture", "mint")
GAPS = (
    "passive-conservative",
    "exhaustive",
    "entropy-threshold",
    "knowno",
    "gap-by-gap",
    "random",
    "information-gain",
    "ec2",
    "value-of-information",
    "optimal",
)
"""`information-gain` is `mint` with its defaults."""
MOST_GAPS = 8
CONDITIONS: tuple[tuple[str, Condition], ...] = (
    ("5 % wrong answers", Condition(answer_error=0.05)),
    ("10 % wrong answers", Condition(answer_error=0.10)),
    ("20 % wrong answers", Condition(answer_error=0.20)),
    ("10 % wrong answers, believed right", Condition(answer_error=0.10, believed_error=0.0)),
    ("20 % unsure", Condition(unsure_rate=0.2)),
    ("prior of safe smoke and occupied rooms 0.2", Condition(believed_passable=0.2, believed_occupied=0.2)),
    ("prior of safe smoke and occupied rooms 0.8", Condition(believed_passable=0.8, believed_occupied=0.8)),
    ("detections 0.5 m off", Condition(misplaced_m=0.5)),
)
"""What is varied at four gaps; the drone believes what is true unless the name says otherwise. True priors are 0.5."""
Vehicle = Literal["kinematic", "mujoco"]


def table1(
    *,
    trials: int,
    seed: int,
    vehicle: Vehicle,
    strategies: Sequence[str] = (),
    llm: str = TEMPLATE,
    time_limit_s: float | None = None,
) -> Experiment:
    """The paper's Table 1: one cloud of smoke and one closed room in a warehouse on fire.

    Raises:
        UnknownNameError: one of the strategies, or the language model, is not known.
        InputError: a number is out of range, or a strategy is named twice.
    """
    # The yardstick is about the number of questions: in physics it would only repeat what the fast worlds tell.
    compared = TABLE1 if vehicle == "kinematic" else tuple(name for name in TABLE1 if name != "optimal")
    cell = Cell(scenario="fire-warehouse", methods=_methods((*compared, *strategies)))
    return _experiment("table1", (cell,), trials, seed, vehicle, share_survey=True, llm=llm, time_limit_s=time_limit_s)


def boxes(
    *,
    trials: int,
    seed: int,
    vehicle: Vehicle,
    think_s: float = 3.0,
    strategies: Sequence[str] = (),
    llm: str = TEMPLATE,
    time_limit_s: float | None = None,
) -> Experiment:
    """The paper's real-world task, in physics and through the camera: which box holds the medicine?

    Raises:
        UnknownNameError: one of the strategies, or the language model, is not known.
        InputError: a number is out of range, or a strategy is named twice.
    """
    cell = Cell(scenario="medicine-boxes", methods=_methods((*BOXES, *strategies)))
    return _experiment("boxes", (cell,), trials, seed, vehicle, think_s=think_s, llm=llm, time_limit_s=time_limit_s)


def gaps(
    *,
    trials: int,
    seed: int,
    vehicle: Vehicle,
    strategies: Sequence[str] = (),
    llm: str = TEMPLATE,
    time_limit_s: float | None = None,
) -> Experiment:
    """Beyond the paper: one to eight gaps of mixed kinds; then four, with answers and beliefs that are not perfect.

    Raises:
        UnknownNameError: one of the strategies, or the language model, is not known.
        InputError: a number is out of range, or a strategy is named twice.
    """
    methods = _methods((*GAPS, *strategies))
    cells = [_gap_cell(f"k = {k}", k, Condition(), methods) for k in range(1, MOST_GAPS + 1)]
    cells += [_gap_cell(name, 4, condition, methods) for name, condition in CONDITIONS]
    return _experiment(
        "gaps", tuple(cells), trials, seed, vehicle, tell_prices=True, llm=llm, time_limit_s=time_limit_s
    )


def gap_parameters(k: int) -> dict[str, float]:
    """Of the warehouse with k gaps: as many clouds as closed rooms, or one more."""
    rooms = k // 2
    return {"smokes": float(k - rooms), "rooms": float(rooms)}


def versions() -> dict[str, str]:
    """Of everything that decides results."""
    packages = ("mintpilot", "numpy", "scipy", "numba")
    return {"python": platform.python_version(), **{name: metadata.version(name) for name in packages}}


def _gap_cell(name: str, k: int, condition: Condition, methods: tuple[Method, ...]) -> Cell:
    believed = condition.answer_error if condition.believed_error is None else condition.believed_error
    # The exact programme is defined for answers that the drone takes to be right.
    fitting = tuple(m for m in methods if m.name != "optimal" or believed == 0)
    ready = tuple(calibrated(m, k) for m in fitting)
    return Cell(name=name, scenario="fire-warehouse", parameters=gap_parameters(k), condition=condition, methods=ready)


def _methods(names: Sequence[str]) -> tuple[Method, ...]:
    if len(set(names)) != len(names):
        twice = next(n for n in names if list(names).count(n) > 1)
        raise InputError(f"strategy '{twice}' is named twice, or is compared anyway; name it once")
    return tuple(method_of(name) for name in names)


def _experiment(
    name: str,
    cells: tuple[Cell, ...],
    trials: int,
    seed: int,
    vehicle: Vehicle,
    *,
    think_s: float = 0.0,
    tell_prices: bool = False,
    share_survey: bool = False,
    llm: str = TEMPLATE,
    time_limit_s: float | None = None,
) -> Experiment:
    if trials < 1:
        raise InputError(f"--trials {trials}: must be 1 or more")
    if seed < 0:
        raise InputError(f"--seed {seed}: must be 0 or more")
    if not 0 <= think_s <= 30:
        raise InputError(f"--think {think_s:g}: must be from 0 to 30 s; the drone waits no longer than that")
    if time_limit_s is not None and not time_limit_s > 0:
        raise InputError(f"--time-limit {time_limit_s:g}: must be above 0 s")
    load("language", llm)
    usual_s = 120.0 if vehicle == "kinematic" else 900.0
    return Experiment(
        name=name,
        cells=cells,
        trials=trials,
        seed=seed,
        vehicle=vehicle,
        think_s=think_s,
        tell_prices=tell_prices,
        time_limit_s=usual_s if time_limit_s is None else time_limit_s,
        share_plans=vehicle == "kinematic",
        llm=llm,
        share_survey=share_survey and vehicle == "mujoco",
        versions=versions(),
    )
