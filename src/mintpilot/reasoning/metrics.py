"""How far two plans differ: distances of paths, and losses of acting on the wrong hypothesis (method, section 3)."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats
from mintpilot.core.ports import ImpactMetric

SAMPLES = 128
"""Points to which a path is resampled."""


def resample(path_m: Floats, samples: int = SAMPLES) -> Floats:
    """The path (n, 3) as ``samples`` points at equal arc length, metres. An empty path gives no points."""
    path = np.asarray(path_m, float)
    if len(path) < 2:
        return np.repeat(path, samples, axis=0)
    lengths = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))))
    where = np.linspace(0.0, lengths[-1], samples)
    points: Floats = np.stack([np.interp(where, lengths, path[:, i]) for i in range(path.shape[1])], axis=1)
    return points


@compiled()
def _frechet(a: Floats, b: Floats) -> float:
    """Discrete Frechet distance by dynamic programming, one row at a time."""
    n, m = a.shape[0], b.shape[0]
    row = np.empty(m)
    for i in range(n):
        corner = 0.0
        for j in range(m):
            d = 0.0
            for k in range(a.shape[1]):
                d += (a[i, k] - b[j, k]) ** 2
            d = math.sqrt(d)
            above = row[j]
            if i == 0 and j == 0:
                reach = d
            elif i == 0:
                reach = max(row[j - 1], d)
            elif j == 0:
                reach = max(above, d)
            else:
                reach = max(min(above, row[j - 1], corner), d)
            corner = above
            row[j] = reach
    return float(row[m - 1])


class FrechetMetric(ImpactMetric):
    """Discrete Frechet distance of the two paths at equal arc length: the leash that a dog and its owner need."""

    def divergence(self, a_m: Floats, b_m: Floats) -> float:
        """Metres; infinite when just one path is empty."""
        if not len(a_m) or not len(b_m):
            return _of_empty(a_m, b_m)
        return float(_frechet(resample(a_m), resample(b_m)))


class HausdorffMetric(ImpactMetric):
    """Hausdorff distance: how far some point of one path is from the whole other one. Blind to the order of flight."""

    def divergence(self, a_m: Floats, b_m: Floats) -> float:
        """Metres; infinite when just one path is empty."""
        if not len(a_m) or not len(b_m):
            return _of_empty(a_m, b_m)
        a, b = resample(a_m), resample(b_m)
        apart = np.linalg.norm(a[:, None, :] - b[None, :, :], axis=2)
        return float(max(apart.min(axis=0).max(), apart.min(axis=1).max()))


class PathVarianceMetric(ImpactMetric):
    """Root of the variance of the two paths about their mean, averaged along the way; for two paths, half their gap."""

    def divergence(self, a_m: Floats, b_m: Floats) -> float:
        """Metres; infinite when just one path is empty."""
        if not len(a_m) or not len(b_m):
            return _of_empty(a_m, b_m)
        return path_deviation_m((a_m, b_m), (0.5, 0.5))


def path_deviation_m(paths_m: tuple[Floats, ...], weights: tuple[float, ...]) -> float:
    """Root mean square distance, metres, of weighted paths (n, 3) from their mean path: 'path variance' of the paper.

    A belief that is sure of one path gives 0. Weights need not sum to one; at least one must be above 0.
    """
    points = np.stack([resample(path) for path in paths_m])
    share = np.asarray(weights, float) / np.sum(weights)
    mean = np.tensordot(share, points, axes=1)
    squares = ((points - mean) ** 2).sum(axis=2).mean(axis=1)
    return float(np.sqrt(share @ squares))


def q_value_gap(q_true: Floats, q_assumed: Floats) -> float:
    """Loss, under one hypothesis, of acting on the policy for another (method, section 3).

    Args:
        q_true: action values (actions,) under the hypothesis that holds, in the unit of the reward.
        q_assumed: action values (actions,) under the hypothesis that was acted on.

    Returns:
        ``max(q_true) - q_true[argmax(q_assumed)]``, never below 0; ties in ``q_assumed`` go to the first action.
    """
    return float(np.max(q_true) - q_true[int(np.argmax(q_assumed))])


def expected_regret_s(regret_s: Floats, probability: Floats) -> float:
    """Seconds lost on average by the best single plan, compared with knowing the truth.

    Args:
        regret_s: (plans, hypotheses), seconds lost by flying that plan under that hypothesis.
        probability: (hypotheses,), sums to one.
    """
    if not regret_s.size:
        return 0.0
    return float((regret_s @ probability).min())


def _of_empty(a_m: Floats, b_m: Floats) -> float:
    return 0.0 if len(a_m) == len(b_m) else float("inf")
