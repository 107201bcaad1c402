"""The language of one mission: who reads the instruction and answers, who words questions, who may propose cuts."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass

from mintpilot.assembly.guarded_model import GuardedModel
from mintpilot.assembly.registry import load
from mintpilot.core.geometry import Vec3
from mintpilot.core.message import Message
from mintpilot.core.ports import LanguageModel, Proposer
from mintpilot.core.query import Order, Query, Question, Reply
from mintpilot.core.reading import AnsweredBy, Reading, guarded_replies
from mintpilot.core.task import Task
from mintpilot.core.tree import Mint
from mintpilot.elicitation.wording import word_question
from mintpilot.mission.rewording import Improve
from mintpilot.mission_file.schema import LanguageSpec
from mintpilot.mission_file.schema_world import World, names_in
from mintpilot.wording.rewording import ModelWording, Wording
from mintpilot.wording.speech import Speech
from mintpilot.wording.translating import ENGLISH, wording_for

TEMPLATE = "template"
"""Name of the model that is none."""
SCREEN_S = 8.0
"""Better words for a screen may take this long: the first ones stand there meanwhile. Who speaks waits far shorter."""


class Talk(AbstractContextManager["Talk"]):
    """Everything about words that a crew needs; closes its model in the end.

    Whatever the model does, each of these works without it: by template and by rules.

    Args:
        lang: in which questions are asked: ``en``, ``de``, ``fr`` or ``es``.
        model: who may help; None: nobody.
        name: the model's registered name.
        names: what the mission file calls things in that language, by their English words.

    Raises:
        UnknownNameError: another language.
    """

    def __init__(
        self,
        *,
        lang: str = ENGLISH,
        model: LanguageModel | None = None,
        name: str = TEMPLATE,
        names: Mapping[str, str] | None = None,
    ) -> None:
        self.lang = lang
        self.names = dict(names or {})
        """What the mission file calls things in that language, by their English words."""
        self.model_name = name
        self._model = None if model is None else GuardedModel(model, name)
        worded = wording_for(word_question, language=lang, names=names)
        self.spoken = Speech(lang, self.names)
        """Puts what is told into that language."""
        self.word: Wording = worded
        """Words a cut at once, by template."""
        self.improve: Improve | None = None
        """Makes better words while those are shown; None: nobody does. Only English words can be checked."""
        self.proposer: Proposer | None = None
        """May propose cuts; None: nobody does."""
        if self._model is not None:
            self.proposer = ModelProposer(self._model)
            if lang == ENGLISH:
                wording = ModelWording(template=worded, model=self._model, timeout_s=SCREEN_S)
                wording.warm()
                self.improve = wording.improve

    def __exit__(self, *_: object) -> None:
        self.close()

    def parse(self, text: str, home_m: Vec3 | None = None, known: Collection[str] = ()) -> Task:
        """The instruction as a task: by rules, and what they refuse with the model's help.

        Args:
            text: the instruction.
            home_m: where the drone comes back to, metres.
            known: words that the map uses for things, in lower case.

        Raises:
            InputError: neither way gives a task; the rules' own reason.
        """
        if self._model is None:
            from mintpilot.language.instruction import parse_instruction

            return parse_instruction(text, home_m=home_m, known=known)
        from mintpilot.language.instruction_model import parse_with_model

        return parse_with_model(text, self._model, home_m=home_m, known=known)

    def understand(
        self,
        text: str,
        question: Question,
        timeout_s: float,
        *,
        by: AnsweredBy = AnsweredBy.TYPED,
        guarded: Collection[Reply] | None = None,
        pending: Reply | None = None,
    ) -> Reading:
        """What a free answer means: by rules, and what they do not know with the model's help, in English only.

        See `mintpilot.core.ports.Understand`.
        """
        kept = guarded_replies(question) if guarded is None else guarded
        if self._model is None or self.lang != ENGLISH:
            from mintpilot.language.answers import read_answer

            return read_answer(text, question, guarded=kept, lang=self.lang, by=by, pending=pending)
        from mintpilot.language.answer_model import READING_S, read_with_model

        return read_with_model(
            text,
            question,
            self._model,
            guarded=kept,
            by=by,
            pending=pending,
            timeout_s=min(READING_S, timeout_s / 2),  # the model is asked twice
        )

    def order_of(self, text: str) -> Order | None:
        """The order that typed words are where nothing is asked; None: they are none."""
        from mintpilot.language.answers import order_in

        return order_in(text, self.lang)

    def take_remarks(self) -> tuple[Message, ...]:
        """What went wrong with the model since it was last called, in sentences; each is told once."""
        return () if self._model is None else self._model.take_remarks()

    def close(self) -> None:
        """Closes the model. Safe to call again."""
        model, self._model = self._model, None
        if model is not None:
            self.improve, self.proposer = None, None
            model.close()


@dataclass(frozen=True, slots=True)
class ModelProposer(Proposer):
    """A language model that proposes cuts in the predicate language."""

    model: GuardedModel

    @property
    def name(self) -> str:
        """See `Proposer.name`."""
        return self.model.name

    def propose(self, mint: Mint) -> tuple[Query, ...]:
        """See `Proposer.propose`."""
        from mintpilot.elicitation.proposing import propose_cuts

        return propose_cuts(self.model, mint).queries


def talk_for(
    spec: LanguageSpec,
    *,
    llm: str | LanguageModel | None = None,
    lang: str | None = None,
    world: World | None = None,
) -> Talk:
    """The language of a mission: as its file says, where nobody says otherwise.

    Args:
        spec: the mission file's part about language.
        llm: the name of a language model, or one that was made already; None: that of the file.
        lang: the language in which questions are asked; None: that of the file.
        world: of the file: it may name things in that language.

    Raises:
        UnknownNameError: nobody registered that model, or the language is not known.
        InputError: the model needs an address, a name or a file that is not given, or it is broken.
        MissingPartError: the model needs a part that is not installed.
    """
    spoken = lang if lang is not None else spec.lang
    names = names_in(world, spoken)
    wording_for(word_question, language=spoken)  # a wrong language is told before a model is loaded
    if llm is not None and not isinstance(llm, str):
        return Talk(lang=spoken, model=llm, name=type(llm).__name__, names=names)
    name = llm if llm is not None else spec.model
    made = load("language", name)
    return Talk(lang=spoken, model=None if name == TEMPLATE else made(), name=name, names=names)
