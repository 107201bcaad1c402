"""One catalogue for each language: no sentence of the source is missing or left over, all have the same fields."""

import ast
import re
import string
from pathlib import Path

import pytest

import mintpilot
from mintpilot.core.errors import UnknownNameError
from mintpilot.core.message import Message, Named, joined, message, verbatim
from mintpilot.wording.speech import Speech, catalogue
from mintpilot.wording.tongues import TONGUES

SOURCE = Path(mintpilot.__file__).parent
NOT_MESSAGES = {"conformance/vehicle_double", "mission_file/reader.py"}
"""Where something else is called ``message``."""


def sentences() -> dict[str, str]:
    """Every sentence in the source and in the report's template, with a place where it stands."""
    found: dict[str, str] = {}
    for file in sorted(SOURCE.rglob("*.py")):
        where = str(file.relative_to(SOURCE))
        if any(where.startswith(other) for other in NOT_MESSAGES):
            continue
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            called = ast.unparse(node.func)
            if called == "message" or called.endswith(("speech.label", "_speech.label")):
                first = node.args[0] if node.args else None
                assert isinstance(first, ast.Constant), f"{where}:{node.lineno}: a sentence must stand there as it is"
                found.setdefault(str(first.value), f"{where}:{node.lineno}")
    template = (SOURCE / "recording" / "templates" / "report.html.j2").read_text("utf-8")
    found |= dict.fromkeys(re.findall(r'\bt\("([^"]*)"', template), "report.html.j2")
    return {text: where for text, where in found.items() if Message(text).has_words}


def fields(text: str) -> list[tuple[str, str]]:
    """The fields of a template with their formats, sorted."""
    return sorted((name, form or "") for _, name, form, _ in string.Formatter().parse(text) if name is not None)


@pytest.mark.long
@pytest.mark.parametrize("lang", sorted(TONGUES))
def test_every_sentence_of_the_source_is_in_every_catalogue_and_none_is_left_over(lang):
    known, said = catalogue(lang), sentences()
    missing = {text: where for text, where in said.items() if text not in known}
    assert not missing
    assert set(known) == set(said)


@pytest.mark.parametrize("lang", sorted(TONGUES))
def test_a_translation_has_the_same_fields_in_the_same_formats(lang):
    assert not {text: local for text, local in catalogue(lang).items() if fields(text) != fields(local)}


@pytest.mark.parametrize("lang", sorted(TONGUES))
def test_a_sentence_of_several_words_is_not_left_in_english(lang):
    same = {text for text, local in catalogue(lang).items() if text == local}
    assert not {text for text in same if len(re.findall(r"[A-Za-z]{2,}", re.sub(r"\{.*?\}", "", text))) > 1}


def test_the_languages_differ_from_each_other():
    for text in catalogue("de"):
        said = {lang: catalogue(lang)[text] for lang in TONGUES}
        words = len(re.findall(r"[A-Za-z]{2,}", re.sub(r"\{.*?\}", "", text)))
        assert words < 3 or len(set(said.values())) == len(said), text


def test_numbers_have_the_decimal_mark_and_things_the_nouns_of_the_language():
    said = message("{what} ({why})", what=Named("the grey smoke near the gate"), why=verbatim("as it is"))
    assert Speech("de")(said) == "der graue Rauch beim Tor (as it is)"
    figure = message("The way there: {x:.1f}", x=1.5)
    assert (str(figure), Speech("fr")(figure)) == ("The way there: 1.5", "The way there: 1,5")
    assert Speech("de")(message("One way to fly is right with {top:.1%} probability.", top=0.5)).startswith(
        "Ein Weg ist mit 50,0\N{NO-BREAK SPACE}% "
    )


def test_what_a_value_holds_is_never_read_as_a_template():
    assert str(message("{what} ({why})", what="{x}", why=verbatim("{0} {y!r}"))) == "{x} ({0} {y!r})"


def test_a_message_without_a_value_for_a_field_cannot_be_made():
    with pytest.raises(KeyError):
        message("{what} ({why})", what="x")


def test_joined_messages_are_joined_without_words():
    both = joined([message("I land."), Message(), message("I return.")])
    assert (str(both), Speech("es")(both)) == ("I land. I return.", "Aterrizo. Vuelvo.")
    assert not joined([Message()])


def test_an_unknown_language_is_named():
    with pytest.raises(UnknownNameError, match="'xx'"):
        Speech("xx")(message("I land."))
