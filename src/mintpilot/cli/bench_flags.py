"""The options that all experiments of ``mintpilot bench`` share."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from cyclopts import Parameter

from mintpilot.core.errors import InputError

Json: TypeAlias = Annotated[bool, Parameter(name="--json", negative="")]
Flag: TypeAlias = Annotated[bool, Parameter(negative="")]
VehicleName: TypeAlias = Literal["mujoco", "kinematic"]


@Parameter(name="*")
@dataclass(frozen=True, slots=True, kw_only=True)
class BenchFlags:
    """How trials are flown, and where their records go.

    Attributes:
        seed: Of the first world; the others follow.
        strategy: One more method to compare, e.g. of a plug-in; may be given several times.
        only: Fly and show this method alone; may be given several times. The others stay to be flown later.
        llm: Language model that may propose questions: template (none), embedded, endpoint, or one of a plug-in.
        jobs: Worker processes; with a local Ray, its workers.
        executor: Processes of this machine, or a Ray cluster.
        ray_address: Of a running cluster; without it a local one is started.
        time_limit: Seconds of computing after which a trial counts as failed. Default: 900 with MuJoCo, else 120.
        out: Folder of the records. Default: one under ./runs, named after the configuration.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    seed: int = 0
    strategy: Annotated[list[str], Parameter(name="--strategy", negative="")] = field(default_factory=list)
    only: Annotated[list[str], Parameter(name="--only", negative="")] = field(default_factory=list)
    llm: str = "template"
    jobs: int = 2
    executor: Literal["process", "ray"] = "process"
    ray_address: str = ""
    time_limit: float | None = None
    out: Path | None = None
    json: Json = False
    debug: Flag = False

    def check(self) -> None:
        """Says what does not fit together.

        Raises:
            InputError: with the option to change.
        """
        if self.jobs < 1:
            raise InputError(f"--jobs {self.jobs}: must be 1 or more")
        if self.ray_address and self.executor != "ray":
            raise InputError(f"--ray-address {self.ray_address} is for --executor ray; add that, or leave it out")
