"""``mintpilot policy``."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from cyclopts import App

from mintpilot.cli.bench_flags import Flag
from mintpilot.cli.exits import EPILOGUE, ExitCode, guarded

policy = App(
    name="policy",
    help="Policies that are learned: values of actions on the grid of a mission.",
    help_epilogue=EPILOGUE,
    help_format="plaintext",
    result_action="return_value",
)


@policy.command
def learn(
    mission: Path,
    /,
    *,
    out: Path,
    transitions: int = 20_000_000,
    seed: int = 0,
    debug: Flag = False,
) -> ExitCode:
    """Learn to fly a mission by Q-learning: every goal, under every joint hypothesis of its regions. Takes minutes.

    Fly by it with: mintpilot run MISSION --planner policy:FILE. It holds for this mission's map and goals.

    Args:
        mission: The mission file (YAML).
        out: Where the policy is written, as .npz.
        transitions: Moves that are made and learned from. More moves, better values.
        seed: Of the world, and of what is drawn at random. The same seed gives the same values.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.assembly.learning import mission_grid
        from mintpilot.policies.files import save_policy
        from mintpilot.policies.q_learning import Training
        from mintpilot.policies.q_learning import learn as learned

        grid = mission_grid(mission, seed=seed)
        size = f"{grid.free.size} cells, {grid.masks} joint hypotheses, {len(grid.goals)} goals"
        print(f"Learning: {size}, {transitions} transitions.", file=sys.stderr, flush=True)
        begun = time.perf_counter()
        save_policy(out, learned(grid, Training(transitions=transitions, seed=seed)))
        print(f"{out}: learned in {time.perf_counter() - begun:.0f} s")
        return ExitCode.SUCCESS

    return guarded(work, as_json=False, debug=debug)
