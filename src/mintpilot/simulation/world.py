"""A scene made into a MuJoCo world, procedurally: shell, racks, walls, rooms, people, fire, lamps.

Everything that a drone can hit lies inside the extents of the scene, so both simulators fly in the same world. Beams,
lamps and the closed ceiling lie above the volume. Clouds and flames have no geometry: `smoke` marches them over the
picture and the depth.
"""

from __future__ import annotations

from typing import Any

from mintpilot.core.geometry import Box, Vec3
from mintpilot.simulation import props, rooms
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.materials import add_materials
from mintpilot.simulation.scene import Scene, Solid

CEILING_GAP_M = 0.45
"""Between the top of the volume and the ceiling: beams and lamps hang here."""
_GLOWS = 3
"""Fires that light the hall: the drawing library takes eight lights, four are lamps, one is the camera's."""
SHELL_M = 0.2
_FAR_BELOW_M = 60.0


def build_world(scene: Scene) -> Any:
    """The world of a scene as an editable ``mujoco.MjSpec``; the caller may add a drone before compiling it.

    Geoms of a solid are named ``solid:<id>:<n>``, those of a person ``person:<id>:<n>``, of a room ``room:<id>:<n>``.
    Cameras: ``overview`` (from a corner) and ``plan`` (from above). Group 3 holds the ceiling, which pictures from
    above leave out; group 4 holds shapes that collide but are not drawn.

    Raises:
        MissingPartError: MuJoCo is not installed.
    """
    mujoco = load_mujoco()
    spec = mujoco.MjSpec()
    spec.modelname = scene.name
    _set_options(spec, scene, mujoco)
    add_materials(spec, mujoco)
    maker = props.Maker(mujoco=mujoco, body=spec.worldbody, prefix="shell")
    _add_shell(maker, scene.volume)
    _add_lights(spec, scene, mujoco)
    for index, solid in enumerate(scene.solids):
        body = spec.worldbody if solid.appears_s <= 0 else _hidden_body(spec, solid)
        props.add_solid(
            props.Maker(mujoco=mujoco, body=body, prefix=f"solid:{solid.id}"), solid, scene.seed * 1009 + index
        )
    for room in scene.rooms:
        rooms.add_room(props.Maker(mujoco=mujoco, body=spec.worldbody, prefix=f"room:{room.id}"), room)
    persons = [*scene.persons, *(room.occupant for room in scene.rooms if room.occupant is not None)]
    for index, person in enumerate(persons):
        rooms.add_person(spec, mujoco, person, scene.seed + index)
    _add_cameras(spec, scene.volume)
    return spec


def place_late_solids(model: Any, data: Any, scene: Scene, time_s: float) -> None:
    """Brings solids with ``appears_s`` into the world when their time has come; call before stepping or drawing.

    Args:
        model: the compiled world.
        data: its state; only the places of such solids are changed.
        scene: the scene the world was built from.
        time_s: seconds of mission flight.
    """
    for solid in scene.solids:
        if solid.appears_s > 0:
            body = model.body(f"late:{solid.id}").mocapid[0]
            data.mocap_pos[body] = (0.0, 0.0, 0.0 if time_s >= solid.appears_s else -_FAR_BELOW_M)


def _hidden_body(spec: Any, solid: Solid) -> Any:
    return spec.worldbody.add_body(name=f"late:{solid.id}", mocap=True, pos=[0.0, 0.0, -_FAR_BELOW_M])


def _set_options(spec: Any, scene: Scene, mujoco: Any) -> None:
    spec.option.timestep = 0.004
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1280, 960
    spec.visual.quality.shadowsize = 2048
    spec.visual.quality.offsamples = 4
    spec.visual.map.znear, spec.visual.map.zfar = 0.002, 3.0
    spec.stat.extent = max(scene.volume.size_m)
    spec.stat.center = scene.volume.centre_m
    spec.visual.headlight.ambient = [0.30] * 3
    spec.visual.headlight.diffuse = [0.22] * 3
    spec.visual.headlight.specular = [0.0] * 3


def _add_shell(maker: props.Maker, volume: Box) -> None:
    """Floor, four walls up to a closed ceiling, and beams above the volume."""
    (x0, y0, z0), (x1, y1, z1) = volume.lo_m, volume.hi_m
    top, t = z1 + CEILING_GAP_M, SHELL_M
    maker.box(Box(lo_m=(x0 - t, y0 - t, z0 - t), hi_m=(x1 + t, y1 + t, z0)), "concrete")
    for lo, hi in (
        ((x0 - t, y0 - t), (x0, y1 + t)),
        ((x1, y0 - t), (x1 + t, y1 + t)),
        ((x0, y0 - t), (x1, y0)),
        ((x0, y1), (x1, y1 + t)),
    ):
        maker.box(Box(lo_m=(*lo, z0), hi_m=(*hi, top)), "corrugated")
    maker.box(Box(lo_m=(x0 - t, y0 - t, top), hi_m=(x1 + t, y1 + t, top + t)), "ceiling", group=props.CEILING_GROUP)
    count = max(2, round((x1 - x0) / 4.0))
    for i in range(1, count):
        x = x0 + (x1 - x0) * i / count
        maker.box(Box(lo_m=(x - 0.08, y0, z1 + 0.2), hi_m=(x + 0.08, y1, top)), "beam", group=props.CEILING_GROUP)


def lamp_places(volume: Box) -> list[Vec3]:
    """Where the lamps hang, below the ceiling."""
    (x0, y0, _), (x1, y1, z1) = volume.lo_m, volume.hi_m
    return [(x0 + (x1 - x0) * i, y0 + (y1 - y0) * j, z1 + 0.18) for i in (0.25, 0.75) for j in (0.25, 0.75)]


def _add_lights(spec: Any, scene: Scene, mujoco: Any) -> None:
    """Ceiling lamps, of which one throws shadows, and the glow of each fire."""
    maker = props.Maker(mujoco=mujoco, body=spec.worldbody, prefix="lamp")
    for i, (x, y, z) in enumerate(lamp_places(scene.volume)):
        spec.worldbody.add_light(
            name=f"lamp:{i}",
            pos=[x, y, z - 0.1],
            dir=[0, 0, -1],
            castshadow=i == 0,
            diffuse=[0.62, 0.60, 0.56],
            specular=[0.05] * 3,
            attenuation=[1, 0.02, 0.01],
            cutoff=80,
            exponent=1,
            type=mujoco.mjtLightType.mjLIGHT_SPOT,
        )
        lamp = Box(lo_m=(x - 0.6, y - 0.1, z - 0.06), hi_m=(x + 0.6, y + 0.1, z))
        maker.box(lamp, "lamp", group=props.CEILING_GROUP, solid=False)
    for solid in [s for s in scene.solids if s.kind == "fire"][:_GLOWS]:
        x, y, _ = solid.extent_m.centre_m
        spec.worldbody.add_light(
            name=f"glow:{solid.id}",
            pos=[x, y, solid.extent_m.hi_m[2]],
            castshadow=False,
            diffuse=[0.9, 0.42, 0.1],
            specular=[0.0] * 3,
            attenuation=[1, 0.1, 0.15],
            type=mujoco.mjtLightType.mjLIGHT_POINT,
        )


def _add_cameras(spec: Any, volume: Box) -> None:
    """``overview``: from the south-west corner under the roof; ``plan``: from above, north up."""
    (x0, y0, _), (x1, y1, z1) = volume.lo_m, volume.hi_m
    cx, cy, _ = volume.centre_m
    spec.worldbody.add_camera(
        name="overview",
        pos=[x0 + 0.4, y0 + 0.4, z1 - 0.3],
        fovy=72,
        xyaxes=_looking((x1 - x0, y1 - y0, -0.55 * (y1 - y0))),
    )
    height = 2.5 * max(y1 - y0, 0.58 * (x1 - x0))
    spec.worldbody.add_camera(name="plan", pos=[cx, cy, z1 + height], fovy=24, xyaxes=[1, 0, 0, 0, 1, 0])


def _looking(direction: Vec3) -> list[float]:
    """The camera's x and y axes (six numbers) for a view along ``direction`` with the horizon level."""
    dx, dy, dz = direction
    flat = (dx * dx + dy * dy) ** 0.5
    right = (dy / flat, -dx / flat, 0.0)
    up = (-dx * dz / flat, -dy * dz / flat, flat)
    return [*right, *up]
