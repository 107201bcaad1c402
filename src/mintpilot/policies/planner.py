"""A planner that flies by a policy: what the policy proposes becomes a plan only where every move of it is allowed."""

from __future__ import annotations

from collections.abc import Callable

from scipy import ndimage

from mintpilot.core.gap import Assumptions
from mintpilot.core.geometry import Bools, Ints
from mintpilot.core.message import Message, message
from mintpilot.core.plan import Plan, PlanningProblem
from mintpilot.core.policy import GridCell, policy_task
from mintpilot.core.ports import Planner, PlanSpace, Policy
from mintpilot.planning.task_planner import LazyPlanner
from mintpilot.policies.exact import ExactPolicy
from mintpilot.policies.following import follow


class PolicyPlanner(Planner):
    """Plans by following a policy under each joint hypothesis that matters, by lazy branching.

    Plans are sound whatever the policy is: a move that is not allowed is never taken, and which regions a plan enters
    is read from its cells. They are as good as the policy is: a way that it does not find does not exist for it.

    Args:
        policy: whose values are followed; None: the exact one.
    """

    def __init__(self, policy: Policy | None = None) -> None:
        self._policy = policy or ExactPolicy()

    def open(self, problem: PlanningProblem) -> PlanSpace:
        """The plans of that problem, as `GridPlanner.open`.

        Raises:
            InputError: later, from a plan, where the policy is of another grid or its values are none.
        """
        guide = _Guide(self._policy)
        return _PolicyPlanSpace(LazyPlanner(guide.find, reversible=False).open(problem), guide.notes)


class _Guide:
    """Ways from a policy, with a count of those that it should have found and did not."""

    def __init__(self, policy: Policy) -> None:
        self._policy = policy
        self._asked = self._lost = 0

    def find(self, free: Bools, start: GridCell, goal: GridCell) -> tuple[float, Ints] | None:
        """The way that the policy takes, as (cost in edges, cells (n, 3)); None where it does not arrive."""
        parts, _ = ndimage.label(free)
        if parts[start] == 0 or parts[start] != parts[goal]:
            return None
        self._asked += 1
        found = follow(self._policy, policy_task(free, goal), start)
        if found is None:
            self._lost += 1
            return None
        return found.cost, found.cells

    def notes(self) -> tuple[Message, ...]:
        """Where the policy falls short, as a sentence."""
        if not self._lost:
            return ()
        return (
            message(
                "the policy did not arrive in {lost} of {asked} flights that are possible; plans stay safe, but may be "
                "dearer than need be, or missing",
                lost=self._lost,
                asked=self._asked,
            ),
        )


class _PolicyPlanSpace(PlanSpace):
    """The plans, and what the policy did not find."""

    def __init__(self, space: PlanSpace, shortfalls: Callable[[], tuple[Message, ...]]) -> None:
        self._space, self._shortfalls = space, shortfalls

    @property
    def searches(self) -> int:
        return self._space.searches

    @property
    def notes(self) -> tuple[Message, ...]:
        return (*self._space.notes, *self._shortfalls())

    def optimistic(self, given: Assumptions) -> Plan | None:
        return self._space.optimistic(given)

    def cautious(self, given: Assumptions) -> Plan | None:
        return self._space.cautious(given)
