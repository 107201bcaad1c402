"""Language: instruction in, question out, answer understood. Whole without a model; never deciding meaning."""

from mintpilot.language.answer_model import read_with_model
from mintpilot.language.answers import read_answer
from mintpilot.language.instruction import Capabilities, parse_instruction
from mintpilot.language.instruction_model import parse_with_model
from mintpilot.language.phrases import InstructionError, parse_phrase
from mintpilot.language.proposing import Proposals, propose_cuts
from mintpilot.language.translating import wording_for
from mintpilot.language.wording import ModelWording

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
