"""Shannon entropies in bits."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mintpilot.core.geometry import Floats


def entropy_bits(probability: ArrayLike) -> float:
    """Entropy of a distribution of any shape, in bits; between 0 and log2 of the number of its cells.

    Masses need not sum to one: they are normalised first. Without any mass the entropy is 0.
    """
    mass: Floats = np.asarray(probability, float).ravel()
    mass = mass[mass > 0]
    if mass.size < 2:
        return 0.0
    bound = np.log2(mass.size)
    mass = mass / mass.sum()
    mass = mass[mass > 0]
    # Rounding may leave the sum a hair outside its bounds.
    return float(np.clip(-(mass * np.log2(mass)).sum(), 0.0, bound))
