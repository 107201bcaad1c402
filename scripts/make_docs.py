"""Writes what is generated of the documentation: the command line's help, the mission file's schema and its keys.

python scripts/make_docs.py
"""

from __future__ import annotations

import ast
import inspect
import itertools
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from mintpilot.mission_file.reader import json_schema
from mintpilot.mission_file.schema import MissionFile
from mintpilot.simulation.scenarios.fire_warehouse import FireWarehouseParameters
from mintpilot.simulation.scenarios.medicine_boxes import MedicineBoxesParameters

GENERATORS = (("fire-warehouse", FireWarehouseParameters), ("medicine-boxes", MedicineBoxesParameters))
DOCS = Path(__file__).parents[1] / "docs"
SCHEMA = MissionFile.model_json_schema()
DEFINITIONS = SCHEMA["$defs"]
COMMANDS = (
    "",
    "demo",
    "run",
    "plan",
    "see",
    "check",
    "doctor",
    "understand instruction",
    "bench table1",
    "bench boxes",
    "bench gaps",
    "bench language",
    "bench trust",
    "policy learn",
    "bench faults",
    "bench report",
    "bench export",
    "understand answer",
    "export",
    "sim serve",
    "log info",
    "log recover",
    "log export",
    "runs",
)
HEAD = """# The command line

Written by `make docs`; do not edit. Results go to standard output, everything else to standard error, so that
`--json` prints one object and nothing else.
"""

MISSION_HEAD = """# The mission file

Written by `make docs`; do not edit. A mission file is YAML; its first key is `mintpilot: 1`. `mintpilot check FILE`
finds every mistake in it, and `docs/mission.schema.json` lets an editor help you write one. Whole examples are in
`examples/`.

Lengths are metres, times seconds, angles radians; x is east, y north, z up. Words are read as YAML 1.2 has it: `true`
and `false` are truth values, `yes` and `no` are words. Anchors, aliases and tags are not read.

Four kinds of worlds: a `scenario` by name, an explicit `scene`, a `map` of your own, or what `mintpilot see` made of
pictures (`seen`). Only cells that the map shows free are flown through. The coordinates of a MovingAI map are those
of its scenario files, times the resolution. A pixel of a ROS map, by the first line that fits (its occupancy is 1 -
shade, with `negate` the shade):

1. not wholly opaque (alpha, transparent colour or palette entry), in every `mode`: unknown;
2. `mode: raw`: the grey value, 0 to 100, is the occupancy in percent; above 100: unknown;
3. shade 205 of 255, which map_saver writes for unknown (50 with `negate`): unknown;
4. more occupancy than `occupied_thresh`: occupied; 5. less than `free_thresh`: free; 6. else: unknown.

Pictures are PGM, PPM, PNG, BMP, TIFF, WebP or GIF without lossy compression; JPEG is refused, because it changes
shades. A turned map (yaw in `origin`) is laid on an upright grid: a cell is free only if all that it covers is. Maps of
more than 2 million cells are cut to what can be reached from the start; at most 260 million are read.

The vehicle's centre stays `radius_m + margin_m + 3 x position_sigma_m` away from everything not known free, from
regions not known passable, and from listed objects, for cells of any size (`docs/search.md`). Objects are solid, where
they are and as large as they are; on a flat map the drone passes above or below those that do not come near the height
flown at. What is the goal stays solid: the drone ends at the nearest free place beside or above it.
"""
TITLES = {
    "ScenarioWorld": "world by scenario",
    "SceneWorld": "world by scene",
    "MapWorld": "world by map",
    "SeenWorld": "world by what was seen",
    "GeoreferenceSpec": "georeference",
    "SceneSpec": "scene",
    "KeepAwaySpec": "distance to be kept",
    "RuleSpec": "rule in time",
    "LookSpec": "look",
    "SolidSpec": "solid",
    "SmokeSpec": "smoke",
    "PersonSpec": "person",
    "ClosedRoomSpec": "closed room",
    "BoxSpec": "box",
    "RegionSpec": "region",
    "RoomSpec": "room",
    "ObjectSpec": "object",
    "GoalSpec": "goal",
    "VehicleSpec": "vehicle",
    "AskingSpec": "asking",
    "LanguageSpec": "language",
    "SurveySpec": "survey",
    "PerceptionSpec": "perception",
    "PriorsSpec": "priors",
    "ValueSpec": "value",
    "NormalSpec": "normal distribution",
    "CorrelationSpec": "correlation",
    "CombinationSpec": "combination",
    "OperatorSpec": "operator",
}


def cli_page() -> str:
    """The help of every command as one page."""
    parts = [HEAD]
    for command in COMMANDS:
        words = [sys.executable, "-c", "import sys; from mintpilot.cli.main import main; sys.exit(main())"]
        shown = subprocess.run(
            [*words, *command.split(), "--help"],
            env={**os.environ, "COLUMNS": "100", "NO_COLOR": "1", "TERM": "dumb"},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        lines = "\n".join(line.rstrip() for line in shown.strip().splitlines())
        parts.append(f"## mintpilot {command}".rstrip() + f"\n\n```text\n{lines}\n```\n")
    return "\n".join(parts)


def mission_page() -> str:
    """Every key of a mission file, table by table, in the order in which they are met."""
    parts, waiting = [MISSION_HEAD, _table(SCHEMA)], _named(SCHEMA["properties"])
    done: set[str] = set()
    while waiting:
        name = waiting.pop(0)
        if name in done:
            continue
        done.add(name)
        definition = DEFINITIONS[name]
        parts.append(f"## {TITLES[name]}\n\n{definition['description']}\n\n{_table(definition)}")
        waiting += _named(definition["properties"])
        if name == "ScenarioWorld":
            parts += [_parameters(*generator) for generator in GENERATORS]
    return "\n".join(parts)


def _parameters(scenario: str, kind: type) -> str:
    """The parameters of a generator: names and defaults, and the strings that stand below them in the source."""
    (body,) = ast.parse(inspect.getsource(kind)).body
    assert isinstance(body, ast.ClassDef)
    lines = [f"### Parameters of {scenario}\n", "| key | default | meaning |", "|---|---|---|"]
    for field, below in itertools.pairwise(body.body):
        if isinstance(field, ast.AnnAssign) and isinstance(below, ast.Expr):
            meaning = " ".join(ast.literal_eval(below.value).split())
            default = getattr(kind(), ast.unparse(field.target))
            lines.append(f"| `{ast.unparse(field.target)}` | `{default:.4g}` | {meaning} |")
    return "\n".join(lines) + "\n"


def _named(schema: object) -> list[str]:
    """The parts that a schema refers to, in order."""
    if isinstance(schema, dict):
        own = [schema["$ref"].rsplit("/", 1)[1]] if "$ref" in schema else []
        return own + [name for value in schema.values() for name in _named(value)]
    return [name for value in schema for name in _named(value)] if isinstance(schema, list) else []


def _table(definition: dict[str, Any]) -> str:
    lines = ["| key | value | meaning |", "|---|---|---|"]
    required = definition.get("required", [])
    for key, value in definition["properties"].items():
        default = "**required**" if key in required else _default(value.get("default"))
        target = DEFINITIONS[_named(value)[0]] if "$ref" in value else {}
        meaning = " ".join((value.get("description") or target.get("description", "")).split()).replace("|", "\\|")
        lines.append(f"| `{key}` | {_kind(value)}{'; ' + default if default else ''} | {meaning} |")
    return "\n".join(lines) + "\n"


def _default(value: object) -> str:
    return "" if value in (None, [], {}, "") or isinstance(value, dict) else f"default `{json.dumps(value)}`"


def _kind(value: dict[str, Any]) -> str:
    """What is written there, in a few words."""
    if "$ref" in value:
        return f"[{TITLES[_named(value)[0]]}](#{TITLES[_named(value)[0]].replace(' ', '-')})"
    for union in ("anyOf", "oneOf"):
        if union in value:
            return " or ".join(dict.fromkeys(_kind(x) for x in value[union] if x.get("type") != "null"))
    if "enum" in value:
        return ", ".join(f"`{x}`" for x in value["enum"])
    if "const" in value:
        return f"`{value['const']}`"
    if value["type"] == "array":
        items = value.get("prefixItems")
        return f"list of {len(items)} numbers" if items else f"list of {_kind(value['items'])}"
    words = {"number": "number", "integer": "whole number", "boolean": "true or false", "string": "text"}
    return words.get(value["type"], "mapping") + _bounds(value)


def _bounds(value: dict[str, Any]) -> str:
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    return "".join(f" {sign} {value[key]:g}" for key, sign in signs.items() if key in value)


def main() -> None:
    """Writes the three files."""
    (DOCS / "mission.schema.json").write_text(json_schema(), encoding="utf-8")
    (DOCS / "mission-file.md").write_text(mission_page(), encoding="utf-8")
    (DOCS / "cli.md").write_text(cli_page(), encoding="utf-8")


if __name__ == "__main__":
    main()
