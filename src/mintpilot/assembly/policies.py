"""Planners and impact metrics by name; those that go by a policy take it after a colon: ``policy:mine.npz``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from mintpilot.assembly.registry import check_name, load
from mintpilot.core.errors import InputError

if TYPE_CHECKING:
    from mintpilot.core.ports import ImpactMetric, Planner, Policy

_BY_POLICY: Final = {"planner": "policy", "metric": "q-value"}
"""Port → the part that goes by a policy."""


def make_planner(name: str) -> Planner:
    """The planner of that name: ``grid``, ``policy`` (the exact one), ``policy:mine.npz``, or a plug-in's.

    Raises:
        UnknownNameError: nobody registered that planner or policy.
        InputError: the file of the policy cannot be used.
    """
    kind, policy = _parts("planner", name)
    made: Planner = load("planner", kind)(*policy)
    return made


def make_metric(name: str) -> ImpactMetric:
    """The impact metric of that name: ``frechet``, ``q-value`` (by the exact policy), ``q-value:mine.npz`` …

    Raises:
        UnknownNameError: nobody registered that metric or policy.
        InputError: the file of the policy cannot be used.
    """
    kind, policy = _parts("metric", name)
    made: ImpactMetric = load("metric", kind)(*policy)
    return made


def check_metric_name(name: str) -> None:
    """Whether a metric of that name can be had. Raises as `make_metric` does."""
    kind, _ = _parts("metric", name)
    check_name("metric", kind)


def make_policy(name: str) -> Policy:
    """A policy by its registered name, or from its file (a name with a suffix, seen from the present folder).

    Raises:
        UnknownNameError: nobody registered that policy.
        InputError: its file cannot be used.
    """
    if Path(name).suffix:
        from mintpilot.policies.files import load_policy

        return load_policy(Path(name))
    made: Policy = load("policy", name)()
    return made


def _parts(port: str, name: str) -> tuple[str, tuple[Policy, ...]]:
    kind, colon, policy = name.partition(":")
    if not colon:
        return name, ()
    if kind != _BY_POLICY[port]:
        raise InputError(
            f"{port} '{name}': only '{_BY_POLICY[port]}' goes by a policy; write {_BY_POLICY[port]}:{policy}"
        )
    return kind, (make_policy(policy),)
