"""The web console in figures: pose latency, answer to next motion, share of a core, size of the page.

    python -m bench.console

Poses come at 10 Hz and pictures at 5 Hz; a headless Chromium notes when each pose arrives.
"""

from __future__ import annotations

import threading
import time
from importlib.resources import files

import numpy as np
from playwright.sync_api import Browser, sync_playwright

from mintpilot import run_mission
from mintpilot.assembly.talk import Talk
from mintpilot.cli.demos import DEMOS, demo_path
from mintpilot.console import WebConsole
from mintpilot.core.events import Event, FrameSeen, Stepped
from mintpilot.core.inputs import Ticked
from mintpilot.core.observation import CameraModel, Frame
from mintpilot.core.trajectory import VehicleState

SECONDS = 20.0
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


def to_motion(browser: Browser, mission: str) -> float:
    """Milliseconds from the press of a key to the next motion, in a demo mission."""
    consoles: list[WebConsole] = []
    served, moved = threading.Event(), []

    def operator(talk: Talk) -> WebConsole:
        consoles.append(WebConsole(understand=talk.understand, order_of=talk.order_of))
        served.set()
        consoles[0].wait_for_somebody(60.0)
        return consoles[0]

    def note(event: Event) -> None:
        if isinstance(event, Stepped) and "Move" in event.directives:
            moved.append(time.perf_counter())
        consoles[0].record(event)

    flight = threading.Thread(
        target=lambda: run_mission(demo_path(mission), vehicle="kinematic", operator=operator, progress=note)
    )
    flight.start()
    served.wait()
    page = browser.new_page()
    page.goto(consoles[0].url())
    pressed = 0.0
    while flight.is_alive() and not (pressed and any(at > pressed for at in moved)):
        if page.query_selector("#card .answer:not(:disabled)"):
            page.wait_for_timeout(700)
            pressed = time.perf_counter()
            page.keyboard.press("y")
        page.wait_for_timeout(300)
    found = 1000 * min(at - pressed for at in moved if at > pressed)
    page.click("#orders .abort")
    flight.join()
    page.close()
    consoles[0].close()
    return found


def main() -> None:
    shipped = files("mintpilot.console").joinpath("static").iterdir()
    print(f"page: {sum(len(file.read_bytes()) for file in shipped) / 1000:.1f} kB")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS)
        poses, share = latency(browser)
        print(
            f"pose from simulator to browser: p50 {np.percentile(poses, 50):.0f} ms, p95 "
            f"{np.percentile(poses, 95):.0f} ms (n {len(poses)}); share of one core {100 * share:.1f} %"
        )
        print("answer to next motion:", ", ".join(f"{to_motion(browser, name):.0f} ms" for name in DEMOS))
        browser.close()


if __name__ == "__main__":
    main()
