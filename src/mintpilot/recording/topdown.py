"""The mission from above: the map, what is not known in it, the planned path and the flown one."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import ScaledTranslation

from mintpilot.core.geometry import Bools, Floats, Vec3
from mintpilot.core.message import message, verbatim
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.recording.build import speech_of
from mintpilot.recording.history import History
from mintpilot.recording.labels import Labels
from mintpilot.recording.words import printable
from mintpilot.wording.speech import IN_ENGLISH, Speech

PLANNED, FLOWN, OTHER, INK = "#16202b", "#0072b2", "#8a8f96", "#16202b"
KNOWLEDGE_LOOKS = {
    Knowledge.OPEN: ("#e69f00", "///", message("region: not known")),
    Knowledge.YES: ("#009e73", "...", message("region: free")),
    Knowledge.NO: ("#d55e00", "xxx", message("region: blocked")),
}
"""Colour (distinguishable by colour-blind people), hatching and words for what is known of a region."""
_PLAIN = {
    "red": "#c8372d", "green": "#2f9e44", "blue": "#2f6fd0", "yellow": "#f2c522", "orange": "#ee8322",
    "white": "#f8f8f6", "black": "#2a2a2a", "grey": "#8d949b", "gray": "#8d949b", "brown": "#8a5a33",
    "purple": "#7d4bb5", "pink": "#e58fb4",
}  # fmt: skip
"""Colour words of objects."""
_USUAL = {"fire": "#f2701d", "person": "#56b4e9", "injured": "#56b4e9"}
"""Colours of things without a colour word, by a word of their class."""
_STRUCTURE = {"wall", "partition", "rack", "shelf", "pillar", "floor", "ceiling", "rubble"}
"""Classes that are part of the building: their voxels show them."""
_ROOM_WORDS = {Knowledge.OPEN: verbatim("?"), Knowledge.YES: message("occupied"), Knowledge.NO: message("empty")}
_MAX_LABELS = 24


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TopDown:
    """What the plot shows."""

    map: SemanticMap
    start_m: Vec3
    planned_m: tuple[Floats, ...] = ()
    """Trajectories or paths (n, 3) that were to be flown."""
    flown_m: tuple[Floats, ...] = ()
    """What was flown (n, 3) along each of them."""
    alternatives_m: tuple[Floats, ...] = ()
    """Ways (n, 3) that other answers would have led to."""
    goals: tuple[tuple[str, Vec3], ...] = ()
    """(label, place) of each stop, in order."""
    speech: Speech = IN_ENGLISH
    """The language of its labels."""
    radius_m: float = 0.3
    """Of the drone: how far above and below the paths an obstacle counts."""


def view_of(history: History) -> TopDown | None:
    """What there is to draw of a mission; None without a map."""
    if history.map is None:
        return None
    plan = history.chosen[-1].plan if history.chosen else None
    legs = [leg for leg in history.legs if leg.phase != "survey"]
    planned = [leg.trajectory.position_m for leg in legs] or ([plan.path_m] if plan else [])
    classes = history.mint.classes if history.mint else ()
    others = [c.plan.path_m for c in classes if c.plan and c.plan.signature != history.flown_signature]
    mission = history.started.mission if history.started else None
    start = mission.start_m if mission else tuple(planned[0][0]) if planned else history.map.frame.box.centre_m
    stops = [leg for choice in history.chosen[-1:] if choice.plan for leg in choice.plan.legs]
    return TopDown(
        map=history.map,
        start_m=(float(start[0]), float(start[1]), float(start[2])),
        planned_m=tuple(planned),
        flown_m=tuple(leg.log.position_m for leg in legs),
        alternatives_m=tuple(others[:6]),
        goals=tuple((leg.site.label or leg.stop.id, leg.site.position_m) for leg in stops),
        speech=speech_of(history.started),
        radius_m=mission.limits.radius_m if mission else 0.3,
    )


def save_topdown(view: TopDown, *files: Path) -> None:
    """Draws the plot into each of the files; their endings say in which format.

    Raises:
        OSError: a file cannot be written.
    """
    looks: Any = {
        "text.parse_math": False,
        "svg.hashsalt": "mintpilot",
        "svg.fonttype": "path",
        "font.family": "DejaVu Sans",
        "hatch.linewidth": 0.7,
    }
    with mpl.rc_context(looks):
        figure = draw_topdown(view)
        for file in files:
            metadata = {"Date": None} if file.suffix == ".svg" else None
            figure.savefig(file, dpi=150, bbox_inches="tight", pad_inches=0.12, metadata=metadata)


def draw_topdown(view: TopDown) -> Figure:
    """The plot as a figure, to scale, in metres."""
    box = view.map.frame.box
    wide, deep = box.size_m[0], box.size_m[1]
    scale = min(9.0 / wide, 8.0 / deep)
    figure = Figure(figsize=(max(wide * scale, 4.0) + 0.9, max(deep * scale, 2.5) + 1.3), facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.set_xlim(box.lo_m[0], box.hi_m[0])
    axes.set_ylim(box.lo_m[1], box.hi_m[1])
    labels = Labels(axes)
    keys: list[Patch | Line2D] = _occupancy(axes, view)
    keys += _regions(axes, view, labels)
    keys += _rooms(axes, view, labels)
    keys += _paths(axes, view)
    _places(axes, view, labels)
    _objects(axes, view, labels)
    labels.draw()
    axes.set_xlabel(view.speech.label("east, m"), color=INK)
    axes.set_ylabel(view.speech.label("north, m"), color=INK)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(nbins=10, steps=[1, 2, 5, 10], integer=True))
    axes.tick_params(colors="#566472", length=3)
    for side in axes.spines.values():
        side.set_color("#c6ced6")
    below = axes.transAxes + ScaledTranslation(0, -0.5, figure.dpi_scale_trans)
    axes.legend(
        handles=keys, loc="upper center", bbox_to_anchor=(0.5, 0.0), bbox_transform=below, ncols=4,
        frameon=False, fontsize=8.5, handlelength=2.6, columnspacing=1.8,
    )  # fmt: skip
    return figure


def flight_band(view: TopDown) -> slice:
    """The layers of the map at the height of the paths, the drone's radius included; all layers without a path."""
    paths = [path for path in (*view.planned_m, *view.flown_m) if len(path)]
    nz = view.map.frame.shape[0]
    if nz == 1 or not paths:
        return slice(0, nz)
    heights = np.concatenate([path[:, 2] for path in paths])
    edges = np.array([heights.min() - view.radius_m, heights.max() + view.radius_m]) - view.map.frame.origin_m[2]
    low, high = np.floor(edges / view.map.frame.resolution_m).astype(int)
    low = int(np.clip(low, 0, nz - 1))
    return slice(low, int(np.clip(high + 1, low + 1, nz)))


def _extent(seen: SemanticMap) -> tuple[float, float, float, float]:
    box = seen.frame.box
    return (box.lo_m[0], box.hi_m[0], box.lo_m[1], box.hi_m[1])


def _occupancy(axes: Axes, view: TopDown) -> list[Patch | Line2D]:
    layers = view.map.cells[flight_band(view)]
    state = np.where((layers == Cell.FREE).any(axis=0), 1, 0)
    state = np.where((layers == Cell.OCCUPIED).any(axis=0), 2, state)
    colours = ("#e9ecef", "#ffffff", "#5b6875")
    axes.imshow(
        state,
        cmap=ListedColormap(colours),
        vmin=0,
        vmax=2,
        origin="lower",
        extent=_extent(view.map),
        interpolation="nearest",
    )
    names = (message("never seen"), message("free"), message("occupied at flight height"))
    return [Patch(facecolor=c, edgecolor="#c6ced6", label=view.speech(n)) for c, n in zip(colours, names, strict=True)]


def _footprint(seen: SemanticMap, region: Region) -> Bools:
    """Which columns (ny, nx) the region has cells in."""
    mask = np.zeros(seen.frame.shape[1] * seen.frame.shape[2], bool)
    mask[region.cells % mask.size] = True
    return mask.reshape(seen.frame.shape[1:])


def _regions(axes: Axes, view: TopDown, labels: Labels) -> list[Patch | Line2D]:
    seen = view.map
    x0, _, y0, _ = _extent(seen)
    keys: dict[Knowledge, Patch] = {}
    for region in seen.regions:
        colour, hatch, words = KNOWLEDGE_LOOKS[region.passable]
        mask = np.pad(_footprint(seen, region), 1).repeat(2, axis=0).repeat(2, axis=1)
        if not mask.any():
            continue
        half = seen.frame.resolution_m / 2
        xs = np.arange(mask.shape[1]) * half + x0 - 2 * half + half / 2
        ys = np.arange(mask.shape[0]) * half + y0 - 2 * half + half / 2
        axes.contourf(xs, ys, mask, levels=(0.5, 1.5), colors=[colour], alpha=0.25)
        hatched = axes.contourf(xs, ys, mask, levels=(0.5, 1.5), colors="none", hatches=[hatch])
        hatched.set_edgecolor(colour)
        hatched.set_linewidth(0)
        axes.contour(xs, ys, mask, levels=(0.5,), colors=[colour], linewidths=1.6)
        keys[region.passable] = Patch(facecolor=colour + "4d", edgecolor=colour, hatch=hatch, label=view.speech(words))
        ys_in, xs_in = np.nonzero(mask)
        labels.add(float(xs[xs_in].mean()), float(ys[ys_in].mean()), printable(region.id), strong=True)
    return list(keys.values())


def _rooms(axes: Axes, view: TopDown, labels: Labels) -> list[Patch | Line2D]:
    seen = view.map
    for room in seen.rooms:
        low, size = room.door_m.lo_m, room.door_m.size_m
        axes.add_patch(
            Rectangle(
                (low[0], low[1]), size[0], size[1], facecolor="#cc79a7", edgecolor="#8c3f6a", linewidth=2, zorder=4
            )
        )
        known = view.speech(message("searched") if room.searched else _ROOM_WORDS[room.occupied])
        x, y, _ = room.door_m.centre_m
        labels.add(x, y, f"{printable(room.id)} ({known})", strong=True)
    return (
        [Patch(facecolor="#cc79a7", edgecolor="#8c3f6a", label=view.speech.label("closed door"))] if seen.rooms else []
    )


def _paths(axes: Axes, view: TopDown) -> list[Patch | Line2D]:
    keys: list[Patch | Line2D] = []
    flown: dict[str, Any] = {"color": FLOWN, "linewidth": 3.6, "alpha": 0.85, "solid_capstyle": "round"}
    planned: dict[str, Any] = {"color": PLANNED, "linewidth": 1.3, "linestyle": (0, (4, 3))}
    other: dict[str, Any] = {"color": OTHER, "linewidth": 1.1, "linestyle": (0, (1, 1.6))}
    groups = (
        (view.alternatives_m, other, message("way under other answers")),
        (view.flown_m, flown, message("flown")),
        (view.planned_m, planned, message("planned")),
    )
    for layer, (paths, look, name) in enumerate(groups):
        lines = [axes.plot(path[:, 0], path[:, 1], zorder=5 + layer, **look)[0] for path in paths if len(path)]
        for line in lines[:1]:
            line.set_label(view.speech(name))
            keys.append(line)
    return keys


def _places(axes: Axes, view: TopDown, labels: Labels) -> None:
    x, y, _ = view.start_m
    axes.plot(x, y, marker="o", markersize=11, color="white", markeredgecolor=INK, markeredgewidth=2, zorder=9)
    axes.plot(x, y, marker="o", markersize=4, color=INK, zorder=10)
    labels.add(x, y, view.speech.label("start"), strong=True)
    for number, (label, place) in enumerate(view.goals, start=1):
        axes.plot(place[0], place[1], marker="*", markersize=17, color="#f0e442", markeredgecolor=INK, zorder=9)
        labels.add(place[0], place[1], f"{number}. {printable(label)}", strong=True)


def _objects(axes: Axes, view: TopDown, labels: Labels) -> None:
    goals = {label for label, _ in view.goals}
    things = [thing for thing in view.map.objects if thing.label not in _STRUCTURE]
    for count, thing in enumerate(things):
        low, size = thing.box_m.lo_m, thing.box_m.size_m
        usual = next((_USUAL[word] for word in thing.label.lower().split() if word in _USUAL), "#c9b79c")
        named = next((_PLAIN[colour] for colour in sorted(thing.values("colour")) if colour in _PLAIN), usual)
        axes.add_patch(
            Rectangle((low[0], low[1]), size[0], size[1], facecolor=named, edgecolor=INK, linewidth=0.9, zorder=4)
        )
        if count < _MAX_LABELS and thing.id not in goals:
            labels.add(thing.position_m[0], thing.position_m[1], printable(thing.id), strong=False)
