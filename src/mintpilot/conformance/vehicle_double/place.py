"""The world that the double flies in: the kinematic simulator's, which says what it touches or leaves."""

from __future__ import annotations

from mintpilot.conformance.vehicle_double.body import Body
from mintpilot.core.geometry import Vec3
from mintpilot.simulation.kinematic import KinematicSimulator
from mintpilot.simulation.reference import LANDED_M
from mintpilot.simulation.scene import FlightRules, Scene

EVERY_S = 0.05


class Place:
    """A scene with the double in it. North is y, east is x; it stands below the scene's start.

    Args:
        scene: the world.
        rules: what ends a flight.
    """

    def __init__(self, scene: Scene, rules: FlightRules | None) -> None:
        self._simulator = KinematicSimulator(scene, rules or FlightRules(), seed=0)
        self._pad: Vec3 = (scene.start_m[0], scene.start_m[1], scene.volume.lo_m[2])
        self._next_s = 0.0

    @property
    def verdict(self) -> str:
        """What it flew into or out of; empty: nothing."""
        verdict = self._simulator.verdict()
        return str(verdict.reason) if verdict is not None else ""

    def position_m(self, body: Body) -> Vec3:
        """Where it is in the scene; its centre stands above the ground on its legs."""
        n, e, d = body.ned_m
        return (self._pad[0] + e, self._pad[1] + n, self._pad[2] + max(-d, LANDED_M))

    def move(self, now_s: float, body: Body) -> None:
        """It is there now."""
        if now_s < self._next_s:
            return
        self._next_s = now_s + EVERY_S
        n, e, d = body.velocity
        self._simulator.carry(now_s, self.position_m(body), (e, n, -d))
