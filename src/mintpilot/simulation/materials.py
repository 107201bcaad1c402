"""Materials of the world: textured surfaces, plain colours, glowing things."""

from __future__ import annotations

from typing import Any

import numpy as np

from mintpilot.simulation.textures import SIZE_PX, texture

COLOURS: dict[str, tuple[float, float, float]] = {
    "red": (0.78, 0.05, 0.05),
    "blue": (0.05, 0.16, 0.75),
    "green": (0.04, 0.52, 0.12),
    "yellow": (0.90, 0.80, 0.05),
    "black": (0.03, 0.03, 0.035),
    "white": (0.93, 0.93, 0.93),
    "orange": (0.95, 0.42, 0.03),
    "purple": (0.42, 0.08, 0.62),
}
"""Plain colour words of solids, as red, green, blue from 0 to 1; well apart in hue or in lightness."""

# name: (texture, metres a tile covers, shininess)
_TEXTURED = {
    "concrete": ("concrete", 2.0, 0.1),
    "corrugated": ("corrugated", 2.5, 0.1),
    "brick": ("brick", 1.6, 0.05),
    "plaster": ("plaster", 2.6, 0.05),
    "ceiling": ("metal", 4.0, 0.05),
    "beam": ("metal", 2.0, 0.1),
    "metal": ("metal", 1.0, 0.3),
    "hazard": ("hazard", 0.6, 0.1),
}
_CUBES = {"cardboard": "cardboard", "wood": "wood", "char": "char"}
_PLAIN: dict[str, tuple[float, float, float, float]] = {
    "skin": (0.86, 0.62, 0.50, 1),
    "hair": (0.14, 0.09, 0.06, 1),
    "shirt-orange": (0.93, 0.45, 0.05, 1),
    "shirt-green": (0.30, 0.55, 0.35, 1),
    "trousers": (0.12, 0.17, 0.36, 1),
    "shoe": (0.08, 0.07, 0.07, 1),
    "blood": (0.45, 0.02, 0.02, 1),
    "upright": (0.08, 0.18, 0.46, 1),
    "rack-beam": (0.92, 0.38, 0.04, 1),
    "door": (0.36, 0.20, 0.10, 1),
    "door-frame": (0.20, 0.12, 0.07, 1),
    "handle": (0.80, 0.80, 0.82, 1),
    "pane": (0.30, 0.38, 0.42, 1),
    "rubble": (0.42, 0.41, 0.39, 1),
    "unseen": (1, 1, 1, 0),
}
_GLOWING = {"lamp": (1.0, 1.0, 0.95, 1.0)}


def add_materials(spec: Any, mujoco: Any) -> None:
    """Adds every texture and material that the props use, named as they use them; ``colour-<word>`` for `COLOURS`."""
    role = mujoco.mjtTextureRole.mjTEXROLE_RGB
    for name, (image, tile_m, shininess) in _TEXTURED.items():
        _add_texture(spec, mujoco, f"texture:{name}", image, cube=False)
        # With texuniform, texrepeat is tiles a metre whatever the geom's size.
        material = spec.add_material(
            name=name, texuniform=True, texrepeat=[1 / tile_m, 1 / tile_m], specular=0.1, shininess=shininess
        )
        material.textures[role] = f"texture:{name}"
    for name, image in _CUBES.items():
        _add_texture(spec, mujoco, f"texture:{name}", image, cube=True)
        material = spec.add_material(name=name, specular=0.05, shininess=0.05)
        material.textures[role] = f"texture:{name}"
    for name, rgba in _PLAIN.items():
        spec.add_material(name=name, rgba=rgba, specular=0.1, shininess=0.2)
    for word, (red, green, blue) in COLOURS.items():
        spec.add_material(name=f"colour-{word}", rgba=[red, green, blue, 1], specular=0.08, shininess=0.2)
    for name, rgba in _GLOWING.items():
        spec.add_material(name=name, rgba=rgba, emission=1.0)


def _add_texture(spec: Any, mujoco: Any, name: str, image: str, *, cube: bool) -> None:
    pixels = texture(image)
    kind = mujoco.mjtTexture.mjTEXTURE_CUBE if cube else mujoco.mjtTexture.mjTEXTURE_2D
    height = SIZE_PX * (6 if cube else 1)
    added = spec.add_texture(name=name, type=kind, width=SIZE_PX, height=height, nchannel=3)
    added.data = np.concatenate([pixels] * 6).tobytes() if cube else pixels.tobytes()
