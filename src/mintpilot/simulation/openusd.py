"""A scene as OpenUSD for NVIDIA Isaac Sim: what MuJoCo flies in, with physics, colliders, lights, camera and labels.

Everything is taken from the compiled MuJoCo world, so that both hold the same bodies. Z up, metres, kilograms. Solids
that come into the world later are left out; clouds have no body, and nothing says whether they are toxic.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np

from mintpilot.core.geometry import Box, Vec3
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.openusd_parts import Stage, load_pxr
from mintpilot.simulation.quadrotor import DRONE, HULL, Airframe, add_quadrotor
from mintpilot.simulation.scene import FlightRules, Scene
from mintpilot.simulation.world import build_world, lamp_places

GRAVITY_MPS2 = 9.81
LAMP_NITS, FIRE_NITS = 8_000.0, 30_000.0
SMOKE_OPACITY = 0.25
_APERTURE_MM = 24.0
_CLIPPING_M = (0.04, 40.0)
_LATE = "late:"


def write_usd(scene: Scene, path: Path, *, rules: FlightRules | None = None, airframe: Airframe | None = None) -> None:
    """Writes the stage: ``.usda`` (text), ``.usdc`` or ``.usd`` (binary).

    Prims: ``/World/Building``, ``/World/Solids/<id>``, ``/World/Rooms/<id>``, ``/World/People/<id>``,
    ``/World/Smokes/<id>``, ``/World/Lights``, ``/World/Looks``, ``/World/PhysicsScene`` and the rigid body
    ``/World/Drone`` with its collider ``Hull``, the camera ``Rgbd`` and a frame for each rotor.

    Raises:
        MissingPartError: OpenUSD or MuJoCo is not installed.
    """
    rules, airframe = rules or FlightRules(), airframe or Airframe()
    stage = Stage(load_pxr())
    stage.physics_scene(GRAVITY_MPS2)
    model, data = _compiled(scene, rules, airframe)
    kinds = {solid.id: solid.kind for solid in scene.solids}
    stage.rigid_body("/World/Drone", scene.start_m, airframe.mass_kg, airframe.inertia_kgm2)
    for index in range(model.ngeom):
        _add_geom(stage, model, data, index, kinds, scene.start_m)
    _add_camera(stage, airframe)
    for index, (x, y, _) in enumerate(airframe.rotors):
        stage.frame(f"/World/Drone/Rotor_{index}", (x, y, 0.02))
    for smoke in scene.smokes:
        _add_smoke(stage, smoke.id, smoke.extent_m)
    _add_lights(stage, scene)
    stage.save(path)


def _compiled(scene: Scene, rules: FlightRules, airframe: Airframe) -> tuple[Any, Any]:
    mujoco = load_mujoco()
    spec = build_world(scene)
    add_quadrotor(spec, scene.start_m, rules=rules, airframe=airframe)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def _add_geom(stage: Stage, model: Any, data: Any, index: int, kinds: dict[str, str], start_m: Vec3) -> None:
    geom = model.geom(index)
    body = str(model.body(int(model.geom_bodyid[index])).name)
    name = str(geom.name)
    if body.startswith(_LATE):
        return
    flies = body == DRONE
    place = data.geom_xpos[index] - (np.asarray(start_m) if flies else 0.0)
    quaternion = np.empty(4)
    load_mujoco().mju_mat2Quat(quaternion, data.geom_xmat[index])
    parent, label = ("/World/Drone", "drone") if flies else _home_of(name, kinds)
    path = "/World/Drone/Hull" if name == HULL else f"{parent}/Part_{index}"
    material = int(model.geom_matid[index])
    stage.shape(
        path,
        kind=int(model.geom_type[index]),
        size=tuple(float(v) for v in model.geom_size[index]),
        place=tuple(float(v) for v in place),
        quaternion=tuple(float(v) for v in quaternion),
        label=label,
        collides=bool(model.geom_contype[index] or model.geom_conaffinity[index]),
        seen=name != HULL and float(_colour(model, index)[3]) > 0,
    )
    looks = str(model.mat(material).name) if material >= 0 else f"plain_{index}"
    stage.paint(path, looks, _colour(model, index), glows=looks == "lamp")


def _home_of(name: str, kinds: dict[str, str]) -> tuple[str, str]:
    """The parent prim of a geom of that name, and its semantic label."""
    what, _, rest = name.partition(":")
    thing = rest.rpartition(":")[0]
    match what:
        case "solid":
            return f"/World/Solids/{_prim_name(thing)}", kinds.get(thing, "thing")
        case "room":
            return f"/World/Rooms/{_prim_name(thing)}", "room"
        case "pane":
            return f"/World/Rooms/{_prim_name(rest)}", "pane"
        case "person":
            return f"/World/People/{_prim_name(thing)}", "person"
        case "lamp":
            return "/World/Building", "lamp"
    return "/World/Building", "building"


def _prim_name(text: str) -> str:
    """A name that OpenUSD takes, different for different texts."""
    return "_" + re.sub(r"[^A-Za-z0-9]", lambda found: f"_{ord(found[0]):x}_" if found[0] != "-" else "_", text)


def _colour(model: Any, index: int) -> tuple[float, float, float, float]:
    """Red, green, blue and opacity: the geom's own, its material's, or the mean of its texture."""
    material = int(model.geom_matid[index])
    rgba = model.geom_rgba[index] if material < 0 else model.mat_rgba[material]
    texture = int(model.mat_texid[material].max()) if material >= 0 else -1
    rgb = np.asarray(rgba[:3], float)
    if texture >= 0:
        first = int(model.tex_adr[texture])
        count = int(model.tex_height[texture] * model.tex_width[texture] * model.tex_nchannel[texture])
        rgb = rgb * model.tex_data[first : first + count].reshape(-1, 3).mean(axis=0) / 255
    red, green, blue = (float(v) for v in rgb)
    return red, green, blue, float(rgba[3])


def _add_camera(stage: Stage, airframe: Airframe) -> None:
    """The drone's RGB-D camera; both worlds look along -z, y up."""
    focal = _APERTURE_MM / 2 / math.tan(math.radians(airframe.camera_fovy_deg) / 2)
    sin, cos = math.sin(airframe.camera_pitch_rad), math.cos(airframe.camera_pitch_rad)
    axes = np.array(((0.0, -1.0, 0.0), (sin, 0.0, cos), (-cos, 0.0, sin)))
    stage.camera("/World/Drone/Rgbd", (0.16, 0.0, -0.02), axes, focal, _APERTURE_MM, _CLIPPING_M)


def _add_smoke(stage: Stage, name: str, extent: Box) -> None:
    path = f"/World/Smokes/{_prim_name(name)}"
    x, y, z = (edge / 2 for edge in extent.size_m)
    box = int(load_mujoco().mjtGeom.mjGEOM_BOX)
    stage.shape(
        path, kind=box, size=(x, y, z), place=extent.centre_m, quaternion=(1.0, 0.0, 0.0, 0.0), label="smoke",
        collides=False, seen=True,
    )  # fmt: skip
    stage.paint(path, "smoke", (0.5, 0.5, 0.5, SMOKE_OPACITY), glows=False)


def _add_lights(stage: Stage, scene: Scene) -> None:
    for index, place in enumerate(lamp_places(scene.volume)):
        stage.panel_light(f"/World/Lights/Lamp_{index}", place, (1.2, 0.25), LAMP_NITS)
    for index, fire in enumerate(solid for solid in scene.solids if solid.kind == "fire"):
        x, y, _ = fire.extent_m.centre_m
        stage.ball_light(
            f"/World/Lights/Fire_{index}", (x, y, fire.extent_m.hi_m[2]), 0.25, FIRE_NITS, (1.0, 0.45, 0.1)
        )
