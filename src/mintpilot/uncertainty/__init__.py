"""Map and instruction → knowledge gaps [u]: what is not known and bears on the task."""

from mintpilot.uncertainty.findings import Findings, find_gaps, frame_problem

__all__ = ["Findings", "find_gaps", "frame_problem"]
