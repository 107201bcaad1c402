"""Names of methods: a strategy, with the settings that it is run with."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

from pydantic import BaseModel, ConfigDict

from mintpilot.assembly.registry import load, names, unknown


class Method(BaseModel):
    """One row of a table: what is compared."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str
    """As it stands in tables."""
    strategy: str
    """Name in the registry of strategies."""
    asking: dict[str, str | float] = {}
    """Fields of `AskingSettings` that differ from the experiment's."""
    arguments: dict[str, float] = {}
    """What the strategy is made with, besides a seed."""


_OBJECTIVES = ("information-gain", "ec2", "value-of-information", "optimal")
VARIANTS: Final = MappingProxyType(
    {
        "mint-paper": Method(name="mint-paper", strategy="mint", asking={"rule": "paper"}),
        "mint-unasked": Method(name="mint-unasked", strategy="mint", asking={"max_questions": 0.0}),
        "mint-holding": Method(name="mint-holding", strategy="mint", asking={"while_waiting": "hold"}),
        **{name: Method(name=name, strategy="mint", asking={"objective": name}) for name in _OBJECTIVES},
    }
)
"""Methods that are a strategy with other settings. `mint` itself is the regret rule with information gain."""


def method_of(name: str) -> Method:
    """The method with that name: one of `VARIANTS`, or any strategy, plug-ins included.

    Raises:
        UnknownNameError: nobody registered it; the nearest known name is given.
        InputError: a plug-in is registered but cannot be imported.
    """
    if name in VARIANTS:
        return VARIANTS[name]
    if name not in names("strategy"):
        raise unknown("strategy", name, (*names("strategy"), *VARIANTS))
    load("strategy", name)
    return Method(name=name, strategy=name)
