"""Language: instruction in, question out, answer understood. Whole without a model; never deciding meaning."""

from mintpilot.language.instruction import Capabilities, parse_instruction

__all__ = ["Capabilities", "parse_instruction"]
