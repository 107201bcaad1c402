"""Checks for plug-ins, ours and a stranger's: does it keep the contract of its port?

    from mintpilot.conformance import check_strategy

    def test_my_method_keeps_the_contract():
        check_strategy(MyMethod)

Every check takes a function that makes a fresh part (a class will do) and may call it more than once. It returns
nothing, or raises `mintpilot.core.errors.ConformanceError`, which says what was asked, what came back, and the rule.
"""

from __future__ import annotations

from mintpilot.conformance.frames import check_frame_source, check_namer
from mintpilot.conformance.language_model import check_language_model
from mintpilot.conformance.operator import check_operator
from mintpilot.conformance.perception import check_perception
from mintpilot.conformance.planner import check_metric, check_planner
from mintpilot.conformance.policy import check_policy
from mintpilot.conformance.recorder import check_recorder
from mintpilot.conformance.strategy import check_objective, check_strategy
from mintpilot.conformance.vehicle import check_vehicle

__all__ = [
    "check_frame_source",
    "check_language_model",
    "check_metric",
    "check_namer",
    "check_objective",
    "check_operator",
    "check_perception",
    "check_planner",
    "check_policy",
    "check_recorder",
    "check_strategy",
    "check_vehicle",
]
