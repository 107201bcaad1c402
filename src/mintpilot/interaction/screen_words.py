"""What a screen says around a question, in the operator's language."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from mintpilot.core.errors import UnknownNameError


@dataclass(frozen=True, slots=True, kw_only=True)
class ScreenWords:
    """Fixed words; ``{}`` in some of them is filled in."""

    asks: str
    again: str
    """Follows ``asks`` where the same thing is asked once more."""
    yes: str
    no: str
    unsure: str
    """What to type, one word or two each."""
    unsure_means: str
    """What happens then."""
    letters: str
    """Those that answer alone, on an empty line."""
    orders: str
    """What may be ordered; ``{}``: seconds of patience."""
    prompt: str
    better: str
    """Stands above better words that came later."""
    repeat: str
    """Answers words that were not understood; says what may be said."""
    repeat_choice: str
    """The same where options were offered."""
    given_up: str
    """The same the second time."""
    read_back: str
    """What was understood; ``{}``: the reply and what it does."""
    nothing_asked: str
    """Answers a line that is no order while nothing is asked."""
    nothing_more: str
    """Answers *show* and *why* where there is nothing to be shown."""
    back: str
    """What may be asked back."""


WORDS: Mapping[str, ScreenWords] = MappingProxyType(
    {
        "en": ScreenWords(
            asks="The drone asks",
            again="asked again in other words",
            yes="y  yes",
            no="n  no",
            unsure="?  don't know",
            unsure_means="it asks something else, or takes the careful way",
            letters="ynu?",
            orders="Orders: hold, continue, return, land, abort. Without an answer in {} s it takes the careful way.",
            prompt="Your answer: ",
            better="The same in other words:",
            repeat="I do not understand. Please say yes, no or don't know (y, n, ?), what is the case, or an order: "
            "hold, return, abort.",
            repeat_choice="I do not understand. Please give the number of an option, don't know (?), or an order.",
            given_up="I do not understand: I take it as 'don't know'.",
            read_back="I understood {}: {}. Is that right? Yes or no: ",
            nothing_asked="Nothing is asked now. Orders: hold, continue, return, land, abort.",
            nothing_more="Nothing more is known of it.",
            back="Ask back: where, show (map and picture), why, wait (more time), repeat.",
        ),
        "de": ScreenWords(
            asks="Die Drohne fragt",
            again="noch einmal, mit anderen Worten",
            yes="j  ja",
            no="n  nein",
            unsure="?  weiß nicht",
            unsure_means="sie fragt etwas anderes oder nimmt den vorsichtigen Weg",
            letters="jynu?",
            orders="Befehle: halt, weiter, zurück, landen, abbrechen. "
            "Ohne Antwort in {} s nimmt sie den vorsichtigen Weg.",
            prompt="Ihre Antwort: ",
            better="Dasselbe in anderen Worten:",
            repeat="Das habe ich nicht verstanden. Bitte: ja, nein, weiß nicht (?), oder ein Befehl: halt, zurück, "
            "abbrechen.",
            repeat_choice="Das habe ich nicht verstanden. Bitte eine der Nummern, weiß nicht (?), oder ein Befehl.",
            given_up="Das habe ich nicht verstanden: es gilt als „weiß nicht“.",
            read_back="Ich habe verstanden: {}, {}. Stimmt das? Ja oder nein: ",
            nothing_asked="Gerade wird nichts gefragt. Befehle: halt, weiter, zurück, landen, abbrechen.",
            nothing_more="Mehr ist dazu nicht bekannt.",
            back="Rückfragen: wo, zeigen (Karte und Bild), warum, warten (mehr Zeit), wiederholen.",
        ),
        "fr": ScreenWords(
            asks="Le drone demande",
            again="encore une fois, en d'autres mots",
            yes="o  oui",
            no="n  non",
            unsure="?  je ne sais pas",
            unsure_means="il demande autre chose ou prend le chemin prudent",
            letters="oynu?",
            orders="Ordres : stop, continue, reviens, atterris, annule. "
            "Sans réponse en {} s, il prend le chemin prudent.",
            prompt="Votre réponse : ",
            better="La même chose en d'autres mots :",
            repeat="Je n'ai pas compris. Dites : oui, non, je ne sais pas (?), ou un ordre : stop, reviens, annule.",
            repeat_choice="Je n'ai pas compris. Dites le numéro d'un choix, je ne sais pas (?), ou un ordre.",
            given_up="Je n'ai pas compris : cela compte comme « je ne sais pas ».",
            read_back="J'ai compris : {}, {}. C'est juste ? Oui ou non : ",
            nothing_asked="Rien n'est demandé. Ordres : stop, continue, reviens, atterris, annule.",
            nothing_more="On n'en sait pas plus.",
            back="Questions en retour : où, montre (carte et image), pourquoi, attends (plus de temps), répète.",
        ),
        "es": ScreenWords(
            asks="El dron pregunta",
            again="otra vez, con otras palabras",
            yes="s  sí",
            no="n  no",
            unsure="?  no sé",
            unsure_means="pregunta otra cosa o toma el camino prudente",
            letters="synu?",
            orders="Órdenes: alto, sigue, vuelve, aterriza, cancela. Sin respuesta en {} s toma el camino prudente.",
            prompt="Su respuesta: ",
            better="Lo mismo con otras palabras:",
            repeat="No he entendido. Diga: sí, no, no sé (?), o una orden: alto, vuelve, cancela.",
            repeat_choice="No he entendido. Diga el número de una opción, no sé (?), o una orden.",
            given_up="No he entendido: cuenta como «no sé».",
            read_back="He entendido: {}, {}. ¿Es correcto? Sí o no: ",
            nothing_asked="No se pregunta nada ahora. Órdenes: alto, sigue, vuelve, aterriza, cancela.",
            nothing_more="No se sabe nada más.",
            back="Puede preguntar: dónde, muestra (mapa e imagen), por qué, espera (más tiempo), repite.",
        ),
    }
)


def screen_words(lang: str) -> ScreenWords:
    """The words of that language. Raises `UnknownNameError` for one that is not known."""
    if lang not in WORDS:
        raise UnknownNameError("language", lang, WORDS)
    return WORDS[lang]
