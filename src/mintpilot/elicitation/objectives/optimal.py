"""The yardstick: exact dynamic programming over all ways to ask."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.errors import LimitError
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.core.tolerances import DECIMALS, ROUNDING, TOLERANCE

MAX_STATES = 8_000
"""Default bound on the posterior supports that are looked at."""
_BEHIND = 1e-6
"""How much worse than the best a query looks whose figure is a bound only."""


class Optimal(QueryObjective):
    """Least expected time of the operator until asking may stop (method, section 5): fewest questions, where all take
    the same. With a memo over posterior supports.

    Asking may stop when one plan class holds ``1 - alpha`` of the mass, when one plan is within ``delta_c_s`` of the
    best under all that is left, or when no query splits what is left. Exact for answer error 0 only.

    Args:
        max_states: bound on the posterior supports that are looked at.
    """

    def __init__(self, max_states: int = MAX_STATES) -> None:
        self._max_states = max_states

    def scores(self, situation: QuerySituation) -> Floats:
        """For each query (q,), 1 / expected effort when it is asked first, itself counted; 0 for useless ones.

        The effort is the operator's time in units of a yes or no (`mintpilot.core.query.Query.effort`).
        Exact for the best query; for others it may be an upper bound, always below the best.

        Raises:
            LimitError: answers may be wrong, or more than ``max_states`` supports would be looked at.
        """
        if situation.settings.answer_error > 0:
            raise LimitError(
                f"objective 'optimal' with answer_error = {situation.settings.answer_error}: it is exact only for "
                "answers that are never wrong; use 'information-gain' or 'ec2'"
            )
        return _Programme(situation, self._max_states).scores()


class _Programme:
    """The recursion, by branch and bound. A support is a row of truth values over the hypotheses."""

    def __init__(self, situation: QuerySituation, max_states: int) -> None:
        settings = situation.settings
        good = situation.regret_s <= settings.delta_c_s + TOLERANCE
        labels = situation.part_count[:, None] - 1 - situation.parts
        columns = np.vstack([labels, good, situation.class_of[None, :]])
        kinds, kind_of = np.unique(columns, axis=1, return_inverse=True)
        count = len(labels)
        self.mass: Floats = np.asarray(np.bincount(kind_of.ravel(), weights=situation.probability), float)
        self.row_of: Ints
        efforts, effort_of = np.unique(situation.effort, return_inverse=True)
        rows, self.row_of = np.unique(np.column_stack([effort_of.ravel(), kinds[:count]]), axis=0, return_inverse=True)
        self.effort: Floats = efforts[rows[:, 0]]
        """(queries,) what each takes."""
        rows = rows[:, 1:]
        self.arity = int(situation.part_count.max(initial=2))
        self.least = float(situation.effort.min(initial=np.inf))
        bits = np.log2(situation.part_count)
        # No query brings more bits for less, nor replaces more levels of yes and no.
        self.per_bit = float((situation.effort / bits).min(initial=np.inf))
        self.per_level = float((situation.effort / np.ceil(bits)).min(initial=np.inf))
        self.heads: Bools = rows[:, None, :] == np.arange(self.arity - 1, 0, -1)[:, None]
        """(queries, arity - 1, hypotheses): all parts but one, which holds what is left."""
        # What no query tells apart ends the asking just as one good plan does.
        self.good = np.vstack([kinds[count:-1].astype(float), _indistinct(kinds[:count], kinds[-1])])
        classes = np.unique(kinds[-1])
        self.member = (kinds[-1][:, None] == classes[None, :]).astype(float)
        self.enough = 1 - settings.alpha
        # One plan may do for several classes: then bits of the class are not what has to be found out.
        self.shared = bool((self.good[:, None, :] @ self.member > 0).sum(axis=2).max(initial=0) > 1)
        self.slack = _fano(settings.alpha, len(classes))
        self.max_states = max_states
        self.values: dict[bytes, tuple[float, bool]] = {}
        """By support: expected effort, and whether that is exact or a lower bound."""

    def scores(self) -> Floats:
        everything = np.ones(self.mass.size, bool)
        if self.bounds(everything[None, :])[0] == 0:
            return np.zeros(len(self.row_of))
        least, _, _ = self.search(everything)
        keys = _keys(_ordered(self.heads, everything))
        cheapest: dict[bytes, float] = {}
        for key, effort in zip(keys, self.effort.tolist(), strict=True):
            cheapest[key] = min(effort, cheapest.get(key, effort))
        worth = np.array(
            [
                1.0 / (least[key] + effort - cheapest[key]) if key in least else 0.0
                for key, effort in zip(keys, self.effort.tolist(), strict=True)
            ]
        )
        return worth[self.row_of.ravel()]

    def value(self, support: Bools, limit: float) -> float:
        """Least expected effort from this support on; where that is ``limit`` or more, a lower bound of it."""
        key = np.packbits(support).tobytes()
        least, exact = self.values.get(key, (0.0, False))
        if exact or least >= limit:
            return least
        if len(self.values) >= self.max_states:
            raise LimitError(
                f"objective 'optimal' would look at more than {self.max_states} posterior supports; "
                "use 'information-gain' or 'ec2', or raise the bound"
            )
        least = float(self.bounds(support[None, :])[0])
        exact = least == 0
        if 0 < least < limit:
            _, found, exact = self.search(support, limit)
            least = max(least, found)
        self.values[key] = least, exact
        return least

    def search(self, support: Bools, limit: float = float("inf")) -> tuple[dict[bytes, float], float, bool]:
        """Expected effort for each query asked first, by its parts; the least of them; whether that is exact.

        Of queries that divide alike the one of least effort counts.
        For queries that are no better than the best one, or than ``limit``, the figure may be a lower bound, but is
        always above the best.
        """
        heads = self.heads & support
        inside = heads.sum(axis=2)
        total = support.sum()
        divides = (inside.max(axis=1) < total) & (inside.sum(axis=1) > 0)
        heads, effort = heads[divides], self.effort[divides]
        if not len(heads):
            return {}, 0.0, True
        parts = _ordered(heads, support)
        row_of: dict[bytes, int] = {}
        for row, key in enumerate(_keys(parts)):
            if key not in row_of or effort[row] < effort[row_of[key]]:
                row_of[key] = row
        keys = sorted(row_of)
        rows = [row_of[key] for key in keys]
        parts, effort = parts[rows], effort[rows]
        share = (parts[:, :-1].reshape(-1, support.size) @ self.mass).reshape(len(parts), -1)
        share = share / self.mass[support].sum()
        share = np.concatenate([share, 1 - share.sum(axis=1, keepdims=True)], axis=1)
        below = self.bounds(parts.reshape(-1, support.size)).reshape(share.shape)
        least = effort + (share * below).sum(axis=1)
        best, exact = limit, np.zeros(len(parts), bool)
        uneven = np.abs(share[:, :-1] - 1 / self.arity).sum(axis=1)
        # The lowest bound first; among equal bounds the most even query.
        for i in np.lexsort((uneven, np.round(least, DECIMALS))):
            for part, weight, bound in zip(parts[i], share[i], below[i], strict=True):
                if least[i] >= best - ROUNDING:
                    break
                if weight > 0:
                    least[i] += weight * (self.value(part, bound + (best - least[i]) / weight) - bound)
            if least[i] < best - ROUNDING:
                best, exact[i] = float(least[i]), True
        found = float(least.min())
        # What was not followed to its end is no better than the best, but must not look as good.
        least = np.where(exact, least, np.maximum(least, best) + _BEHIND)
        return dict(zip(keys, least.tolist(), strict=True)), best if exact.any() else found, bool(exact.any())

    def bounds(self, supports: Bools) -> Floats:
        """For each support (s, hypotheses): 0 where asking may stop, else a lower bound on the expected effort.

        Asking ends in parts that one plan covers, or all but ``alpha`` of which one class covers. However they are
        divided, those of n covers weigh no more than the n heaviest covers, overlaps counted twice; so no way of asking
        beats Huffman's code for those, over as many symbols as the largest query has parts, at the least effort each;
        nor that over two symbols, at the least effort for each level that a query replaces.
        """
        weight = supports * self.mass
        total = weight.sum(axis=1)
        by_class = weight @ self.member
        covered = supports @ self.good.T >= supports.sum(axis=1)[:, None]
        stop = (by_class.max(axis=1) >= self.enough * total - ROUNDING) | covered.any(axis=1)
        covers = np.hstack([by_class / self.enough, weight @ self.good.T])
        covers = covers / np.maximum(total, ROUNDING)[:, None]
        least = self.least * huffman(covers, self.arity)
        if self.arity > 2:
            least = np.maximum(least, self.per_level * huffman(covers, 2))
        if not self.shared:
            share = by_class / np.maximum(total, ROUNDING)[:, None]
            entropy = -(share * np.log2(np.where(share > 0, share, 1.0))).sum(axis=1)
            least = np.maximum(least, (entropy - self.slack) * self.per_bit)
        bound: Floats = np.where(stop, 0.0, np.maximum(self.least, least))
        return bound


@compiled()
def huffman(weights: Floats, arity: int) -> Floats:
    """For each row (s, n) the mean length of Huffman's code for its heaviest weights, cut off at a sum of 1.

    ``arity`` is the number of symbols of the code, 2 or more.
    """
    out = np.zeros(len(weights))
    for row in range(len(weights)):
        sizes = np.sort(weights[row])[::-1]
        count, left = 0, 1.0
        while count < sizes.size and left > 1e-9:
            sizes[count] = min(sizes[count], left)
            left -= sizes[count]
            count += 1
        # With more symbols than two the first ones to be joined are fewer, so that the last joint is full.
        joining = 2 + (count - 2) % (arity - 1)
        while count > 1:
            # The lightest stand at the end; their sum goes where it belongs.
            joined = 0.0
            for i in range(count - joining, count):
                joined += sizes[i]
            out[row] += joined
            count -= joining - 1
            at = count - 1
            while at > 0 and sizes[at - 1] < joined:
                sizes[at] = sizes[at - 1]
                at -= 1
            sizes[at] = joined
            joining = arity
    return out


def _ordered(heads: Bools, support: Bools) -> Bools:
    """All parts (q, r, n) of queries, of which all but one are given (q, r - 1, n), in order of their first hypothesis.

    Queries that divide the support alike are equal then, whatever their parts are called.
    """
    rest = support & ~heads.any(axis=1)
    if heads.shape[1] == 1:
        swap = ~heads[:, 0, np.argmax(support)][:, None]
        first = np.where(swap, rest, heads[:, 0])
        return np.stack([first, support & ~first], axis=1)
    parts = np.concatenate([heads, rest[:, None]], axis=1)
    order = np.argsort(np.where(parts.any(axis=2), parts.argmax(axis=2), support.size), axis=1, kind="stable")
    return np.take_along_axis(parts, order[:, :, None], axis=1)


def _keys(parts: Bools) -> list[bytes]:
    """A key for each query: the parts (q, r, n) but the last, packed."""
    return [packed.tobytes() for packed in np.packbits(parts[:, :-1], axis=2)]


def _indistinct(labels: NDArray[Any], class_of: NDArray[Any]) -> Floats:
    """Rows of truth values: the hypotheses that no query tells apart, for each such group of more than one class."""
    group_of = np.unique(labels, axis=1, return_inverse=True)[1].ravel()
    groups = [group_of == g for g in range(int(group_of.max()) + 1)]
    rows = [row.astype(float) for row in groups if np.unique(class_of[row]).size > 1]
    return np.array(rows) if rows else np.zeros((0, len(class_of)))


def _fano(alpha: float, classes: int) -> float:
    """Most bits of the class that may be left where one class holds ``1 - alpha`` of the mass (Fano's inequality)."""
    if alpha <= 0:
        return 0.0
    a = min(alpha, 0.5)
    return float(-a * np.log2(a) - (1 - a) * np.log2(1 - a) + a * np.log2(max(classes - 1, 1)))
