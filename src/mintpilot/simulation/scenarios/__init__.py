"""Scenario generators, by name. The same seed and parameters give the same world."""

from __future__ import annotations

from collections.abc import Callable

from mintpilot.core.errors import MissionError, UnknownNameError
from mintpilot.simulation.scenarios.fire_warehouse import FireWarehouseParameters, fire_warehouse
from mintpilot.simulation.scenarios.medicine_boxes import MedicineBoxesParameters, medicine_boxes
from mintpilot.simulation.scenarios.scenario import Scenario

SCENARIOS: dict[str, Callable[..., Scenario]] = {"fire-warehouse": fire_warehouse, "medicine-boxes": medicine_boxes}


def make_scenario(name: str, seed: int, **parameters: float) -> Scenario:
    """Draws one world of the scenario with that name.

    Args:
        name: a key of `SCENARIOS`.
        seed: 0 or above.
        **parameters: the generator's own; those not given keep their defaults.

    Raises:
        UnknownNameError: no scenario, or no parameter of it, has a name.
        MissionError: the seed or a parameter's value breaks a rule.
    """
    if name not in SCENARIOS:
        raise UnknownNameError("scenario", name, SCENARIOS)
    if seed < 0:
        raise MissionError(f"seed = {seed}: must be 0 or above")
    return SCENARIOS[name](seed, **parameters)


__all__ = [
    "SCENARIOS",
    "FireWarehouseParameters",
    "MedicineBoxesParameters",
    "Scenario",
    "fire_warehouse",
    "make_scenario",
    "medicine_boxes",
]
