"""The styles there are, and what each may be used for.

Rules of perception may be chosen on `TUNED` styles only. `HELD_BACK` styles are for measuring. Of these, `FRESH` ones
were written by somebody who had not seen the rules.
"""

from __future__ import annotations

from mintpilot.simulation.furnished.fresh_styles import HOME, SCHOOL, WARD, WORKSHOP
from mintpilot.simulation.furnished.style import CELLAR, CLINIC, OFFICE

TUNED = {OFFICE.name: OFFICE}
FRESH = {style.name: style for style in (SCHOOL, WORKSHOP, HOME, WARD)}
HELD_BACK = {style.name: style for style in (CLINIC, CELLAR)} | FRESH
STYLES = TUNED | HELD_BACK
