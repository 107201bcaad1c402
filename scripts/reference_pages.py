"""A hook of MkDocs: one reference page for each room, made of the docstrings of its modules."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

PACKAGE = Path(__file__).parents[1] / "src" / "mintpilot"
FIRST = ("core", "conformance", "assembly")
"""Rooms that a reader from outside comes to first."""


def rooms() -> list[str]:
    """All rooms, those for readers from outside first."""
    found = sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py"))
    return [*FIRST, *(room for room in found if room not in FIRST)]


def modules(room: str) -> list[str]:
    """Dotted names of a room's public modules, the deeper ones included."""
    files = sorted(path.relative_to(PACKAGE.parent) for path in (PACKAGE / room).rglob("*.py"))
    return [
        ".".join(path.with_suffix("").parts).removesuffix(".__init__")
        for path in files
        if not path.stem.startswith("_") or path.stem == "__init__"
    ]


def page(room: str) -> str:
    """The page of one room, for mkdocstrings to fill."""
    return f"# {room}\n\n" + "\n".join(f"::: {module}\n" for module in modules(room))


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Adds the pages to the navigation, and the decisions."""
    nav: list[Any] = config.nav or []
    decisions = sorted(path.name for path in (Path(config.docs_dir) / "decisions").glob("*.md"))
    nav.append({"Decisions": [f"decisions/{name}" for name in decisions]})
    nav.append({"Reference": [{"mintpilot": "reference/mintpilot.md"}, *({r: f"reference/{r}.md"} for r in rooms())]})
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Adds the generated pages."""
    files.append(File.generated(config, "reference/mintpilot.md", content=front_page()))
    for room in rooms():
        files.append(File.generated(config, f"reference/{room}.md", content=page(room)))
    return files


def front_page() -> str:
    """What `import mintpilot` offers, and where it is described."""
    import mintpilot

    names = "\n".join(f"- [`mintpilot.{n}`][{mintpilot._PLACES[n]}.{n}]" for n in mintpilot.__all__)
    return f"# mintpilot\n\nNames that `import mintpilot` offers:\n\n{names}\n"
