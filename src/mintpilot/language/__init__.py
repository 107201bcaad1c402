"""Language: instruction in, question out, answer understood. Whole without a model; never deciding meaning."""

from mintpilot.language.answers import Reading, Understood, understand_answer
from mintpilot.language.instruction import Capabilities, parse_instruction

__all__ = ["Capabilities", "Reading", "Understood", "parse_instruction", "understand_answer"]
