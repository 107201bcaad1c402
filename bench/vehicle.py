"""Faults and set-points of real flight links, against the vehicle double: ``python -m bench.vehicle``.

Each row is one medicine mission, flown in real time by a program of its own over MAVLink on this machine. A fault comes
while it flies to its first stop; from then on the double is watched.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from bench.sections import ROOT, Section, Table, keep
from mintpilot.assembly.worlds import build_world
from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.serving import DoubleSetup, DoubleState, VehicleDouble, free_port
from mintpilot.mission_file.reader import read_mission

MISSION = ROOT / "examples" / "medicine.yaml"
BEFORE_S = 1.0
"""The fault comes so long after the drone has set out."""
LONGEST_S = 150.0
STILL_MPS = 0.2
PROCESSES = ("loop hangs", "loop killed", "link process killed")
NONE = "none"
EARLY = (Fault.REFUSE_ARM, Fault.NO_GRIPPER, Fault.NO_GPS)
"""Those that are there from the beginning."""


@dataclass(frozen=True, kw_only=True)
class Row:
    """One flight."""

    flavour: str
    fault: str
    outcome: str
    reason: str
    safe: str
    """Which safe state came first."""
    safe_s: float | None
    """From the fault to it, seconds."""
    landed_s: float | None
    touched: str
    gaps_ms: tuple[float, float, float]
    """Median, 99th percentile and longest time between set-points, until the fault."""
    load: float = math.nan
    """Processes that wanted a core, a minute's mean, at the end."""


class Watch:
    """Follows the double after the fault."""

    def __init__(self) -> None:
        self.safe, self.safe_s, self.landed_s = "", None, None
        self._still_s: float | None = None

    def look(self, state: DoubleState, since_s: float) -> None:
        if self.landed_s is None and not state.armed and not state.airborne:
            self.landed_s = since_s
            self._found("landed", since_s)
        if state.mode == "pilot":
            self._found("in the pilot's hands", since_s)
        still = math.hypot(*state.velocity) < STILL_MPS
        self._still_s = (self._still_s if self._still_s is not None else since_s) if still else None
        if self._still_s is not None and since_s - self._still_s >= 1.0:
            self._found("hovering", self._still_s)

    def _found(self, what: str, at_s: float) -> None:
        if self.safe_s is None:
            self.safe, self.safe_s = what, at_s


def fly(flavour: Flavour, fault: str) -> Row:
    """One mission with that fault."""
    world = build_world(read_mission(MISSION), base=MISSION.parent, seed=0)
    port = free_port()
    early = fault in EARLY
    setup = DoubleSetup(flavour=flavour, port=port, scene=world.scene, rules=world.rules)
    with VehicleDouble(setup) as double, tempfile.TemporaryDirectory() as folder:
        if early:
            double.switch_on(Fault(fault))
        address = f"mavlink://udpin:127.0.0.1:{port}"
        words = ["run", str(MISSION), "--vehicle", address, "--operator", "scripted", "--seed", "0", "--json"]
        start = "from mintpilot.cli.main import main; raise SystemExit(main())"
        program = [sys.executable, "-c", start, *words, "--out", str(Path(folder) / "run")]
        with subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as mission:
            _wait(lambda: _set_out(double.state()) or mission.poll() is not None)
            time.sleep(0 if early else BEFORE_S)
            before, begun_s = double.state(), time.monotonic()
            if not early and fault != NONE:
                _begin(fault, double, mission)
            watch = Watch()
            while time.monotonic() - begun_s < LONGEST_S:
                watch.look(double.state(), time.monotonic() - begun_s)
                over = mission.poll() is not None or fault == "loop hangs"
                if over and (watch.landed_s is not None or watch.safe == "in the pilot's hands"):
                    break
                time.sleep(0.05)
            told = _ended(mission, double)
        state = double.state()
        points = state.set_points_s if fault == NONE else before.set_points_s
        return Row(
            flavour=flavour.value, fault=fault, outcome=told[0], reason=told[1], safe=watch.safe, safe_s=watch.safe_s,
            landed_s=watch.landed_s, touched=state.verdict, gaps_ms=_gaps(points),
            load=os.getloadavg()[0],
        )  # fmt: skip


def _set_out(state: DoubleState) -> bool:
    return state.airborne and math.hypot(*state.velocity[:2]) > 0.5


def _wait(until: Callable[[], bool]) -> None:
    end_s = time.monotonic() + LONGEST_S
    while not until() and time.monotonic() < end_s:
        time.sleep(0.05)


def _begin(fault: str, double: VehicleDouble, mission: subprocess.Popen[str]) -> None:
    if fault not in PROCESSES:
        double.switch_on(Fault(fault))
    elif fault == "loop hangs":
        mission.send_signal(signal.SIGSTOP)
    elif fault == "loop killed":
        mission.kill()
    else:
        os.kill(_link_process(mission.pid), signal.SIGKILL)


def _link_process(parent: int) -> int:
    """The child that made itself a session of its own."""
    children = Path(f"/proc/{parent}/task/{parent}/children").read_text().split()
    return next(int(child) for child in children if os.getsid(int(child)) == int(child))


def _ended(mission: subprocess.Popen[str], double: VehicleDouble) -> tuple[str, str]:
    waits = double.state().mode == "follow"
    mission.send_signal(signal.SIGCONT)
    try:
        said, _ = mission.communicate(timeout=20)
    except subprocess.TimeoutExpired:  # it keeps its heartbeats up while a pilot flies, or hovers for a helping hand
        double.switch_on(Fault.SILENCE)
        said, _ = mission.communicate(timeout=60)
        if waits:
            return "none yet", f"it still hovered after {LONGEST_S:g} s; the link was cut then"
    try:
        report = json.loads(said.strip().splitlines()[-1])
    except (IndexError, ValueError):
        return "-", ""
    return str(report.get("outcome", "-")), str(report.get("reason", ""))


def _gaps(times_s: tuple[float, ...]) -> tuple[float, float, float]:
    gaps = np.diff(np.asarray(times_s))
    gaps = gaps[gaps < 1.0] * 1000  # between two flights under our set-points there are none
    if not len(gaps):
        return (0.0, 0.0, 0.0)
    p50, p99, longest = np.percentile(gaps, [50, 99, 100])
    return (round(float(p50), 1), round(float(p99), 1), round(float(longest), 1))


def section(rows: list[Row], notes: list[str]) -> Section:
    """The section of docs/results.md."""
    flights = [row for row in rows if row.fault == NONE]
    faults = [row for row in rows if row.fault != NONE]
    spacing = Table(
        caption="Time between set-points over a whole mission, planning included, ms",
        header=["autopilot", "mission", "median", "99 %", "longest", f"load, {os.cpu_count()} cores"],
        rows=[[r.flavour, r.outcome, *(f"{v:g}" for v in r.gaps_ms), f"{r.load:.0f}"] for r in flights],
    )
    table = Table(
        caption="Faults in flight",
        header=[
            "autopilot",
            "fault",
            "mission ended",
            "first safe state",
            "after, s",
            "on the ground after, s",
            "touched",
            "reason told",
        ],
        rows=[
            [
                r.flavour,
                r.fault,
                r.outcome,
                r.safe or "none",
                _seconds(r.safe_s),
                _seconds(r.landed_s),
                r.touched or "-",
                r.reason or "-",
            ]
            for r in faults
        ],
    )
    return Section(
        name="57-vehicle",
        title="Real flight links, against the vehicle double",
        command="python -m bench.vehicle",
        how=f"The medicine mission (seed 0), over MAVSDK and UDP on this machine; the fault comes {BEFORE_S:g} s after "
        f"the drone has set out, {', '.join(EARLY)} from the beginning. Safe: on the ground, slower than "
        f"{STILL_MPS:g} m/s for a second, or in the pilot's hands.",
        tables=[spacing, table],
        notes=[
            "The double is no firmware: what autopilots do by themselves is modelled after what was seen of them, and "
            "read in their sources. Set-points are timed by the kernel as they arrive at its socket.",
            "Where a heartbeat alone is missing, PX4's one a second makes it known after 3.6 s: above the goal of 2 s, "
            "which the loss of everything keeps (1.6 s). A shorter limit would let go of a drone for lost packets.",
            "An autopilot's own fail-safe lands where the drone is, whatever is below.",
            *notes,
        ],
    )


def _seconds(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--flavour", action="append", choices=list(Flavour))
    parser.add_argument("--fault", action="append", choices=[NONE, *Fault, *PROCESSES])
    parser.add_argument("--rows", type=Path, help="also write each row to this file, one JSON object a line")
    parser.add_argument("--note", action="append", default=[], help="a sentence to be kept with the section")
    parser.add_argument("--join", type=Path, nargs="*", help="make the section of such files instead of flying")
    options = parser.parse_args()
    if options.join:
        lines = [line for file in options.join for line in file.read_text().splitlines()]
        keep(section([Row(**json.loads(line)) for line in lines], options.note))
        return
    rows = []
    for flavour in options.flavour or list(Flavour):
        for fault in options.fault or [NONE, *Fault, *PROCESSES]:
            rows.append(fly(Flavour(flavour), fault))
            print(rows[-1], flush=True)
            if options.rows:
                with options.rows.open("a") as file:
                    file.write(json.dumps(asdict(rows[-1])) + "\n")
    if not options.rows:
        keep(section(rows, options.note))


if __name__ == "__main__":
    main()
