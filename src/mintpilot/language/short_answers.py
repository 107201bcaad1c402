"""Answers in the operator's own language: few, short, and exactly these. Everything else is asked again."""

from __future__ import annotations

import re

from mintpilot.core.query import Command, Question
from mintpilot.language.answers import Reading, Understood, understand_answer

_KEYS: dict[Reading | Command, str] = {
    Reading.YES: "y|yes",
    Reading.NO: "n|no",
    Reading.UNSURE: "?|u|unsure|don't know",
}
"""The keys that a screen offers, in every language."""
_WORDS: dict[str, dict[Reading | Command, str]] = {
    "de": {
        Reading.YES: "j|ja|jawohl|ja bitte|genau|stimmt|richtig|ja genau|ja das stimmt",
        Reading.NO: "nein|nee|ne|nein danke|stimmt nicht|falsch|auf keinen fall|nein das stimmt nicht",
        Reading.UNSURE: "weiß nicht|weiss nicht|keine ahnung|weiß ich nicht|weiss ich nicht|ich weiß es nicht"
        "|ich weiss es nicht|ich weiß nicht|ich weiss nicht|nicht sicher|ich bin nicht sicher|unsicher|vielleicht",
        Command.HOLD: "stopp|stop|halt|anhalten|warte|warten",
        Command.ABORT: "abbrechen|abbruch|brich ab|aufhören",
        Command.RETURN: "zurück|komm zurück|zurückkommen|umkehren|kehr um",
    },
    "fr": {
        Reading.YES: "o|oui|ouais|oui bien sûr|c'est ça|exact|exactement|c'est exact|d'accord",
        Reading.NO: "non|non merci|pas du tout|c'est faux|faux|surtout pas",
        Reading.UNSURE: "je ne sais pas|je sais pas|aucune idée|pas sûr|je ne suis pas sûr"
        "|je ne suis pas sûre|peut-être|peut être",
        Command.HOLD: "stop|arrête|arrêtez|attends|attendez|halte",
        Command.ABORT: "abandonne|abandonner|annule|annuler",
        Command.RETURN: "reviens|revenez|retour|rentre|demi-tour",
    },
    "es": {
        Reading.YES: "s|sí|si|sí claro|claro|exacto|correcto|así es|eso es|de acuerdo",
        Reading.NO: "no gracias|para nada|de ninguna manera|falso|incorrecto|eso no",
        Reading.UNSURE: "no sé|no se|no lo sé|no lo se|ni idea|no estoy seguro|no estoy segura|quizás|quizá|tal vez",
        Command.HOLD: "alto|para|parar|detente|espera|stop",
        Command.ABORT: "aborta|abortar|cancela|cancelar",
        Command.RETURN: "vuelve|regresa|volver|regresar|atrás",
    },
}


def _table(*tables: dict[Reading | Command, str]) -> dict[str, Reading | Command]:
    return {words: meaning for table in tables for meaning, several in table.items() for words in several.split("|")}


_TABLES = {"en": _table(_KEYS), **{language: _table(_KEYS, words) for language, words in _WORDS.items()}}


def understand_in(text: str, question: Question, language: str) -> Understood:
    """Reads an answer of somebody who is asked in that language.

    In English the rules read whatever they can (`understand_answer`). In the other languages only listed short answers
    count, and orders, which are heard in English as well: English rules would misread ``no sé`` as a No.

    Args:
        text: the words. Never an instruction to this program.
        question: what was asked.
        language: ``en``, ``de``, ``fr`` or ``es``.
    """
    words = " ".join(re.sub(r"[,;.!¡]", " ", text.lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'")).split())
    meaning = _TABLES[language].get(words)
    if isinstance(meaning, Command):
        return Understood(reading=Reading.COMMAND, command=meaning)
    if meaning is not None:
        return Understood(reading=meaning)
    heard = understand_answer(text, question)
    if language == "en" or heard.reading is Reading.COMMAND:
        return heard
    return Understood(reading=Reading.OTHER)
