"""One trial: a mission in a simulator with its faults, and what the monitors say of it."""

from __future__ import annotations

import traceback
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from mintpilot.assembly.components import components_for
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World, build_world
from mintpilot.conformance.faults import surroundings
from mintpilot.conformance.faults.adapters import stage_for
from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.faulty_operator import hostile_words
from mintpilot.conformance.faults.kinds import FaultKind
from mintpilot.conformance.faults.ledger import Counter, Ledger
from mintpilot.conformance.faults.monitors import Breach, ended_in_time, judged, safe_after
from mintpilot.conformance.faults.records import BreachRecord, FaultRecord
from mintpilot.conformance.faults.records_kept import kept, replays
from mintpilot.conformance.sample import sample_world
from mintpilot.core.mission import Verdict
from mintpilot.mission.components import MissionComponents
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_world import ScenarioWorld
from mintpilot.models.doubles import FunctionModel
from mintpilot.recording.recorders import TeeRecorder
from mintpilot.recording.run_folder import RunFolder
from mintpilot.simulation.scenarios import make_scenario

REPLAYED = 20
"""Every so many-th trial is thought through again from its record."""


@dataclass(slots=True)
class Trial:
    """One trial; what it has come to so far outlives an exception."""

    draw: Draw
    folder: Path
    """For its run; made."""
    written: Counter

    def fly(self) -> FaultRecord:
        """Flies and judges. Never raises for what the mission does: that is its own breach."""
        world, ledger = world_of(self.draw), Ledger()
        run, verdict, raised = self.folder / "run", None, ""
        disk = surroundings.Disk(self.draw, ledger, run, self.written)
        try:
            with self._components(world, ledger, run, disk) as made:
                surroundings.shorten_memory(self.draw)
                verdict = fly_mission(made)
        except MemoryError:
            raised = "MemoryError"
        except Exception as error:
            frame = traceback.extract_tb(error.__traceback__)[-1]
            raised = f"{type(error).__name__}: {error} ({Path(frame.filename).name}:{frame.lineno})"
        return self._judged(world, ledger, verdict, raised, self.written.refused)

    def _judged(self, world: World, ledger: Ledger, verdict: Verdict | None, raised: str, refused: int) -> FaultRecord:
        run = self.folder / "run"
        breaches = [*judged(ledger, world, verdict), *ended_in_time(ledger, self.draw.faults)]
        if raised and raised != "MemoryError":
            breaches.append(Breach(rule="raised", what=raised))
        if raised and not ledger.held:
            breaches.append(Breach(rule="left flying", what=f"after {raised}"))
        breaches += kept(run, written=self.written.get(), refused=refused, verdict=verdict)
        thought = self.draw.first(FaultKind.THINKING_FAILS) is None  # what was lost then is worked out in a replay
        if self.draw.number % REPLAYED == 0 and verdict is not None and not refused and thought:
            breaches += replays(run)
        return record_of(
            self.draw,
            outcome=verdict.outcome.value if verdict is not None else "raised",
            breaches=breaches,
            safe_s=tuple((kind, round(safe_after(ledger, at_s), 3)) for at_s, kind, _ in ledger.known[:20]),
            events=self.written.get(),
            mission_s=ledger.now_s,
        )

    @contextmanager
    def _components(
        self, world: World, ledger: Ledger, run: Path, disk: surroundings.Disk
    ) -> Iterator[MissionComponents]:
        draw = self.draw
        hostile = draw.first(FaultKind.MODEL_HOSTILE)
        rng = np.random.default_rng([draw.number, 5])
        talk = Talk() if hostile is None else Talk(model=FunctionModel(lambda _: hostile_words(rng)), name="hostile")
        with ExitStack() as stack:
            stack.enter_context(disk.failing())
            folder = RunFolder(run, config={}, clock=surroundings.wall_clock(draw))
            if draw.number % REPLAYED == 0:
                stack.callback(folder.close)  # with its report, which takes a second
            stage = stack.enter_context(stage_for(draw.adapter)(draw, world, ledger, talk))
            counted = surroundings.CountingRecorder(folder, self.written, draw, ledger)
            recorder = TeeRecorder(counted, *stage.recorders)
            parts = components_for(
                world, stage.choices, operators=stage.operators, recorder=recorder, talk=talk, digests=True
            )
            made = stage.beset(stack.enter_context(parts))
            seeing = any(f.kind in (FaultKind.CAMERA_GONE, FaultKind.CAMERA_FROZEN, FaultKind.DEPTH_WRONG)
                         for f in draw.faults)  # fmt: skip
            worker = made.worker
            yield replace(
                made,
                worker=lambda parts: surroundings.FaultyWorker(worker(parts), draw, ledger),
                watch_map=made.watch_map or seeing,
            )


def record_of(draw: Draw, *, outcome: str, breaches: list[Breach], **figures: object) -> FaultRecord:
    """The record of a trial."""
    return FaultRecord.model_validate(
        {
            "adapter": draw.adapter,
            "number": draw.number,
            "world": draw.world,
            "faults": tuple(fault.kind for fault in draw.faults),
            "outcome": outcome,
            "breaches": tuple(BreachRecord(rule=one.rule, what=one.what) for one in breaches),
            **figures,
        }
    )


def world_of(draw: Draw) -> World:
    """The world of a trial: the sample, or one of a generator."""
    if draw.world == "sample":
        return replace(sample_world(), seed=draw.world_seed)
    name = draw.world.removesuffix("-dark")
    parameters = {"smokes": 2, "rooms": 2} if draw.world != name else {}
    return _scenario(name, tuple(parameters.items()), draw.world_seed)


@cache
def _scenario(name: str, parameters: tuple[tuple[str, int], ...], seed: int) -> World:
    world = ScenarioWorld.model_validate({"scenario": name, "parameters": dict(parameters)})
    words = make_scenario(name, 0).mission.instruction
    file = MissionFile(mintpilot=1, name=name, instruction=words, world=world)
    return build_world(file, base=Path.cwd(), seed=seed)
