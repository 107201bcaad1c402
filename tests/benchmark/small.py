"""Small experiments for tests, and strategies that misbehave."""

from __future__ import annotations

import os
import time

from mintpilot.benchmark.experiment import Cell, Condition, Experiment
from mintpilot.benchmark.methods import Method, method_of
from mintpilot.core.ports import Decision, Situation, Strategy


def experiment(*names: str, trials: int = 2, condition: Condition | None = None, **changes: object) -> Experiment:
    methods = tuple(method_of(name) for name in names)
    cell = Cell(scenario="fire-warehouse", condition=condition or Condition(), methods=methods)
    made = Experiment(name="table1", cells=(cell,), trials=trials, seed=2, vehicle="kinematic", time_limit_s=60.0)
    return made.model_copy(update=changes)


def with_methods(base: Experiment, *methods: Method) -> Experiment:
    return base.model_copy(update={"cells": (base.cells[0].model_copy(update={"methods": methods}),)})


class Raising(Strategy):
    def decide(self, situation: Situation) -> Decision:
        raise ZeroDivisionError("no idea")


class Hanging(Strategy):
    """Hangs, and forgives every error that would wake it."""

    def decide(self, situation: Situation) -> Decision:
        while True:
            try:
                time.sleep(10)
            except Exception:
                continue


class Dying(Strategy):
    def decide(self, situation: Situation) -> Decision:
        os._exit(7)
