"""What the link keeps an eye on: whether anything is heard, whether the position is good, and whose hands it is in."""

from __future__ import annotations

import math

from mintpilot.core.inputs import Link
from mintpilot.vehicle.control_state import Phase, Turn
from mintpilot.vehicle.signals import Changed, Mode, Seen

SILENT_S = 1.6
"""Nothing heard for so long: the link is lost, seconds. The position alone comes 20 times a second."""
BEATS = 3.6
"""So many heartbeats missing one after the other: the link is lost ..."""
FASTEST_BEAT_S = 0.5
"""... but not because of a faster beat than this, seconds: packets are lost, too."""
HELD_UP_S = 0.4
"""For so long after it was held up itself, the process takes nothing for silent, seconds: it has to catch up first."""
STALE_S = 0.6
"""A position older than this is none, seconds."""
JUMP_M = 1.0
"""A position that moves by so much more than its speed explains has jumped, metres."""
STEADY_S = 1.0
"""The position counts as good again after having been good for so long, seconds."""
GRACE_S = 0.5
"""A heartbeat within this time after a change of mode may still tell the old one, seconds."""

EXPECTED: dict[Phase, frozenset[Mode]] = {
    Phase.CLIMBING: frozenset({Mode.TAKE_OFF, Mode.HOLD, Mode.OURS}),
    Phase.ENGAGING: frozenset({Mode.TAKE_OFF, Mode.HOLD, Mode.OURS, Mode.LAND}),
    Phase.FLYING: frozenset({Mode.OURS}),
    Phase.LANDING: frozenset({Mode.LAND}),
    Phase.RETURNING: frozenset({Mode.RETURN, Mode.LAND}),
}
"""The modes that the autopilot is in while the vehicle is in our hands."""


def take_in(turn: Turn, seen: Seen) -> None:
    """What was heard since the last tick; finds out whether the position has jumped."""
    state, before = turn.state, turn.state.seen
    if state.airborne and before.position_s > 0 and seen.position_s > before.position_s and not state.jumped:
        elapsed_s = max(seen.position_s - before.position_s, 0.05)
        expected = [p + v * elapsed_s for p, v in zip(before.position_m, before.velocity_mps, strict=True)]
        off_m = math.dist(seen.position_m, expected)
        if off_m > JUMP_M + 2.0 * elapsed_s:
            turn.set(jumped=f"it jumped by {off_m:.1f} m")
    turn.set(seen=seen)


def watch(turn: Turn) -> None:
    """Says what went down or came back, and lets go where the vehicle is not ours any more."""
    _watch_link(turn)
    if turn.state.airborne:
        _watch_position(turn)
        _watch_hands(turn)


def heartbeat_limit_s(every_s: float) -> float:
    """How long a heartbeat may be missing, seconds, where it comes as often as that."""
    return BEATS * min(max(every_s, FASTEST_BEAT_S), 1.0)


def _watch_link(turn: Turn) -> None:
    state = turn.state
    if state.phase in (Phase.RELEASED, Phase.DOWN) or state.now_s - state.late_s < HELD_UP_S:
        return
    silent_s, beat_s = state.now_s - state.seen.message_s, state.now_s - state.seen.heartbeat_s
    if silent_s > SILENT_S:
        turn.release(Link.TELEMETRY, f"nothing was heard of the autopilot for {silent_s:.1f} s: its fail-safe flies")
    elif beat_s > heartbeat_limit_s(state.seen.heartbeat_every_s):
        turn.release(Link.TELEMETRY, f"no heartbeat of the autopilot for {beat_s:.1f} s: its fail-safe flies")


def _watch_position(turn: Turn) -> None:
    state = turn.state
    fault = state.jumped
    if not fault and state.now_s - state.seen.position_s > STALE_S:
        fault = f"no position came for {state.now_s - state.seen.position_s:.1f} s"
    if not fault and not state.seen.position_known:
        fault = "the autopilot does not trust its position"
    if fault:
        turn.set(good_position_s=None)
        turn.lose(Link.POSITION, fault)
        return
    good_s = state.now_s if state.good_position_s is None else state.good_position_s
    turn.set(good_position_s=good_s)
    if Link.POSITION in state.down and state.now_s - good_s >= STEADY_S:
        turn.set(down=state.down - {Link.POSITION})
        turn.give(Changed(link=Link.POSITION, up=True))


def _watch_hands(turn: Turn) -> None:
    """The pilot's switch always wins, and so does the autopilot's fail-safe."""
    state, seen = turn.state, turn.state.seen
    if not state.airborne or seen.heartbeat_s < state.mode_since_s + GRACE_S:
        return
    if not seen.armed and state.phase not in (Phase.LANDING, Phase.RETURNING):
        turn.release(Link.CONTROL, "its motors were stopped")
        return
    changing = state.asked is not None and seen.mode is not Mode.OTHER  # it may still be in the mode before
    if seen.mode in EXPECTED[state.phase] or not seen.armed or changing:
        return
    whose = {
        Mode.LAND: "its fail-safe or a pilot lands it",
        Mode.RETURN: "its fail-safe or a pilot flies it back",
        Mode.HOLD: "its fail-safe or a pilot holds it",
    }.get(seen.mode, "a pilot has taken over")
    words = f" ({seen.status})" if seen.status else ""
    turn.release(Link.CONTROL, f"the autopilot changed to mode {seen.mode_name}, {whose}{words}: hands off")
