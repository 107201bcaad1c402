"""The best way under every joint hypothesis of obstacle gaps, from one search (method, section 2).

1. Distances to the goal on the optimistic map, grown towards the start no further than they are needed, are a perfect
   heuristic for every hypothesis.
2. A plan that enters no region gives an upper bound (none where there is no such plan). A region whose cells all lie on
   paths as long as the bound is never touched: it is irrelevant.
3. One search over labels (cost, set of regions entered), where a label is beaten by one at the same place with no more
   cost and no other region, gives the decision list. A label whose shortest way on enters nothing new is done: it is
   a way, and its place needs no other continuation.

Detours in series can make the list approach 2^k. The labels have a budget; when it is hit, lazy branching with the same
heuristic goes on, exact and slower, within a bound on its searches; what it leaves out is reported, never guessed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.planning import joint_kernel, joint_labels, joint_paths
from mintpilot.planning.decision_list import DecisionList, ParetoPath, sorted_paths
from mintpilot.planning.distance_field import DistanceField
from mintpilot.planning.grid_search import GridSearch
from mintpilot.planning.lattice import cost_of_moves
from mintpilot.planning.lazy import lazy_paths
from mintpilot.planning.overlay import Overlay, closed_moves, followed, overlay_of
from mintpilot.planning.workspace import Workspace

MAX_REGIONS = 63
"""Number of regions that one search can tell apart; the least relevant ones beyond it are taken as blocked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """Bounds on the work of one joint search."""

    labels: int = 2_000_000
    """Labels made before lazy branching takes over (32 bytes each)."""
    comparisons: int = 100_000_000
    """Comparisons of labels before lazy branching takes over (a second or two)."""
    searches: int = 512
    """Searches of lazy branching before it gives up being complete."""


class JointSearch:
    """Joint searches on one grid with regions of unknown passability.

    Args:
        free: flags (nz, ny, nx), with every region taken as passable.
        regions: flat cells of each region; they may overlap and lie anywhere. Bit r of a mask is the r-th.
        effort: bounds on the work of one search.
    """

    reversible = True

    def __init__(self, free: Bools, regions: Sequence[Ints], effort: Effort | None = None) -> None:
        self.grid = GridSearch(free)
        self.regions = tuple(self.grid.lattice.nodes_of_flat(np.asarray(r, np.int64)) for r in regions)
        self.effort = effort or Effort()
        self.searches = 0
        """Joint searches made so far."""
        self.labels = 0
        """Labels that the last search made."""
        self._pool: NDArray[np.void] = np.empty(min(1 << 14, self.effort.labels), joint_labels.LABEL)
        self._safe = Workspace(self.grid.lattice.size)
        self._aims: NDArray[np.void] = np.zeros(self.grid.lattice.size, joint_paths.AIM)
        self._sets: NDArray[np.void] = np.empty(1 << 10, joint_labels.ENTERED)
        self._found: NDArray[np.void] = np.empty(1 << 10, joint_labels.FOUND)
        self._overlays: dict[tuple[int, ...], Overlay] = {}
        self._worn: Overlay | None = None

    def between(self, start: ArrayLike, goal: ArrayLike) -> DecisionList[Ints]:
        """All paths from start to goal (cells (z, y, x)) that are best under some set of blocked regions.

        Costs are in edges, paths are cells (n, 3). Regions over start or goal are required by every way.
        """
        lattice = self.grid.lattice
        ends = lattice.node(start), lattice.node(goal)
        self.searches += 1
        if not (lattice.free[ends[0]] and lattice.free[ends[1]]):
            return DecisionList(paths=())
        chosen = self._chosen(*ends)
        overlay = self._overlay(chosen)
        ahead = DistanceField(lattice, self.grid.work, ends[1], ends[0], overlay.near)
        ahead.grow(hold=True)
        paths: tuple[ParetoPath[Ints], ...] = ()
        not_expanded = 0
        if np.isfinite(ahead.at(ends[0])):
            bound, safe_path = self.grid.node_path(*ends, overlay.without, ahead, self._safe)
            safe = [self._way(safe_path, overlay)] if np.isfinite(bound) else []
            ahead.grow(bound)
            found = self._labels(ends[0], bound, overlay)
            if found is None:
                branched = self._branch(*ends, overlay, chosen, ahead)
                paths, not_expanded = sorted_paths([*safe, *branched.paths]), branched.not_expanded
            else:
                paths = self._traced(found, safe, ends[0])
        return DecisionList(
            paths=tuple(self._named(w, chosen) for w in paths),
            complete=not_expanded == 0 and len(chosen) == len(self.regions),
            left_out=tuple(r for r in range(len(self.regions)) if r not in set(chosen)),
            not_expanded=not_expanded,
        )

    def forget(self) -> None:
        """Forgets what was prepared for the regions (for measuring)."""
        self._worn = next(iter(self._overlays.values()), self._worn)
        self._overlays.clear()

    def under(self, start: ArrayLike, goal: ArrayLike, blocked: int) -> tuple[float, Ints] | None:
        """One plain search with the regions of that bit set blocked, as `GridSearch.shortest_path`."""
        lattice = self.grid.lattice
        nodes = [r for i, r in enumerate(self.regions) if blocked >> i & 1]
        allowed = closed_moves(lattice, lattice.allowed, nodes)
        ends = lattice.node(start), lattice.node(goal)
        if any(end in r for r in nodes for end in ends):
            return None
        cost, path = self.grid.node_path(*ends, allowed)
        if not np.isfinite(cost):
            return None
        cells = lattice.cells(path)
        return lattice.path_cost(cells), cells

    def _chosen(self, start: int, goal: int) -> tuple[int, ...]:
        """The regions to tell apart: all, or those that lie on the shortest paths."""
        count = len(self.regions)
        if count <= MAX_REGIONS:
            return tuple(range(count))
        allowed = self.grid.lattice.allowed
        through = self._distances(start, allowed) + self._distances(goal, allowed)
        nearest = [float(through[r].min(initial=np.inf)) for r in self.regions]
        return tuple(sorted(sorted(range(count), key=lambda r: (nearest[r], r))[:MAX_REGIONS]))

    def _distances(self, source: int, allowed: NDArray[np.uint64]) -> Floats:
        field = DistanceField(self.grid.lattice, self.grid.work, source, -1, allowed)
        field.grow()
        return field.everywhere()

    def _opened(self, chosen: tuple[int, ...]) -> NDArray[np.uint64]:
        """Allowed moves with the chosen regions passable and the others blocked."""
        lattice = self.grid.lattice
        if len(chosen) == len(self.regions):
            return lattice.allowed
        return closed_moves(lattice, lattice.allowed, [r for i, r in enumerate(self.regions) if i not in set(chosen)])

    def _overlay(self, chosen: tuple[int, ...]) -> Overlay:
        if chosen not in self._overlays:
            self.forget()
            nodes = [self.regions[r] for r in chosen]
            self._overlays[chosen] = overlay_of(self.grid.lattice, nodes, self._opened(chosen), self._worn)
        return self._overlays[chosen]

    def _labels(self, start: int, bound: float, overlay: Overlay) -> list[ParetoPath[int]] | None:
        """Paths as labels; None when the budget is spent. Needs the field of distances to the goal in the workspace."""
        lattice, work, moves = self.grid.lattice, self.grid.work, self.grid.lattice.moves
        count = joint_kernel.SMALL
        while count < 0:
            count, self.labels, self.grid.expanded = joint_kernel.search_labels(
                overlay.near,
                lattice.offset,
                moves.length,
                moves.after,
                moves.detour,
                moves.open,
                lattice.around,
                lattice.swept,
                overlay.region,
                overlay.entry_nodes,
                start,
                bound,
                self.effort.comparisons,
                work.cells,
                work.tag,
                self._safe.cells,
                self._safe.tag,
                self._aims,
                self._pool,
                self._sets,
                self._found,
            )
            if count < 0:
                joint_labels.forget(self._pool, self.labels, work.cells)
                if count == joint_kernel.SPENT or not self._grow():
                    return None
        found = self._found[:count]
        masks = self._sets["mask"][self._pool["set"][found["label"]]]
        of_all = zip(found["cost"].tolist(), masks.tolist(), found["label"].tolist(), strict=True)
        return [ParetoPath(cost=cost, mask=mask, path=label) for cost, mask, label in of_all]

    def _traced(
        self, found: list[ParetoPath[int]], safe: list[ParetoPath[Ints]], start: int
    ) -> tuple[ParetoPath[Ints], ...]:
        """Of the paths found those that no other one beats, as paths."""
        lattice = self.grid.lattice
        rivals = [ParetoPath(cost=way.cost, mask=way.mask, path=-1) for way in safe]
        paths = sorted_paths([*rivals, *found])
        ours = [way for way in paths if way.path >= 0]
        cells, ends, kinds = joint_paths.traced(
            np.array([way.path for way in ours], np.int64),
            np.array([way.cost for way in ours], np.float64),
            lattice.cells(np.array([start]))[0],
            self._pool,
            self._safe.cells,
            self._aims,
            lattice.offset,
            lattice.moves.step.astype(np.int64),
        )
        traces = iter(zip(np.split(cells, ends), kinds.tolist(), strict=False))
        made = []
        for way in paths:
            path, moves = next(traces) if way.path >= 0 else (safe[0].path, None)
            made.append(ParetoPath(cost=cost_of_moves(moves) if moves else way.cost, mask=way.mask, path=path))
        return tuple(made)

    def _grow(self) -> bool:
        """Makes room for more labels and paths; False when the budget is spent."""
        if self._pool.size >= self.effort.labels:
            return False
        self._pool = np.empty(min(4 * self._pool.size, self.effort.labels), joint_labels.LABEL)
        self._sets = np.empty(4 * self._sets.size, joint_labels.ENTERED)
        self._found = np.empty(4 * self._found.size, joint_labels.FOUND)
        return True

    def _branch(
        self, start: int, goal: int, overlay: Overlay, chosen: tuple[int, ...], ahead: DistanceField
    ) -> DecisionList[NDArray[np.int64]]:
        """Lazy branching, guided by the exact optimistic distances."""
        search = _Branching(search=self, ends=(start, goal), ahead=ahead, overlay=overlay, chosen=chosen)
        return lazy_paths(search, max_searches=self.effort.searches)

    def _way(self, nodes: NDArray[np.int64], overlay: Overlay) -> ParetoPath[NDArray[np.int64]]:
        lattice = self.grid.lattice
        _, rows, columns = lattice.padded
        cells, kinds, mask = followed(nodes, rows, columns, lattice.offset, lattice.swept, overlay.region)
        cells -= (0 if lattice.shape[0] == 1 else 1, 1, 1)
        return ParetoPath(cost=cost_of_moves(kinds), mask=int(mask), path=cells)

    def _named(self, way: ParetoPath[Ints], chosen: tuple[int, ...]) -> ParetoPath[Ints]:
        """The way with its mask in terms of all regions instead of the chosen ones."""
        if len(chosen) == len(self.regions):
            return way
        mask = sum(1 << r for bit, r in enumerate(chosen) if way.mask >> bit & 1)
        return ParetoPath(cost=way.cost, mask=mask, path=way.path)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Branching:
    """The grid as a black box for lazy branching; regions are bits of the overlay."""

    search: JointSearch
    ends: tuple[int, int]
    ahead: DistanceField
    overlay: Overlay
    chosen: tuple[int, ...]

    def path(self, blocked: frozenset[int]) -> tuple[float, Ints, frozenset[int]] | None:
        """One A* with those regions blocked."""
        grid, overlay = self.search.grid, self.overlay
        if any(int(overlay.region[end]) >> r & 1 for r in blocked for end in self.ends):
            return None
        nodes = [self.search.regions[self.chosen[r]] for r in sorted(blocked)]
        allowed = closed_moves(grid.lattice, self.search._opened(self.chosen), nodes)
        cost, path = grid.node_path(*self.ends, allowed, self.ahead, self.search._safe)
        if not np.isfinite(cost):
            return None
        way = self.search._way(path, overlay)
        return way.cost, way.path, frozenset(r for r in range(len(self.chosen)) if way.mask >> r & 1)
