"""Plain answers in German, French and Spanish."""

from __future__ import annotations

import pytest

from mintpilot.core.query import Order
from mintpilot.language.answers import Reading
from mintpilot.language.short_answers import understand_in

from . import questions

CASES = {
    "de": {
        "yes": ("ja", "Ja bitte!", "jawohl", "ja, mach das", "j", "klar doch"),
        "no": ("nein", "nein, auf keinen Fall", "lieber nicht", "zu gefährlich", "das stimmt nicht", "nein danke"),
        "unsure": ("weiß nicht", "keine Ahnung", "vielleicht", "ich glaube schon", "wie bitte?", "jein"),
        "other": ("ja nein", "ja, wenn du schnell bist", "der Hund schläft", "nicht ungefährlich"),
    },
    "fr": {
        "yes": ("oui", "Oui, bien sûr", "d'accord", "vas-y", "c'est exact"),
        "no": ("non", "non merci", "surtout pas", "c'est dangereux", "hors de question"),
        "unsure": ("je ne sais pas", "peut-être", "aucune idée", "pardon ?", "je crois que oui"),
        "other": ("oui non", "oui si tu fais vite", "le chat dort"),
    },
    "es": {
        "yes": ("sí", "si, claro", "adelante", "por supuesto", "sí señor"),
        "no": ("no", "no, gracias", "de ninguna manera", "es peligroso", "no lo hagas"),
        "unsure": ("no sé", "no lo sé", "quizás", "ni idea", "creo que sí"),
        "other": ("sí no", "sí, pero rápido", "el perro duerme"),
    },
}


@pytest.mark.parametrize(
    ("language", "text", "reading"),
    [(lang, text, r) for lang, rows in CASES.items() for r, texts in rows.items() for text in texts],
)
def test_plain_answers_are_understood(language: str, text: str, reading: str) -> None:
    assert understand_in(text, questions.SMOKE, language).reading == reading


@pytest.mark.parametrize(
    ("language", "text", "command"),
    [
        ("de", "Stopp!", Order.HOLD),
        ("de", "komm sofort zurück", Order.RETURN),
        ("de", "abbrechen", Order.ABORT),
        ("fr", "arrête", Order.HOLD),
        ("fr", "reviens tout de suite", Order.RETURN),
        ("fr", "annule la mission", Order.ABORT),
        ("es", "alto", Order.HOLD),
        ("es", "vuelve ahora", Order.RETURN),
        ("es", "aborta", Order.ABORT),
        ("es", "stop", Order.HOLD),
    ],
)
def test_orders_are_heard(language: str, text: str, command: Order) -> None:
    understood = understand_in(text, questions.SMOKE, language)
    assert (understood.reading, understood.command) == (Reading.COMMAND, command)
