"""The experiments: which worlds, which conditions, which methods. Fixed before the first run; nothing fits the paper.

Worlds are those of the scenario generators with their defaults (`mintpilot.simulation.scenarios`), which follow the
paper's description. Prices: a question counts as 10 s of flight, a failure as 600 s (the default of `AskingSettings`).
The scripted person thinks for 5 s about each question, and the drone's battery runs meanwhile. Table 1's batteries then
last 10 s longer for each gap (the default of ``asking.reply_s``), so that thinking is possible.
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
from mintpilot.core.think_time import think_time

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
THINK_S = 5.0
"""How long the scripted person thinks about a question, seconds."""
SPARE_S = 10.0
"""How much longer the battery lasts for each gap where the person thinks, seconds: as ``asking.reply_s`` by default."""
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
    think: str | float = THINK_S,
    spare_s: float | None = None,
    strategies: Sequence[str] = (),
    llm: str = TEMPLATE,
    time_limit_s: float | None = None,
) -> Experiment:
    """The paper's Table 1: one cloud of smoke and one closed room in a warehouse on fire.

    With ``think=0`` these are the worlds and batteries of the table before people took time.

    Args:
        trials: number of worlds.
        seed: of the first.
        vehicle: point mass, or physics and camera.
        think: seconds that the scripted person takes, or two bounds (`mintpilot.core.think_time.think_time`).
        spare_s: how much longer the battery lasts for each gap; None: `SPARE_S` where the person thinks, else 0.
        strategies: compared besides.
        llm: who may propose questions.
        time_limit_s: of computing, for each trial.

    Raises:
        UnknownNameError: one of the strategies, or the language model, is not known.
        InputError: a number is out of range, or a strategy is named twice.
    """
    # The yardstick is about the number of questions: in physics it would only repeat what the fast worlds tell.
    compared = TABLE1 if vehicle == "kinematic" else tuple(name for name in TABLE1 if name != "optimal")
    methods = _methods((*compared, *strategies))
    cell = Cell(scenario="fire-warehouse", parameters=_spare(think, spare_s, 2), methods=methods)
    return _experiment(
        "table1", (cell,), trials, seed, vehicle, think=think, share_survey=True, llm=llm, time_limit_s=time_limit_s
    )


def boxes(
    *,
    trials: int,
    seed: int,
    vehicle: Vehicle,
    think: str | float = THINK_S,
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
    return _experiment("boxes", (cell,), trials, seed, vehicle, think=think, llm=llm, time_limit_s=time_limit_s)


def gaps(
    *,
    trials: int,
    seed: int,
    vehicle: Vehicle,
    think: str | float = THINK_S,
    spare_s: float | None = None,
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
    kinds = [(f"k = {k}", k, Condition()) for k in range(1, MOST_GAPS + 1)]
    kinds += [(name, 4, condition) for name, condition in CONDITIONS]
    cells = [_gap_cell(name, k, _spare(think, spare_s, k), condition, methods) for name, k, condition in kinds]
    return _experiment(
        "gaps", tuple(cells), trials, seed, vehicle, think=think, tell_prices=True, llm=llm, time_limit_s=time_limit_s
    )


def gap_parameters(k: int) -> dict[str, float]:
    """Of the warehouse with k gaps: as many clouds as closed rooms, or one more."""
    rooms = k // 2
    return {"smokes": float(k - rooms), "rooms": float(rooms)}


def _spare(think: str | float, spare_s: float | None, gaps: int) -> dict[str, float]:
    """The scenario's parameter for batteries that last longer; none where they are as they were."""
    each_s = (SPARE_S if think_time(think).most_s > 0 else 0.0) if spare_s is None else spare_s
    return {"thinking_s": gaps * each_s} if each_s else {}


def versions() -> dict[str, str]:
    """Of everything that decides results."""
    packages = ("mintpilot", "numpy", "scipy", "numba")
    return {"python": platform.python_version(), **{name: metadata.version(name) for name in packages}}


def _gap_cell(name: str, k: int, spare: dict[str, float], condition: Condition, methods: tuple[Method, ...]) -> Cell:
    believed = condition.answer_error if condition.believed_error is None else condition.believed_error
    # The exact programme is defined for answers that the drone takes to be right.
    fitting = tuple(m for m in methods if m.name != "optimal" or believed == 0)
    ready = tuple(calibrated(m, k) for m in fitting)
    return Cell(
        name=name,
        scenario="fire-warehouse",
        parameters={**gap_parameters(k), **spare},
        condition=condition,
        methods=ready,
    )


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
    think: str | float = 0.0,
    tell_prices: bool = False,
    share_survey: bool = False,
    llm: str = TEMPLATE,
    time_limit_s: float | None = None,
) -> Experiment:
    if trials < 1:
        raise InputError(f"--trials {trials}: must be 1 or more")
    if seed < 0:
        raise InputError(f"--seed {seed}: must be 0 or more")
    thinks = think_time(think)
    if thinks.most_s > 30:
        raise InputError(f"--think {thinks}: must be from 0 to 30 s; the drone waits no longer than that")
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
        think_s=thinks.least_s,
        think_most_s=None if thinks.most_s == thinks.least_s else thinks.most_s,
        tell_prices=tell_prices,
        time_limit_s=usual_s if time_limit_s is None else time_limit_s,
        share_plans=vehicle == "kinematic",
        llm=llm,
        share_survey=share_survey and vehicle == "mujoco",
        versions=versions(),
    )
