"""How missions end: reached, refused, ordered off, or left without a safe way."""

from __future__ import annotations

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import Assumptions
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.plan import PlanningProblem, Site, Stop
from mintpilot.core.ports import Judge, Operator, Planner
from mintpilot.core.query import Order
from mintpilot.core.task import Action
from mintpilot.mission.flight import End, Pilot, Progress


def ended(progress: Progress, judge: Judge | None) -> Verdict:
    """The verdict on a plan that was flown to its end, or not."""
    failure = judge.verdict() if judge is not None else None
    if failure is not None:
        return failure
    if progress.end is End.REFUSED:
        return Verdict(outcome=Outcome.NO_SAFE_PLAN, reason=progress.reason)
    if progress.end is End.FAILED:
        return Verdict(outcome=Outcome.VEHICLE_FAILED, reason=progress.reason or "The vehicle could not go on.")
    if judge is not None:
        return judge.final()
    return Verdict(outcome=Outcome.SUCCESS, reason="Every stop was reached.")


def stay_or_return(pilot: Pilot, planner: Planner, operator: Operator, home: Stop, why: str) -> Verdict:
    """No safe way leads on: tells the operator, and goes home by known free space where such a way exists."""
    operator.tell(f"I do not fly on: {why}")
    home_reached = go_home(pilot, planner, home)
    where = "It is back at the start." if home_reached else "It holds where it is."
    return Verdict(outcome=Outcome.NO_SAFE_PLAN, reason=f"{why} {where}")


def obey(pilot: Pilot, planner: Planner, operator: Operator, home: Stop, command: Order) -> Verdict:
    """The operator's order ends the mission: hold at once, or go home."""
    pilot.vehicle.hold()
    operator.tell("Understood.")
    if command is Order.RETURN and go_home(pilot, planner, home):
        return Verdict(outcome=Outcome.ABORTED, reason="The operator called the drone back; it is at the start.")
    return Verdict(outcome=Outcome.ABORTED, reason=f"The operator ordered '{command.value}'; the drone holds.")


def home_stop(start_m: tuple[float, float, float]) -> Stop:
    """The place where the mission began, as a stop."""
    return Stop(id="home", action=Action.GO, sites=(Site(position_m=start_m, reach_m=0.5, label="start"),), dwell_s=0.0)


def go_home(pilot: Pilot, planner: Planner, home: Stop) -> bool:
    """Flies to the start through space that is known to be free, whatever is still open. True when it got there."""
    state = pilot.vehicle.state()
    problem = PlanningProblem(map=pilot.map, start_m=state.position_m, stops=(home,), gaps=(), limits=pilot.limits)
    try:
        plan = planner.open(problem).cautious(Assumptions())
    except InfeasibleError:
        return False
    return plan is not None and pilot.fly(plan, phase="return").end is End.DONE
