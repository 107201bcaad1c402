"""Language understood: instruction in, answer in. Whole without a model; never deciding meaning.

The names below are loaded when they are first used: reading an answer takes none of what reads an instruction.
"""

import importlib
import typing

if typing.TYPE_CHECKING:
    from mintpilot.language.answer_model import read_with_model
    from mintpilot.language.answers import read_answer
    from mintpilot.language.instruction import Capabilities, parse_instruction
    from mintpilot.language.instruction_model import parse_with_model
    from mintpilot.language.phrases import InstructionError, parse_phrase

_PLACES = {
    "Capabilities": "instruction",
    "InstructionError": "phrases",
    "parse_instruction": "instruction",
    "parse_phrase": "phrases",
    "parse_with_model": "instruction_model",
    "read_answer": "answers",
    "read_with_model": "answer_model",
}

__all__ = [
    "Capabilities",
    "InstructionError",
    "parse_instruction",
    "parse_phrase",
    "parse_with_model",
    "read_answer",
    "read_with_model",
]


def __getattr__(name: str) -> typing.Any:
    if name not in _PLACES:
        raise AttributeError(f"module 'mintpilot.language' has no attribute '{name}'; it offers {', '.join(__all__)}")
    return getattr(importlib.import_module(f"mintpilot.language.{_PLACES[name]}"), name)
