"""Ways to judge how much a query is worth, as plug-ins measured against each other (method, section 4).

Their names are in the one table of names, `mintpilot.assembly.registry`.
"""

from __future__ import annotations

from mintpilot.elicitation.objectives.ec2 import Ec2
from mintpilot.elicitation.objectives.information_gain import InformationGain
from mintpilot.elicitation.objectives.optimal import Optimal
from mintpilot.elicitation.objectives.random import Random
from mintpilot.elicitation.objectives.value_of_information import ValueOfInformation

__all__ = ["Ec2", "InformationGain", "Optimal", "Random", "ValueOfInformation"]
