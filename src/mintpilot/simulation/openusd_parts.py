"""Prims of OpenUSD, each made in the way that its validators and NVIDIA's physics accept."""

from __future__ import annotations

import math
import re
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from mintpilot.core.errors import MissingPartError, RecordError
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.simulation.engine import load_mujoco

_RINGS, _SEGMENTS = 8, 16
"""Of the mesh that stands for an ellipsoid: a sphere must not be scaled unevenly where it collides."""
FRICTION = 1.0
"""As MuJoCo's own default, so that things rest where they do there."""
Colour = tuple[float, float, float, float]


def load_pxr() -> Any:
    """The modules of OpenUSD by their names.

    Raises:
        MissingPartError: it is not installed.
    """
    try:
        names = ("Gf", "Sdf", "Usd", "UsdGeom", "UsdLux", "UsdPhysics", "UsdSemantics", "UsdShade", "Vt")
        return SimpleNamespace(**{name: import_module(f"pxr.{name}") for name in names})
    except ImportError:
        raise MissingPartError("writing OpenUSD needs usd-core; install it: pip install 'mintpilot[usd]'") from None


class Stage:
    """A stage in the making, in memory until it is saved.

    Args:
        pxr: what `load_pxr` returns.
    """

    def __init__(self, pxr: Any) -> None:
        self._p = pxr
        self._stage = pxr.Usd.Stage.CreateInMemory()
        pxr.UsdGeom.SetStageUpAxis(self._stage, pxr.UsdGeom.Tokens.z)
        pxr.UsdGeom.SetStageMetersPerUnit(self._stage, 1.0)
        pxr.UsdPhysics.SetStageKilogramsPerUnit(self._stage, 1.0)
        world = pxr.UsdGeom.Xform.Define(self._stage, "/World")
        self._stage.SetDefaultPrim(world.GetPrim())
        pxr.UsdGeom.Scope.Define(self._stage, "/World/Looks")
        pxr.UsdGeom.Xform.Define(self._stage, "/World/Lights")
        self._touch = pxr.UsdShade.Material.Define(self._stage, "/World/Looks/Touch")
        touch = pxr.UsdPhysics.MaterialAPI.Apply(self._touch.GetPrim())
        touch.CreateStaticFrictionAttr(FRICTION)
        touch.CreateDynamicFrictionAttr(FRICTION)
        touch.CreateRestitutionAttr(0.0)

    def physics_scene(self, gravity_mps2: float) -> None:
        """Gravity, down."""
        scene = self._p.UsdPhysics.Scene.Define(self._stage, "/World/PhysicsScene")
        scene.CreateGravityDirectionAttr(self._p.Gf.Vec3f(0, 0, -1))
        scene.CreateGravityMagnitudeAttr(gravity_mps2)

    def rigid_body(self, path: str, place: Vec3, mass_kg: float, inertia_kgm2: Vec3) -> None:
        """A body that moves; its shapes are its children."""
        p = self._p
        prim = self.frame(path, place).GetPrim()
        p.UsdPhysics.RigidBodyAPI.Apply(prim)
        mass = p.UsdPhysics.MassAPI.Apply(prim)
        mass.CreateMassAttr(mass_kg)
        mass.CreateDiagonalInertiaAttr(p.Gf.Vec3f(*inertia_kgm2))
        mass.CreatePrincipalAxesAttr(p.Gf.Quatf(1, 0, 0, 0))
        mass.CreateCenterOfMassAttr(p.Gf.Vec3f(0, 0, 0))

    def frame(self, path: str, place: Vec3) -> Any:
        """A place that things hang on."""
        frame = self._p.UsdGeom.Xform.Define(self._stage, path)
        frame.AddTranslateOp().Set(self._p.Gf.Vec3d(*place))
        return frame

    def shape(
        self,
        path: str,
        *,
        kind: int,
        size: tuple[float, ...],
        place: tuple[float, ...],
        quaternion: tuple[float, ...],
        label: str,
        collides: bool,
        seen: bool,
    ) -> None:
        """A shape as MuJoCo has it: its kind and half sizes, where it is and how it is turned (w, x, y, z)."""
        p = self._p
        self._parents(path)
        prim = self._geometry(path, kind, size)
        prim.AddTranslateOp().Set(p.Gf.Vec3d(*place))
        prim.AddOrientOp(p.UsdGeom.XformOp.PrecisionDouble).Set(p.Gf.Quatd(*quaternion))
        if kind == int(load_mujoco().mjtGeom.mjGEOM_BOX):
            prim.AddScaleOp().Set(p.Gf.Vec3f(*(2 * edge for edge in size)))
        p.UsdSemantics.LabelsAPI.Apply(prim.GetPrim(), "class").CreateLabelsAttr([label])
        if not seen:
            p.UsdGeom.Imageable(prim).CreatePurposeAttr(p.UsdGeom.Tokens.guide)
        if collides:
            p.UsdPhysics.CollisionAPI.Apply(prim.GetPrim())
            binding = p.UsdShade.MaterialBindingAPI.Apply(prim.GetPrim())
            binding.Bind(self._touch, p.UsdShade.Tokens.weakerThanDescendants, "physics")
            if prim.GetPrim().IsA(p.UsdGeom.Mesh):
                mesh = p.UsdPhysics.MeshCollisionAPI.Apply(prim.GetPrim())
                mesh.CreateApproximationAttr(p.UsdPhysics.Tokens.convexHull)

    def paint(self, path: str, looks: str, colour: Colour, *, glows: bool) -> None:
        """Gives a shape its material; equal names are one material."""
        p = self._p
        red, green, blue, opacity = colour
        name = f"/World/Looks/Look_{re.sub(r'[^A-Za-z0-9]', '_', looks)}"
        material = p.UsdShade.Material.Get(self._stage, name)
        if not material:
            material = p.UsdShade.Material.Define(self._stage, name)
            shader = p.UsdShade.Shader.Define(self._stage, f"{name}/Surface")
            shader.CreateIdAttr("UsdPreviewSurface")
            types, rgb = p.Sdf.ValueTypeNames, p.Gf.Vec3f(red, green, blue)
            shader.CreateInput("diffuseColor", types.Color3f).Set(rgb)
            shader.CreateInput("roughness", types.Float).Set(0.7)
            shader.CreateInput("opacity", types.Float).Set(opacity)
            if glows:
                shader.CreateInput("emissiveColor", types.Color3f).Set(rgb * 5)
            material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
        prim = self._stage.GetPrimAtPath(path)
        p.UsdGeom.Gprim(prim).CreateDisplayColorAttr([p.Gf.Vec3f(red, green, blue)])
        p.UsdShade.MaterialBindingAPI.Apply(prim).Bind(material)

    def camera(
        self, path: str, place: Vec3, axes: Floats, focal_mm: float, aperture_mm: float, clipping_m: tuple[float, float]
    ) -> None:
        """A camera of 4 by 3; ``axes`` (3, 3): its x, y and z axes, in rows."""
        p = self._p
        camera = p.UsdGeom.Camera.Define(self._stage, path)
        camera.CreateFocalLengthAttr(focal_mm)
        camera.CreateVerticalApertureAttr(aperture_mm)
        camera.CreateHorizontalApertureAttr(aperture_mm * 4 / 3)
        camera.CreateClippingRangeAttr(p.Gf.Vec2f(*clipping_m))
        turned = np.eye(4)
        turned[:3, :3], turned[3, :3] = axes, place
        camera.AddTransformOp().Set(p.Gf.Matrix4d(*turned.flatten().tolist()))

    def panel_light(self, path: str, place: Vec3, size: tuple[float, float], nits: float) -> None:
        """A lamp that shines down."""
        light = self._p.UsdLux.RectLight.Define(self._stage, path)
        light.CreateWidthAttr(size[0])
        light.CreateHeightAttr(size[1])
        x, y = size[0] / 2, size[1] / 2
        light.CreateExtentAttr(self._extent((x, y, 0.0)))
        self._lit(light, place, nits)

    def ball_light(self, path: str, place: Vec3, radius_m: float, nits: float, colour: Vec3) -> None:
        """A light that shines to all sides."""
        light = self._p.UsdLux.SphereLight.Define(self._stage, path)
        light.CreateRadiusAttr(radius_m)
        light.CreateColorAttr(self._p.Gf.Vec3f(*colour))
        light.CreateExtentAttr(self._extent((radius_m,) * 3))
        self._lit(light, place, nits)

    def save(self, path: Path) -> None:
        """Writes it. Raises `RecordError` where that cannot be."""
        try:
            self._stage.GetRootLayer().Export(str(path))
        except Exception as error:  # Tf.ErrorException, of which nothing is known before the import
            raise RecordError(f"cannot write {path}: {error}; choose another file with --out") from error

    def _lit(self, light: Any, place: Vec3, nits: float) -> None:
        light.CreateIntensityAttr(nits)
        light.AddTranslateOp().Set(self._p.Gf.Vec3d(*place))

    def _parents(self, path: str) -> None:
        parts = path.strip("/").split("/")
        for count in range(2, len(parts)):
            parent = "/" + "/".join(parts[:count])
            if not self._stage.GetPrimAtPath(parent):
                self._p.UsdGeom.Xform.Define(self._stage, parent)

    def _geometry(self, path: str, kind: int, size: tuple[float, ...]) -> Any:
        p, shapes = self._p, load_mujoco().mjtGeom
        radius, half = size[0], size[1]
        match kind:
            case shapes.mjGEOM_BOX:
                prim = p.UsdGeom.Cube.Define(self._stage, path)
                prim.CreateSizeAttr(1.0)
                extent = (0.5, 0.5, 0.5)
            case shapes.mjGEOM_SPHERE:
                prim = p.UsdGeom.Sphere.Define(self._stage, path)
                prim.CreateRadiusAttr(radius)
                extent = (radius,) * 3
            case shapes.mjGEOM_CYLINDER | shapes.mjGEOM_CAPSULE:
                round_end = kind == shapes.mjGEOM_CAPSULE
                define = p.UsdGeom.Capsule if round_end else p.UsdGeom.Cylinder
                prim = define.Define(self._stage, path)
                prim.CreateRadiusAttr(radius)
                prim.CreateHeightAttr(2 * half)
                prim.CreateAxisAttr(p.UsdGeom.Tokens.z)
                extent = (radius, radius, half + (radius if round_end else 0.0))
            case shapes.mjGEOM_ELLIPSOID:
                return self._ellipsoid(path, size)
            case _:
                raise RecordError(f"{path}: MuJoCo's shape {kind} has no counterpart in OpenUSD; make it of others")
        prim.CreateExtentAttr(self._extent(extent))
        return prim

    def _ellipsoid(self, path: str, size: tuple[float, ...]) -> Any:
        p = self._p
        points, counts, corners = _ball()
        mesh = p.UsdGeom.Mesh.Define(self._stage, path)
        mesh.CreatePointsAttr(p.Vt.Vec3fArray([p.Gf.Vec3f(*map(float, row)) for row in points * np.asarray(size)]))
        mesh.CreateFaceVertexCountsAttr(counts)
        mesh.CreateFaceVertexIndicesAttr(corners)
        mesh.CreateSubdivisionSchemeAttr(p.UsdGeom.Tokens.none)
        mesh.CreateExtentAttr(self._extent(size))
        return mesh

    def _extent(self, half: tuple[float, ...]) -> Any:
        p = self._p
        return p.Vt.Vec3fArray([p.Gf.Vec3f(*(-edge for edge in half)), p.Gf.Vec3f(*half)])


def _ball() -> tuple[Floats, list[int], list[int]]:
    """A ball of radius 1: points (n, 3), corners of each face, and which points they are."""
    rows = [(0.0, 0.0, 1.0)]
    for ring in range(1, _RINGS):
        polar = math.pi * ring / _RINGS
        for step in range(_SEGMENTS):
            turn = 2 * math.pi * step / _SEGMENTS
            rows.append((math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar)))
    rows.append((0.0, 0.0, -1.0))
    last, counts, corners = len(rows) - 1, [], []
    for step in range(_SEGMENTS):
        after = (step + 1) % _SEGMENTS
        lowest = 1 + (_RINGS - 2) * _SEGMENTS
        faces = [[0, 1 + step, 1 + after], [last, lowest + after, lowest + step]]
        for ring in range(_RINGS - 2):
            above, below = 1 + ring * _SEGMENTS, 1 + (ring + 1) * _SEGMENTS
            faces.append([above + step, below + step, below + after, above + after])
        counts += [len(face) for face in faces]
        corners += [corner for face in faces for corner in face]
    return np.asarray(rows), counts, corners
