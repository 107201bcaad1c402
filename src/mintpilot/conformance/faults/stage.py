"""What an adapter brings to a trial: who flies, who is asked, and where the vehicle truly is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from typing import TypeAlias

from mintpilot.assembly.components import Choices, VehicleChoice, scripted_operator
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World
from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.faulty_operator import FaultyOperator
from mintpilot.conformance.faults.faulty_source import FaultySource
from mintpilot.conformance.faults.faulty_vehicle import FaultyVehicle
from mintpilot.conformance.faults.kinds import FaultKind
from mintpilot.conformance.faults.ledger import Ledger
from mintpilot.core.ports import Operator, Recorder
from mintpilot.mission.components import MissionComponents
from mintpilot.mission_file.schema import OperatorSpec

THINKS = "1..8"
"""How long the person thinks, seconds."""
Beset: TypeAlias = Callable[[MissionComponents], MissionComponents]


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """One trial's adapter, set up."""

    choices: Choices
    operators: tuple[Operator, ...]
    """They keep the ledger themselves."""
    beset: Beset
    """Puts faults between the mission and its parts."""
    recorders: tuple[Recorder, ...] = ()
    """Who is told of everything besides the run folder."""


Open: TypeAlias = Callable[[Draw, World, Ledger, Talk], AbstractContextManager[Stage]]


@contextmanager
def on_kinematics(draw: Draw, world: World, ledger: Ledger, talk: Talk) -> Iterator[Stage]:  # noqa: ARG001
    """The kinematic simulator, everything around it faulty."""
    yield Stage(
        choices=Choices(vehicle=VehicleChoice.KINEMATIC),
        operators=people(draw, world, ledger),
        beset=lambda made: replace(
            made,
            vehicle=FaultyVehicle(made.vehicle, draw, ledger),
            map_source=FaultySource(made.map_source, draw, ledger),
        ),
    )


def people(draw: Draw, world: World, ledger: Ledger) -> tuple[Operator, ...]:
    """Who answers: somebody who knows the truth, with the faults that are drawn; perhaps somebody else, who lies."""
    first = FaultyOperator(scripted_operator(world, OperatorSpec(latency_s=THINKS)), draw, ledger)
    if draw.first(FaultKind.SECOND) is None:
        return (first,)
    lies = scripted_operator(world, OperatorSpec(latency_s=THINKS, answer_error=0.9))
    return (first, FaultyOperator(lies, replace(draw, faults=()), ledger, during=draw.first(FaultKind.SECOND)))
