"""Small scenes to fly through with the kinematic drone."""

from __future__ import annotations

from mintpilot.mission_file.schema import MissionFile

HALL = {"lo_m": [0.0, 0.0, 0.0], "hi_m": [12.0, 8.0, 3.0]}


def wall(name: str, x: float, y: tuple[float, float], *, appears_s: float = 0.0) -> dict[str, object]:
    """A wall across the hall from floor to roof."""
    return {
        "id": name,
        "kind": "wall",
        "extent_m": {"lo_m": [x, y[0], 0.0], "hi_m": [x + 0.2, y[1], 3.0]},
        "appears_s": appears_s,
    }


def smoke(name: str, x: tuple[float, float], y: tuple[float, float], *, toxic: bool) -> dict[str, object]:
    """A cloud from floor to roof."""
    return {
        "id": name,
        "extent_m": {"lo_m": [x[0], y[0], 0.0], "hi_m": [x[1], y[1], 3.0]},
        "toxic": toxic,
    }


def hall(
    *,
    toxic: bool = True,
    asking: dict[str, object] | None = None,
    operator: dict[str, object] | None = None,
    solids: list[dict[str, object]] | None = None,
    endurance_s: float | None = None,
    detour: bool = True,
) -> MissionFile:
    """A hall with a wall across it. A wide gap in the wall is full of smoke; a detour leads round by the far side."""
    walls = [wall("across", 6.0, (0.0, 1.0)), wall("across-2", 6.0, (3.0, 6.4 if detour else 8.0))]
    vehicle = {} if endurance_s is None else {"vehicle": {"endurance_s": endurance_s}}
    return MissionFile.model_validate(
        {
            "mintpilot": 1,
            "name": "hall",
            "instruction": "Go to the injured person.",
            "world": {
                "scene": {
                    "volume": HALL,
                    "start_m": [1.5, 2.0, 1.2],
                    "solids": [*walls, *(solids or [])],
                    "smokes": [smoke("cloud", (5.2, 7.0), (0.2, 3.6), toxic=toxic)],
                    "persons": [{"id": "hurt", "position_m": [10.5, 2.0, 0.0]}],
                }
            },
            "asking": {"delta_c_s": 0.5, **(asking or {})},
            "operator": operator or {},
            **vehicle,
        }
    )
