"""Tolerances: how close two numbers must be to count as equal. The compiled kernels of planning keep their own."""

from __future__ import annotations

from typing import Final

ROUNDING: Final = 1e-12
"""Probabilities, masses and shares that differ by up to this differ by rounding only."""
TOLERANCE: Final = 1e-9
"""Costs (seconds), distances (metres) and information (bits) that differ by up to this count as equal."""
DECIMALS: Final = 9
"""Decimal places to which numbers are compared where a rank or a choice depends on them: rounding must not decide."""
SUM_TOLERANCE: Final = 1e-6
"""Probabilities that a person wrote down must sum to one within this."""
