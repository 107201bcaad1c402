"""Language: instruction in, question out, answer understood. Whole without a model; never deciding meaning.

The names below are loaded when they are first used: wording a question takes none of what reads an answer.
"""

import importlib
import typing

if typing.TYPE_CHECKING:
    from mintpilot.language.answer_model import read_with_model
    from mintpilot.language.answers import read_answer
    from mintpilot.language.instruction import Capabilities, parse_instruction
    from mintpilot.language.instruction_model import parse_with_model
    from mintpilot.language.phrases import InstructionError, parse_phrase
    from mintpilot.language.proposing import Proposals, propose_cuts
    from mintpilot.language.translating import wording_for
    from mintpilot.language.wording import ModelWording

_PLACES = {
    "Capabilities": "instruction",
    "InstructionError": "phrases",
    "ModelWording": "wording",
    "Proposals": "proposing",
    "parse_instruction": "instruction",
    "parse_phrase": "phrases",
    "parse_with_model": "instruction_model",
    "propose_cuts": "proposing",
    "read_answer": "answers",
    "read_with_model": "answer_model",
    "wording_for": "translating",
}

__all__ = [
    "Capabilities",
    "InstructionError",
    "ModelWording",
    "Proposals",
    "parse_instruction",
    "parse_phrase",
    "parse_with_model",
    "propose_cuts",
    "read_answer",
    "read_with_model",
    "wording_for",
]


def __getattr__(name: str) -> typing.Any:
    if name not in _PLACES:
        raise AttributeError(f"module 'mintpilot.language' has no attribute '{name}'; it offers {', '.join(__all__)}")
    return getattr(importlib.import_module(f"mintpilot.language.{_PLACES[name]}"), name)
