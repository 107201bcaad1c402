"""The web console in figures: pose latency, answer to next motion, share of a core, viewers, sizes of page and log.

    python -m bench.console [--motions 10]

Poses come at 10 Hz and pictures at 5 Hz; a headless Chromium notes when each pose arrives.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import tempfile
import threading
import time
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, sync_playwright
from websockets.asyncio.client import connect
from websockets.typing import Origin

from bench.sections import Section, Table, keep
from mintpilot import run_mission
from mintpilot.assembly.talk import Talk
from mintpilot.cli.demos import DEMOS, demo_path
from mintpilot.console import Role, WebConsole
from mintpilot.core.briefing import GO_GAP, GO_QUERY
from mintpilot.core.events import Event, FrameSeen, Stepped
from mintpilot.core.inputs import MotionEnded, Ticked
from mintpilot.core.observation import CameraModel, Frame
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.query import Question
from mintpilot.core.trajectory import VehicleState
from mintpilot.recording.event_log import EVENTS_FILE
from mintpilot.recording.flight_logs import log_info
from mintpilot.recording.mcap_log import MCAP_FILE

SECONDS = 20.0
VIEWERS, VIEWED_S = 10, 60.0
MOTION_MS = 300.0
ANSWERED_MS = {"at once": 700, "after 10 s": 10_000}
BRAKING_MS = 1000 * VehicleLimits().cruise_mps / VehicleLimits().max_acceleration_mps2
LATE_MS = 500.0
"""A question that a viewer gets later than this is late."""
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run"]
NOTE = """
window.arrived = [];
const Real = WebSocket;
window.WebSocket = class extends Real {
  constructor(...given) {
    super(...given);
    this.addEventListener("message", (event) => {
      if (typeof event.data === "string" && event.data.startsWith('{"pane":"pose"'))
        arrived.push([JSON.parse(event.data).data.time_s, performance.timeOrigin + performance.now()]);
    });
  }
};
"""


def made() -> WebConsole:
    talk = Talk()
    return WebConsole(understand=talk.understand, order_of=talk.order_of)


def latency(browser: Browser) -> tuple[np.ndarray, float]:
    """Milliseconds of each pose from the simulator's tick to the browser, and the console's share of one core."""
    camera = CameraModel(width=320, height=240, fx=277.0, fy=277.0, cx=160.0, cy=120.0)
    picture = np.random.default_rng(0).integers(0, 255, (240, 320, 3), np.uint8)
    depth = np.ones((240, 320), np.float32)
    sent: dict[float, float] = {}
    with made() as console:
        page = browser.new_page()
        page.add_init_script(NOTE)
        page.goto(console.url())
        page.wait_for_selector("#role.on")

        def fly() -> None:
            for n in range(int(SECONDS * 10)):
                time_s = round(n / 10, 2)
                vehicle = VehicleState(
                    time_s=time_s, position_m=(n * 0.1, 0.0, 1.0), velocity_mps=(1.0, 0.0, 0.0), yaw_rad=0.0
                )
                sent[time_s] = time.time() * 1000
                console.record(Stepped(input=Ticked(time_s=time_s, vehicle=vehicle), directives=(), digest=""))
                if n % 2 == 0:
                    frame = Frame(
                        time_s=time_s, rgb=picture.copy(), depth_m=depth.copy(), camera=camera,
                        world_from_camera=np.eye(4),
                    )  # fmt: skip
                    console.record(FrameSeen(index=n, frame=frame, detections=()))
                time.sleep(0.1)

        flight = threading.Thread(target=fly)
        begun, used = time.perf_counter(), time.process_time()
        flight.start()
        flight.join()
        share = (time.process_time() - used) / (time.perf_counter() - begun)
        page.wait_for_timeout(300)
        arrived = dict(page.evaluate("() => window.arrived"))
        page.close()
    return np.asarray([at - sent[time_s] for time_s, at in arrived.items() if time_s in sent]), share


def viewers() -> tuple[list[float], int]:
    """Milliseconds until each of ten viewers has each question, with poses and pictures going on; how many came not."""
    camera = CameraModel(width=320, height=240, fx=277.0, fy=277.0, cx=160.0, cy=120.0)
    picture = np.random.default_rng(0).integers(0, 255, (240, 320, 3), np.uint8)
    depth = np.ones((240, 320), np.float32)
    put: dict[str, float] = {}
    late: list[float] = []

    async def watch(console: WebConsole, number: int) -> None:
        base, _, token = console.url(Role.WATCH).partition("/#")
        url = base.replace("http", "ws", 1) + "/live"
        async with connect(url, origin=Origin(base), max_size=None) as link:
            await link.send(json.dumps({"kind": "hello", "token": token, "browser": f"viewer{number:02d}"}))
            async for message in link:
                if isinstance(message, str) and message.startswith('{"pane":"question"'):
                    name = json.loads(message)["data"]["id"]
                    if name in put:
                        late.append(1000 * (time.perf_counter() - put[name]))

    async def all_of_them(console: WebConsole) -> None:
        watching = [asyncio.create_task(watch(console, n)) for n in range(VIEWERS)]
        await asyncio.sleep(1.0)
        flight = asyncio.create_task(asyncio.to_thread(fly, console))
        await flight
        await asyncio.sleep(1.0)
        for one in watching:
            one.cancel()
        await asyncio.gather(*watching, return_exceptions=True)

    def fly(console: WebConsole) -> None:
        for n in range(int(VIEWED_S * 10)):
            time_s = round(n / 10, 2)
            vehicle = VehicleState(
                time_s=time_s, position_m=(n * 0.01, 0.0, 1.0), velocity_mps=(0.1, 0.0, 0.0), yaw_rad=0.0
            )
            console.record(Stepped(input=Ticked(time_s=time_s, vehicle=vehicle), directives=(), digest=""))
            if n % 2 == 0:
                frame = Frame(
                    time_s=time_s, rgb=picture.copy(), depth_m=depth.copy(), camera=camera, world_from_camera=np.eye(4)
                )
                console.record(FrameSeen(index=n, frame=frame, detections=()))
            if n % 20 == 10:
                question = replace(
                    Question(query=GO_QUERY, text="Shall I fly?", yes_means="I fly", no_means="I stay", gaps=(GO_GAP,)),
                    id=f"q{n}",
                )
                put[question.id] = time.perf_counter()
                console.show(question, 30.0)
            if n % 20 == 19:
                console.withdraw(f"q{n - 9}", "it was answered")
            time.sleep(0.1)

    with made() as console:
        asyncio.run(all_of_them(console))
    return late, VIEWERS * len(put) - len(late)


def log_size() -> tuple[float, float]:
    """Bytes of both logs without pictures, and mission seconds, of a demo mission in the kinematic simulator."""
    with tempfile.TemporaryDirectory() as folder:
        run_mission(demo_path(DEMOS[0]), vehicle="kinematic", out=Path(folder) / "run")
        info = log_info(Path(folder) / "run")
        size = sum((Path(folder) / "run" / name).stat().st_size for name in (EVENTS_FILE, MCAP_FILE))
        return float(size), info.seconds


@dataclass(frozen=True, kw_only=True)
class Reaction:
    """What the drone did after a key was pressed, milliseconds from the key."""

    changes: float
    """It brakes, or sets out."""
    rests: float
    """It has braked; 0 where it was at rest."""
    flies: float
    """It sets out."""


def to_motion(browser: Browser, mission: str, patience_ms: int) -> Reaction:
    """Answers all questions with yes, so long after each is shown, and times what follows the last one."""
    consoles: list[WebConsole] = []
    served = threading.Event()
    at: list[tuple[str, float]] = []

    def operator(talk: Talk) -> WebConsole:
        consoles.append(WebConsole(understand=talk.understand, order_of=talk.order_of))
        served.set()
        consoles[0].wait_for_somebody(60.0)
        return consoles[0]

    def note(event: Event) -> None:
        if isinstance(event, Stepped):
            done = [name for name in event.directives if name in ("Move", "Brake")]
            done += ["Ended"] if isinstance(event.input, MotionEnded) else []
            at.extend((name, time.perf_counter()) for name in done)
        consoles[0].record(event)

    flight = threading.Thread(
        target=lambda: run_mission(demo_path(mission), vehicle="kinematic", operator=operator, progress=note)
    )
    flight.start()
    served.wait()
    page = browser.new_page()
    page.goto(consoles[0].url())
    pressed = 0.0
    while flight.is_alive() and not (pressed and any(what == "Move" and when > pressed for what, when in at)):
        if page.query_selector("#card .answer:not(:disabled)"):
            page.wait_for_timeout(patience_ms)
            pressed = time.perf_counter()
            page.keyboard.press("y")
        page.wait_for_timeout(300)
    after = [(what, 1000 * (when - pressed)) for what, when in at if when > pressed]
    flies = next(ms for what, ms in after if what == "Move")
    changes = next(ms for what, ms in after if what in ("Move", "Brake"))
    rests = max((ms for what, ms in after if what == "Ended" and changes < ms <= flies), default=0.0)
    page.click("#orders .abort")
    flight.join()
    page.close()
    consoles[0].close()
    return Reaction(changes=changes, rests=rests, flies=flies)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--motions", type=int, default=10, help="missions that are answered for each figure")
    motions_n = parser.parse_args().motions
    shipped = files("mintpilot.console").joinpath("static").iterdir()
    page_kb = sum(len(file.read_bytes()) for file in shipped) / 1000
    size, seconds = log_size()
    arrived, missed = viewers()
    late = np.asarray(arrived)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS)
        poses, share = latency(browser)
        motions = {
            (name, where): [to_motion(browser, name, ms) for _ in range(motions_n)]
            for name in DEMOS
            for where, ms in ANSWERED_MS.items()
        }
        browser.close()
    waits = [
        row
        for (name, where), found in motions.items()
        for row in (
            (f"key to brake or flight, {name}, {where}", [one.changes for one in found]),
            (f"key, or rest after braking, to flight, {name}, {where}", [one.flies - one.rests for one in found]),
            (f"key to flight with its braking, {name}, {where}", [one.flies for one in found if one.rests]),
        )
        if row[1]
    ]
    rows = [
        ("page, all files", "under 100 kB", f"{page_kb:.1f} kB", "1"),
        ("pose from simulator to browser, camera on", "p95 under 100 ms",
         f"p50 {np.percentile(poses, 50):.0f}, p95 {np.percentile(poses, 95):.0f} ms", f"{len(poses)}"),
        ("the program's share of one core at 10 Hz", "under 5 %", f"{100 * share:.1f} %", "1"),
        (f"question to each of {VIEWERS} viewers, {VIEWED_S:.0f} s", "none late",
         f"{(late > LATE_MS).sum() + missed} late; p50 {np.percentile(late, 50):.0f}, largest {late.max():.0f} ms",
         f"{len(late)}"),
        *((what, f"under {MOTION_MS:.0f} ms",
           f"median {np.median(ms):.0f}, largest {max(ms):.0f} ms", f"{len(ms)}") for what, ms in waits),
        ("both logs, per 60 s of mission, without pictures", "under 2 MB", f"{60e-6 * size / seconds:.2f} MB",
         f"1 ({seconds:.0f} s)"),
    ]  # fmt: skip
    for row in rows:
        print(" | ".join(row))
    keep(
        Section(
            name="59-console",
            title="Web console",
            command=f"python -m bench.console --motions {motions_n}",
            how="Headless Chromium and the program on one machine. Poses at 10 Hz, 320 x 240 pictures at 5 Hz; "
            "viewers are WebSocket clients, a question comes every 2 s, stands for 0.9 s, and is late after "
            f"{LATE_MS:.0f} ms, or where it was over before it came. Key to "
            "flight: the demo missions, kinematic; each question is answered by a key 0.7 s after it was shown (at "
            "once: most often the drone flies already while it waits) or after 10 s (it is where it waits). Who flies "
            f"brakes first, which takes {BRAKING_MS:.0f} ms from cruise speed at the acceleration that the vehicle may "
            f"use. Load average of the machine meanwhile: {os.getloadavg()[1]:.0f} on {os.cpu_count()} cores.",
            tables=[Table(caption="", header=("what", "must", "measured", "n"), rows=rows)],
            notes=[
                f"{sum(one > MOTION_MS for one in ms)} of {len(ms)} miss {MOTION_MS:.0f} ms: {what}."
                for what, ms in waits
                if max(ms) > MOTION_MS
            ],
        )
    )


if __name__ == "__main__":
    main()
