"""Ways to judge how much a cut is worth, as plug-ins measured against each other (method, section 4)."""

from __future__ import annotations

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.ports import QueryObjective
from mintpilot.elicitation.objectives.ec2 import Ec2
from mintpilot.elicitation.objectives.information_gain import InformationGain
from mintpilot.elicitation.objectives.optimal import Optimal
from mintpilot.elicitation.objectives.random import Random
from mintpilot.elicitation.objectives.value_of_information import ValueOfInformation

OBJECTIVES: dict[str, type[QueryObjective]] = {
    "ec2": Ec2,
    "information-gain": InformationGain,
    "optimal": Optimal,
    "random": Random,
    "value-of-information": ValueOfInformation,
}


def query_objective(name: str) -> QueryObjective:
    """The objective with that name. Raises `UnknownNameError` for others."""
    if name not in OBJECTIVES:
        raise UnknownNameError("query objective", name, OBJECTIVES)
    return OBJECTIVES[name]()


__all__ = [
    "OBJECTIVES",
    "Ec2",
    "InformationGain",
    "Optimal",
    "Random",
    "ValueOfInformation",
    "query_objective",
]
