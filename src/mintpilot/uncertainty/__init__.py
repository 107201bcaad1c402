"""Map and instruction → knowledge gaps [u]: what is not known and bears on the task."""

from mintpilot.uncertainty.findings import Findings, find_gaps, frame_problem
from mintpilot.uncertainty.keep_away import with_keep_away
from mintpilot.uncertainty.ruling import letters_of, ruling_of

__all__ = ["Findings", "find_gaps", "frame_problem", "letters_of", "ruling_of", "with_keep_away"]
