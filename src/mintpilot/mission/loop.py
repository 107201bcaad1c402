"""The loop around `step`: observe, deliberate (find gaps, plan, choose), ask, learn, fly. It decides nothing."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

from mintpilot.core.events import MissionEnded, Noticed
from mintpilot.core.inputs import Input, MissionBegun
from mintpilot.core.message import message
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.mission.components import MissionComponents
from mintpilot.mission.directives import (
    BeginTask,
    Brake,
    Deliberate,
    Finish,
    Move,
    Note,
    Observe,
    ShowQuestion,
    Tell,
    WithdrawQuestion,
)
from mintpilot.mission.shell import Shell
from mintpilot.mission.step import initial_state, step


def fly_mission(components: MissionComponents) -> Verdict:
    """Flies one mission from take-off to its end. Whatever happens, the vehicle is left holding."""
    shell = Shell(components)
    vehicle = components.vehicle.state()
    state = initial_state(components.setup, vehicle)
    events: deque[Input] = deque([MissionBegun(time_s=vehicle.time_s, vehicle=vehicle)])
    broken_off = message("The mission was broken off; the drone holds where it is.")
    verdict = Verdict(outcome=Outcome.ABORTED, reason=broken_off)
    components.recorder.record(components.started())
    if components.begins_with:
        components.recorder.record(Noticed(kind="map", text=components.begins_with))
    try:
        while not state.ended:
            if not events:
                events.extend(shell.observe(state))  # what the vehicle, the camera, the operators and the worker bring
            event = events.popleft()
            before, (state, directives) = state, step(state, event)  # learn, and decide what is to be done
            shell.journal.keep(before, event, state, directives)
            for directive in directives:
                match directive:
                    case Observe():
                        events.extend(shell.look(state, directive))
                    case Deliberate():  # find the gaps, plan, build the tree, choose the query
                        events.extend(shell.deliberate(directive))
                    case ShowQuestion() | WithdrawQuestion() | Tell():
                        shell.speak(directive)
                    case Move() | Brake():
                        events.extend(shell.fly(directive))
                    case BeginTask():
                        events.extend(shell.begin_task())
                    case Note() | Finish():
                        pass  # the journal keeps them
        verdict = shell.verdict(state)
    finally:
        if not state.ended and state.grounded:
            verdict = replace(verdict, reason=message("The mission was broken off; the drone stands on the ground."))
        shell.close()
        components.recorder.record(MissionEnded(verdict=verdict))
    return verdict
