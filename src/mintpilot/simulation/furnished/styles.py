"""The styles there are, and what each may be used for.

Rules of perception may be chosen on `TUNED` styles only. `HELD_BACK` styles are for measuring. `FRESH` ones were
written by somebody who had not seen the rules; those of them that were measured first and then used are tuned now.
`LIBRARY` was written blind by who then changed the rules, and not looked at until they were done.
"""

from __future__ import annotations

from mintpilot.simulation.furnished.fresh_styles import HOME, SCHOOL, WARD, WORKSHOP
from mintpilot.simulation.furnished.library_style import LIBRARY
from mintpilot.simulation.furnished.style import CELLAR, CLINIC, OFFICE

TUNED = {style.name: style for style in (OFFICE, CELLAR, SCHOOL, WORKSHOP, WARD)}
FRESH = {style.name: style for style in (SCHOOL, WORKSHOP, HOME, WARD)}
HELD_BACK = {style.name: style for style in (CLINIC, HOME, LIBRARY)}
STYLES = TUNED | HELD_BACK
