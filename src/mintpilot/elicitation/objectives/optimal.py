"""The yardstick: exact dynamic programming over all ways to ask."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.errors import LimitError
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.core.ports import QueryObjective, QuerySituation

MAX_STATES = 8_000
"""Default bound on the posterior supports that are looked at."""
_ROUNDING = 1e-12
_BEHIND = 1e-6


class Optimal(QueryObjective):
    """Fewest expected questions until asking may stop (method, section 5), with a memo over posterior supports.

    Asking may stop when one plan class holds ``1 - alpha`` of the mass, when one plan is within ``delta_c_s`` of the
    best under all that is left, or when no cut splits what is left. Exact for answer error 0 only.

    Args:
        max_states: bound on the posterior supports that are looked at.
    """

    def __init__(self, max_states: int = MAX_STATES) -> None:
        self._max_states = max_states

    def scores(self, situation: QuerySituation) -> Floats:
        """For each cut (q,), 1 / expected questions when it is asked first, itself counted; 0 for useless ones.

        Exact for the best cut; for others it may be an upper bound, always below the best.

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
        good = situation.regret_s <= settings.delta_c_s + 1e-9
        columns = np.vstack([situation.yes, good, situation.class_of[None, :]])
        kinds, kind_of = np.unique(columns, axis=1, return_inverse=True)
        cuts = len(situation.yes)
        self.mass: Floats = np.asarray(np.bincount(kind_of.ravel(), weights=situation.probability), float)
        self.row_of: Ints
        self.cuts, self.row_of = np.unique(kinds[:cuts].astype(bool), axis=0, return_inverse=True)
        self.weighted_cuts = self.cuts * self.mass
        # What no cut tells apart ends the asking just as one good plan does.
        self.good = np.vstack([kinds[cuts:-1].astype(float), _indistinct(kinds[:cuts], kinds[-1])])
        classes = np.unique(kinds[-1])
        self.member = (kinds[-1][:, None] == classes[None, :]).astype(float)
        self.enough = 1 - settings.alpha
        # One plan may do for several classes: then bits of the class are not what has to be found out.
        self.shared = bool((self.good[:, None, :] @ self.member > 0).sum(axis=2).max(initial=0) > 1)
        self.slack = _fano(settings.alpha, len(classes))
        self.max_states = max_states
        self.values: dict[bytes, tuple[float, bool]] = {}
        """By support: expected questions, and whether that is exact or a lower bound."""

    def scores(self) -> Floats:
        everything = np.ones(self.mass.size, bool)
        if self.bounds(everything[None, :])[0] == 0:
            return np.zeros(len(self.row_of))
        least, _, _ = self.search(everything)
        worth = np.zeros(len(self.cuts))
        for number, cut in enumerate(self.cuts):
            if cut.any() and not cut.all():
                worth[number] = 1.0 / least[np.packbits(cut if cut[0] else ~cut).tobytes()]
        return worth[self.row_of.ravel()]

    def value(self, support: Bools, limit: float) -> float:
        """Fewest expected questions from this support on; where that is ``limit`` or more, a lower bound of it."""
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
        """Expected questions for each cut asked first, by its yes part; the least of them; whether that is exact.

        For cuts that are no better than the best one, or than ``limit``, the figure may be a lower bound, but is always
        above the best.
        """
        yes = self.cuts & support
        count = yes.sum(axis=1)
        yes = yes[(count > 0) & (count < support.sum())]
        if not len(yes):
            return {}, 0.0, True
        # A cut and its opposite are one: the yes part is the one that holds the first hypothesis.
        yes = np.where(yes[:, np.argmax(support)][:, None], yes, support & ~yes)
        row_of = {packed.tobytes(): row for row, packed in enumerate(np.packbits(yes, axis=1))}
        keys = sorted(row_of)
        yes = yes[[row_of[key] for key in keys]]
        no = support & ~yes
        share = yes @ self.mass / self.mass[support].sum()
        below_yes, below_no = self.bounds(yes), self.bounds(no)
        least = 1.0 + share * below_yes + (1 - share) * below_no
        best, exact = limit, np.zeros(len(yes), bool)
        # The lowest bound first; among equal bounds the most even cut.
        for i in np.lexsort((np.abs(share - 0.5), np.round(least, 9))):
            for part, weight, below in ((yes[i], share[i], below_yes[i]), (no[i], 1 - share[i], below_no[i])):
                if least[i] >= best - _ROUNDING:
                    break
                least[i] += weight * (self.value(part, below + (best - least[i]) / weight) - below)
            if least[i] < best - _ROUNDING:
                best, exact[i] = float(least[i]), True
        found = float(least.min())
        # What was not followed to its end is no better than the best, but must not look as good.
        least = np.where(exact, least, np.maximum(least, best) + _BEHIND)
        return dict(zip(keys, least.tolist(), strict=True)), best if exact.any() else found, bool(exact.any())

    def bounds(self, supports: Bools) -> Floats:
        """For each support (s, hypotheses): 0 where asking may stop, else a lower bound on the expected questions.

        Asking ends in parts that one plan covers, or all but ``alpha`` of which one class covers. However the parts are
        cut, those of n covers weigh no more than the n heaviest covers, overlaps counted twice; so no way of asking
        beats Huffman's code for those.
        """
        weight = supports * self.mass
        total = weight.sum(axis=1)
        by_class = weight @ self.member
        covered = supports @ self.good.T >= supports.sum(axis=1)[:, None]
        stop = (by_class.max(axis=1) >= self.enough * total - _ROUNDING) | covered.any(axis=1)
        least = huffman(np.hstack([by_class / self.enough, weight @ self.good.T]) / total[:, None])
        if not self.shared:
            share = by_class / total[:, None]
            entropy = -(share * np.log2(np.where(share > 0, share, 1.0))).sum(axis=1)
            least = np.maximum(least, entropy - self.slack)
        bound: Floats = np.where(stop, 0.0, np.maximum(1.0, least))
        return bound


@compiled()
def huffman(weights: Floats) -> Floats:
    """For each row (s, n) the mean length of Huffman's code for its heaviest weights, cut off at a sum of 1."""
    out = np.zeros(len(weights))
    for row in range(len(weights)):
        sizes = np.sort(weights[row])[::-1]
        count, left = 0, 1.0
        while count < sizes.size and left > 1e-9:
            sizes[count] = min(sizes[count], left)
            left -= sizes[count]
            count += 1
        while count > 1:
            # The two lightest stand at the end; their sum goes where it belongs.
            joined = sizes[count - 1] + sizes[count - 2]
            out[row] += joined
            count -= 1
            at = count - 1
            while at > 0 and sizes[at - 1] < joined:
                sizes[at] = sizes[at - 1]
                at -= 1
            sizes[at] = joined
    return out


def _indistinct(cuts: NDArray[Any], class_of: NDArray[Any]) -> Floats:
    """Rows of truth values: the hypotheses that no cut tells apart, for each such group of more than one class."""
    group_of = np.unique(cuts, axis=1, return_inverse=True)[1].ravel()
    groups = [group_of == g for g in range(int(group_of.max()) + 1)]
    rows = [row.astype(float) for row in groups if np.unique(class_of[row]).size > 1]
    return np.array(rows) if rows else np.zeros((0, len(class_of)))


def _fano(alpha: float, classes: int) -> float:
    """Most bits of the class that may be left where one class holds ``1 - alpha`` of the mass (Fano's inequality)."""
    if alpha <= 0:
        return 0.0
    a = min(alpha, 0.5)
    return float(-a * np.log2(a) - (1 - a) * np.log2(1 - a) + a * np.log2(max(classes - 1, 1)))
