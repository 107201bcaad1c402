"""Better words for a chosen question, by a language model that is not trusted (method, section 4).

The model only ever changes the words. The cut, the consequences of Yes and No, and the number of questions stay; in any
doubt, and when the model is slow or gone, the template's words are asked.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Protocol

from mintpilot.core.errors import MintPilotError
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.ports import LanguageModel
from mintpilot.core.query import Query, Question
from mintpilot.core.tree import Mint
from mintpilot.wording.checking import doubt

WORDING_S = 1.2
"""A question must be out within 1.5 s of the cut: so long is better wording waited for."""
_WARMING_S = 60.0

_PROMPT = """\
You rewrite a drone's yes/no question so that it sounds natural when spoken. Keep the meaning and every \
describing word. At most 20 words, no negation, the question only.
Question: Is the wooden bridge beside the truck safe to cross?
Rewritten: Is it safe to cross the wooden bridge beside the truck?
Question: Is it one of the green bags?
Rewritten: Is the bag that you mean green?
Question: Is somebody inside the tent next to the river?
Rewritten: Is there somebody inside the tent next to the river?
Question: {question}
Rewritten:"""


class Wording(Protocol):
    """Puts a cut into words."""

    def __call__(self, query: Query, gaps: Sequence[KnowledgeGap], mint: Mint | None, *, attempt: int = 1) -> Question:
        """The question for a cut; from the second attempt on in other words."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class WordingTrial:
    """What came of one try to word a question better."""

    template: str
    proposed: str
    doubt: str
    """Why it was not used; empty: it was."""
    seconds: float
    tokens: int = 0


@dataclass(slots=True, kw_only=True)
class ModelWording:
    """Words by template, then asks the model for better ones and checks them.

    A second attempt at the same cut keeps the template's other words. Never raises for the model's sake.
    """

    template: Wording
    model: LanguageModel
    timeout_s: float = WORDING_S
    notice: Callable[[str], None] = lambda _: None
    """Told once, in a sentence, when the model fails: the mission goes on with templates and says so."""
    trials: list[WordingTrial] = field(default_factory=list)
    """What was tried, for the report and the benchmark."""
    _has_failed: bool = False

    def __call__(self, query: Query, gaps: Sequence[KnowledgeGap], mint: Mint | None, *, attempt: int = 1) -> Question:
        """The question for a cut; see `Wording`."""
        question = self.template(query, gaps, mint, attempt=attempt)
        if attempt > 1:
            return question
        return self.improve(question)

    def warm(self) -> None:
        """Lets the model read the fixed part of its prompt before it matters, in the background.

        A small model on a busy processor needs seconds for that, once; call it when the mission starts.
        """
        prompt = _PROMPT.format(question="Is it the red bag?")

        def read() -> None:
            with suppress(Exception):  # what is wrong with the model shows when it is needed
                self.model.complete(prompt, schema=None, timeout_s=_WARMING_S)

        threading.Thread(target=read, daemon=True, name="mintpilot warming").start()

    def improve(self, question: Question) -> Question:
        """The question in the model's words, if nothing speaks against them; choices and values stay as they were."""
        if question.query.is_choice or any(gap.threshold is not None for gap in question.gaps):
            return question
        try:
            prompt = _PROMPT.format(question=question.text)
            completion = self.model.complete(prompt, schema=None, timeout_s=self.timeout_s)
        except MintPilotError as error:
            self._fail(str(error))
            return question
        except Exception as error:  # a stranger's model may fail in any way: the mission goes on
            self._fail(f"the language model failed ({type(error).__name__}): going on with templates")
            return question
        text = first_line(completion.text)
        why_not = doubt(text, question)
        self.trials.append(
            WordingTrial(
                template=question.text,
                proposed=text,
                doubt=why_not,
                seconds=completion.seconds,
                tokens=completion.tokens,
            )
        )
        return question if why_not else replace(question, text=text, worded_by=completion.model)

    def _fail(self, text: str) -> None:
        if not self._has_failed:
            self._has_failed = True
            self.notice(text)


def first_line(text: str) -> str:
    """The first line that is not empty, without quotes round it; at most 400 characters of it."""
    line = next((x.strip() for x in text[:4000].splitlines() if x.strip()), "")
    return line.strip("\"'` ")[:400]
