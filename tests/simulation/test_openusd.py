"""Worlds as OpenUSD: all validators pass, MuJoCo's bodies are in them, and the drone rests alike in NVIDIA PhysX."""

import json
import math
import os
import subprocess
from pathlib import Path

import pytest

from mintpilot.cli.main import main
from mintpilot.core.errors import RecordError
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.openusd import write_usd
from mintpilot.simulation.quadrotor import DRONE, Airframe, add_quadrotor
from mintpilot.simulation.scenarios import make_scenario
from mintpilot.simulation.world import build_world

pytest.importorskip("mujoco", reason="needs MuJoCo")
pytest.importorskip("pxr", reason="needs usd-core")
pytestmark = pytest.mark.sim

SCENARIOS = ("fire-warehouse", "medicine-boxes")
REPOSITORY = Path(__file__).parents[2]
FALL_S = 4.0


def physx_python() -> Path:
    """The interpreter of the environment that scripts/physx.sh makes, or the one that MINTPILOT_PHYSX names."""
    return Path(os.environ.get("MINTPILOT_PHYSX", REPOSITORY / ".venv-physx" / "bin" / "python"))


@pytest.fixture(scope="module", params=SCENARIOS)
def written(request, tmp_path_factory):
    """A scenario and its stage."""
    scenario = make_scenario(request.param, 0)
    path = tmp_path_factory.mktemp("usd") / f"{request.param}.usda"
    write_usd(scenario.scene, path, rules=scenario.rules)
    return scenario, path


def faults(stage):
    from pxr import UsdValidation

    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) >= 20
    return UsdValidation.ValidationContext(validators).Validate(stage)


@pytest.mark.long
def test_every_validator_passes(written):
    from pxr import Usd

    found = faults(Usd.Stage.Open(str(written[1])))
    assert not found, [(fault.GetName(), fault.GetMessage()) for fault in found]


@pytest.mark.long
def test_the_validators_do_find_faults(written):
    from pxr import Gf, Usd, UsdGeom, UsdPhysics

    stage = Usd.Stage.Open(str(written[1]))
    ball = UsdGeom.Sphere.Define(stage, "/World/Ball")
    ball.AddScaleOp().Set(Gf.Vec3f(1, 2, 3))
    UsdPhysics.CollisionAPI.Apply(ball.GetPrim())
    assert faults(stage)


@pytest.mark.long
def test_it_holds_what_mujoco_holds(written):
    from pxr import Gf, Usd, UsdGeom, UsdPhysics

    scenario, path = written
    spec = build_world(scenario.scene)
    add_quadrotor(spec, scenario.scene.start_m, rules=scenario.rules)
    model = spec.compile()
    data = load_mujoco().MjData(model)
    load_mujoco().mj_forward(model, data)
    stage = Usd.Stage.Open(str(path))
    places = UsdGeom.XformCache()
    checked = colliders = 0
    for index in range(model.ngeom):
        name = "Hull" if model.geom(index).name == "drone:hull" else f"Part_{index}"
        prim = next(prim for prim in stage.Traverse() if prim.GetName() == name)
        place = places.GetLocalToWorldTransform(prim).ExtractTranslation()
        assert math.dist(place, data.geom_xpos[index]) < 1e-5, name
        collides = bool(model.geom_contype[index] or model.geom_conaffinity[index])
        assert prim.HasAPI(UsdPhysics.CollisionAPI) == collides, name
        checked, colliders = checked + 1, colliders + collides
    assert checked > colliders > 20
    camera = UsdGeom.Camera(stage.GetPrimAtPath("/World/Drone/Rgbd"))
    seen = camera.GetCamera(Usd.TimeCode.Default())
    assert seen.GetFieldOfView(Gf.Camera.FOVVertical) == pytest.approx(Airframe().camera_fovy_deg, abs=1e-3)
    looks = places.GetLocalToWorldTransform(camera.GetPrim()).TransformDir(Gf.Vec3d(0, 0, -1))
    matrix = data.cam_xmat[model.camera("rgbd").id].reshape(3, 3)
    assert math.dist(looks, -matrix[:, 2]) < 1e-6


def test_things_are_labelled_and_nothing_tells_the_truth_about_smoke(written):
    from pxr import Usd, UsdSemantics

    scenario, path = written
    stage = Usd.Stage.Open(str(path))
    labels = {
        label
        for prim in stage.Traverse()
        if prim.HasAPI(UsdSemantics.LabelsAPI)
        for label in UsdSemantics.LabelsAPI(prim, "class").GetLabelsAttr().Get()
    }
    wanted = {solid.kind for solid in scenario.scene.solids if not solid.appears_s} | {"drone", "building"}
    wanted |= {"smoke"} if scenario.scene.smokes else set()
    assert wanted <= labels
    assert "toxic" not in path.read_text()


def test_the_command_writes_it(tmp_path, capsys):
    path = tmp_path / "boxes.usdc"
    assert main(["export", "medicine-boxes", "--to", "usd", "--out", str(path)]) == 0
    assert path.read_bytes().startswith(b"PXR-USDC")
    assert main(["export", "medicine-boxes", "--to", "usd", "--out", str(tmp_path / "boxes.obj")]) != 0
    assert ".usda" in capsys.readouterr().err


@pytest.mark.long
def test_a_place_that_cannot_be_written_is_told(written, tmp_path):
    with pytest.raises(RecordError, match="choose another file"):
        write_usd(written[0].scene, tmp_path / "no" / "folder" / "\0.usda")


@pytest.mark.slow
def test_the_drone_falls_and_rests_where_mujocos_does(written):
    if not physx_python().exists():
        pytest.skip("needs NVIDIA PhysX in an environment of its own: scripts/physx.sh")
    scenario, path = written
    script = Path(__file__).with_name("physx_fall.py")
    said = subprocess.run(
        [physx_python(), script, path, str(FALL_S)], capture_output=True, text=True, check=True, timeout=300
    )
    physx = json.loads(said.stdout.strip().splitlines()[-1])
    mujoco, spec = load_mujoco(), build_world(scenario.scene)
    add_quadrotor(spec, scenario.scene.start_m, rules=scenario.rules)
    model = spec.compile()
    data = mujoco.MjData(model)
    while data.time < FALL_S:
        mujoco.mj_step(model, data)
    here = [float(v) for v in data.body(DRONE).xpos]
    assert scenario.scene.start_m[2] - here[2] > 0.5, "it fell"
    assert physx["speed_mps"] < 0.01
    assert math.dist(physx["position_m"], here) < 0.02
