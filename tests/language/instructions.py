"""Instructions with the parses expected of them, as the package keeps them."""

from __future__ import annotations

from mintpilot.benchmark.language_cases import instruction_cases, refused_instructions

CASES = instruction_cases()
PLAIN, PARAPHRASES, CLOTHED = CASES["plain"], CASES["paraphrases"], CASES["clothed"]
REFUSED = refused_instructions()
