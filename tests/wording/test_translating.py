"""Questions in other languages: the same cut, and English where the tables end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest
from tests.language import questions

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.query import Combine, Literal, Query, Question, Saying, SayingKind
from mintpilot.core.tree import Mint
from mintpilot.models.doubles import FunctionModel, NoModel
from mintpilot.wording.tongues import GERMAN, TONGUES
from mintpilot.wording.translating import consequence, noun_phrase, translated, wording_for


def _template_of(question: Question):  # type: ignore[no-untyped-def]
    def template(query: Query, gaps: Sequence[KnowledgeGap], mint: Mint | None, *, attempt: int = 1) -> Question:
        return replace(question, attempt=attempt)

    return template


def _in(language: str, question: Question) -> Question:
    return translated(_template_of(question), language)(question.query, question.gaps, None)


@pytest.mark.parametrize(
    ("language", "question", "text", "yes", "no"),
    [
        (
            "de",
            questions.SMOKE,
            "Ist der graue Rauch beim Tor zum Durchfliegen sicher?",
            "ich fliege hindurch",
            "ich fliege außen herum",
        ),
        (
            "fr",
            questions.SMOKE,
            "Peut-on traverser sans danger la fumée grise près du portail ?",
            "je passe à travers",
            "je fais le tour",
        ),
        (
            "es",
            questions.SMOKE,
            "¿Se puede atravesar sin peligro el humo gris cerca del portón?",
            "lo atravieso",
            "lo rodeo",
        ),
        (
            "de",
            questions.ROOM,
            "Ist jemand hier drin: der geschlossene Raum bei der braunen Tür?",
            "ich sehe hinein",
            "ich fliege vorbei",
        ),
        (
            "fr",
            questions.BOX,
            "L'objet voulu est-il rouge ?",
            "je vole vers : la petite boîte rouge",
            "je demande encore : il en reste 2 autres",
        ),
    ],
)
def test_cuts_are_asked_in_other_languages(language: str, question: Question, text: str, yes: str, no: str) -> None:
    asked = _in(language, question)
    assert (asked.text, asked.yes_means, asked.no_means) == (text, yes, no)
    assert asked.query == question.query
    assert asked.worded_by == f"template-{language}"


def test_english_is_the_template_and_other_languages_are_refused() -> None:
    assert _in("en", questions.SMOKE) == questions.SMOKE
    with pytest.raises(UnknownNameError, match="Known: de, en, es, fr"):
        _in("xx", questions.SMOKE)


def test_a_model_is_only_asked_for_english() -> None:
    model = FunctionModel(lambda _: "Is it safe to fly through the grey smoke near the gate?", name="poet")
    told: list[str] = []
    for language, worded_by in (("en", "poet"), ("de", "template-de")):
        wording = wording_for(_template_of(questions.SMOKE), language=language, model=model, notice=told.append)
        assert wording(questions.SMOKE.query, questions.SMOKE.gaps, None).worded_by == worded_by
    plain = wording_for(_template_of(questions.SMOKE), model=NoModel(), notice=told.append)
    assert plain(questions.SMOKE.query, questions.SMOKE.gaps, None) == questions.SMOKE
    assert told == []


def test_unknown_words_stay_english_between_quotation_marks() -> None:
    assert noun_phrase("the mauve haze over the bridge", GERMAN) == "„the mauve haze over the bridge“"
    assert consequence("I hover for a while", GERMAN) == "I hover for a while"


def test_figures_and_doubts_are_kept() -> None:
    assert consequence("I fly around it, 12 s longer", GERMAN) == "ich fliege außen herum, 12 s länger"
    assert consequence("I probably fly through it", GERMAN) == "wahrscheinlich: ich fliege hindurch"


def test_cuts_of_several_parts_are_asked_as_one_statement() -> None:
    literals = tuple(
        Literal(gap=questions.BOX_GAP.id, values=frozenset({v}), saying=Saying(kind=SayingKind.VALUE, value=v))
        for v in ("box-1", "box-2")
    )
    either = replace(questions.BOX, query=Query(literals=literals, combine=Combine.ANY))
    assert _in("de", either).text == "Stimmt das: es ist die kleine rote Kiste oder es ist die große blaue Kiste?"


def test_what_no_sentence_says_is_asked_in_english() -> None:
    saying = Saying(kind=SayingKind.RELATION, name="larger than", value="box-1")
    literal = Literal(gap=questions.BOX_GAP.id, values=frozenset({"box-2"}), saying=saying)
    related = replace(questions.BOX, query=Query(literals=(literal,)))
    asked = _in("es", related)
    assert (asked.text, asked.worded_by) == (related.text, related.worded_by)


@pytest.mark.parametrize("tongue", TONGUES.values(), ids=lambda tongue: tongue.name)
def test_every_table_knows_the_same_words(tongue) -> None:  # type: ignore[no-untyped-def]
    assert tongue.nouns.keys() == GERMAN.nouns.keys()
    assert tongue.outcomes.keys() == GERMAN.outcomes.keys()
    assert tongue.asks.keys() == tongue.states.keys() == GERMAN.asks.keys()
    assert all(entry.split(" ", 1)[0] in tongue.articles for entry in tongue.nouns.values())
