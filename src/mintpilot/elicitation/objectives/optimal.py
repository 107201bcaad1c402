"""The yardstick: exact dynamic programming over all ways to ask."""

from __future__ import annotations

import numpy as np

from mintpilot.core.errors import LimitError
from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, QuerySituation

MAX_STATES = 100_000
"""Default bound on the posterior supports that are looked at."""
_ROUNDING = 1e-12


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
    """The recursion. A support is the bits of an integer, one for each group of hypotheses that nothing tells apart."""

    def __init__(self, situation: QuerySituation, max_states: int) -> None:
        settings = situation.settings
        good = situation.regret_s <= settings.delta_c_s + 1e-9
        alike = np.vstack([situation.yes, good, situation.class_of[None, :]])
        groups, group_of = np.unique(alike, axis=1, return_inverse=True)
        cuts = len(situation.yes)
        self.mass = np.bincount(group_of.ravel(), weights=situation.probability, minlength=groups.shape[1]).tolist()
        self.cut_of = [_bits(row) for row in groups[:cuts]]
        self.cuts = sorted(set(self.cut_of))
        self.good = [_bits(row) for row in groups[cuts:-1]]
        self.classes = [_bits(groups[-1] == c) for c in np.unique(groups[-1])]
        self.everything = (1 << groups.shape[1]) - 1
        self.alpha = settings.alpha
        self.max_states = max_states
        self.masses: dict[int, float] = {0: 0.0}
        self.values: dict[int, float] = {}

    def scores(self) -> Floats:
        if self.may_stop(self.everything):
            return np.zeros(len(self.cut_of))
        found = {cut: self.after(self.everything, cut) for cut in self.cuts}
        return np.array([1.0 / found[cut] if np.isfinite(found[cut]) else 0.0 for cut in self.cut_of])

    def after(self, support: int, cut: int) -> float:
        """Expected questions from here when this cut is asked now; infinite where it splits nothing."""
        yes, no = support & cut, support & ~cut
        if not yes or not no:
            return float("inf")
        share = self.mass_of(yes) / self.mass_of(support)
        return 1.0 + share * self.value(yes) + (1 - share) * self.value(no)

    def value(self, support: int) -> float:
        """Fewest expected questions from this support on."""
        if support in self.values:
            return self.values[support]
        if len(self.values) >= self.max_states:
            raise LimitError(
                f"objective 'optimal' would look at more than {self.max_states} posterior supports; "
                "use 'information-gain' or 'ec2', or raise the bound"
            )
        best = 0.0 if self.may_stop(support) else self.best(support)
        self.values[support] = best
        return best

    def best(self, support: int) -> float:
        """The least over all cuts; those whose lower bound is no better than what is found are not followed."""
        total = self.mass_of(support)
        splits: dict[int, float] = {}
        for cut in self.cuts:
            yes = support & cut
            if yes and yes != support and support ^ yes not in splits:
                open_mass = sum(self.mass_of(s) for s in (yes, support ^ yes) if not self.may_stop(s))
                splits[yes] = 1.0 + open_mass / total
        best = float("inf")
        for yes, bound in sorted(splits.items(), key=lambda item: (item[1], item[0])):
            if bound < best - _ROUNDING:
                best = min(best, self.after(support, yes))
        return best if splits else 0.0

    def may_stop(self, support: int) -> bool:
        """Whether one class holds enough of the mass, or one plan is good enough under all of it."""
        if any(support & ~good == 0 for good in self.good):
            return True
        enough = (1 - self.alpha) * self.mass_of(support) - _ROUNDING
        return any(self.mass_of(support & c) >= enough for c in self.classes)

    def mass_of(self, support: int) -> float:
        """Probability of a support."""
        if support not in self.masses:
            lowest = support & -support
            self.masses[support] = self.mass[lowest.bit_length() - 1] + self.mass_of(support ^ lowest)
        return self.masses[support]


def _bits(row: np.ndarray[tuple[int, ...], np.dtype[np.generic]]) -> int:
    return sum(1 << i for i in np.flatnonzero(row).tolist())
