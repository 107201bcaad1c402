"""Run by an environment that has ovphysx: lets the drone of a stage fall in NVIDIA PhysX and prints where it rests.

``python physx_fall.py STAGE SECONDS`` → ``{"position_m": [x, y, z], "speed_mps": …}``. On the CPU.
"""

import json
import sys

import numpy as np
import ovphysx
import ovstage
from ovphysx import PhysX
from ovphysx.samples.python_samples.schema_support import physx_schema_paths
from ovphysx.types import TensorType

STEP_S = 1 / 240


def fallen(path: str, seconds: float) -> dict:
    """Where the drone is after that time, and how fast."""
    PhysX.set_cpu_mode(True)
    physx = PhysX()
    schemas = [*(str(path) for path in physx_schema_paths()), str(ovphysx.newton_schema_root())]
    ovstage.population.register_usd_schemas(schemas)
    stage = ovstage.Stage("fall")
    ovstage.population.open_usd(stage, path, ordinal=1, domains=ovstage.PopulationDomain.ALL)
    stage.advance_write_floor(ordinal=1).wait()
    physx.wait_task(physx.attach_ovstage(stage, read_ordinal=1))
    pose, velocity = (
        physx.create_tensor_binding(pattern="/World/Drone", tensor_type=kind, raise_if_empty=True)
        for kind in (TensorType.RIGID_BODY_POSE, TensorType.RIGID_BODY_VELOCITY)
    )
    for _ in range(round(seconds / STEP_S)):
        physx.step_sync(STEP_S)
    places, speeds = np.zeros(pose.shape, np.float32), np.zeros(velocity.shape, np.float32)
    pose.read(places)
    velocity.read(speeds)
    return {
        "position_m": [float(v) for v in places[0, :3]],
        "speed_mps": float(np.linalg.norm(speeds[0, :3])),
    }


if __name__ == "__main__":
    print(json.dumps(fallen(sys.argv[1], float(sys.argv[2]))))
