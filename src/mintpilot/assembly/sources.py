"""From what a person writes to a source of pictures."""

from __future__ import annotations

from pathlib import Path

from mintpilot.assembly.registry import load, names
from mintpilot.core.errors import MapError
from mintpilot.core.ports import FrameSource, SourceOptions

_BAGS = (".mcap", ".db3")


def open_source(where: str, options: SourceOptions) -> FrameSource:
    """The source of that name.

    Args:
        where: a folder in TUM layout, or with ``color/`` and ``depth/``; a ROS 2 bag; ``realsense:`` or
            ``realsense:SERIAL``; ``sim:SCENARIO``; ``NAME:PLACE`` of a plug-in; empty for a single picture.
        options: what is known of the pictures.

    Raises:
        MapError: nothing of this kind is there; the message lists what is understood.
        MissingPartError: the package that reads it is not installed.
        UnknownNameError: there is no such simulated scenario.
    """
    kind, place = _kind(where, options)
    source: FrameSource = load("frames", kind)(place, options)
    return source


def _kind(where: str, options: SourceOptions) -> tuple[str, str]:
    if options.color is not None or options.depth is not None:
        return "picture", where
    name, colon, place = where.partition(":")
    if colon and name in names("frames") and not Path(where).exists():
        return name, place
    path = Path(where)
    if path.suffix in _BAGS or (path / "metadata.yaml").exists() or any(path.glob("*.mcap")):
        if not path.exists():
            raise MapError(f"there is no bag '{where}'; check the name")
        return "bag", where
    if (path / "rgb.txt").exists():
        return "tum", where
    if (path / "color").is_dir():
        return "folder", where
    raise MapError(
        f"'{where}' is no source of pictures: give a folder with rgb.txt and depth.txt (TUM), one with color/ and "
        "depth/, a ROS 2 bag, realsense:, sim:SCENARIO, or a single picture by --color FILE --depth FILE"
    )
