"""Plain answers and orders in German, French and Spanish. Tables only, and no guessing: every word must be known."""

from __future__ import annotations

import re
from collections.abc import Mapping

from mintpilot.core.query import Order

YES, NO, UNSURE, COMMAND = "yes", "no", "unsure", "command"

_TABLES: Mapping[str, Mapping[str, str]] = {
    "de": {
        YES: "ja|jawohl|jo|jep|genau|richtig|stimmt|das stimmt|sicher|klar|natürlich|selbstverständlich|unbedingt"
        "|auf jeden fall|in ordnung|geht klar|passt|einverstanden|das ist richtig|mach das|mach es"
        "|los|nur zu|ja bitte"
        "|ja genau|klar doch|alles klar|bestätigt|bestätige|freigegeben|korrekt|absolut|definitiv|gerne|okay|ok",
        NO: "nein|nee|nö|ne|niemals|nie|auf keinen fall|keinesfalls|falsch|bloß nicht|nein danke|lieber nicht"
        "|besser nicht|nicht|stimmt nicht|das stimmt nicht|gar nicht|überhaupt nicht|keineswegs|negativ"
        "|das ist falsch|mach das nicht"
        "|zu gefährlich|gefährlich|giftig|nicht durchfliegen|niemand|keiner|leer|der andere|die andere"
        "|das andere|das ist nicht sicher|das ist gefährlich|es ist gefährlich|da ist niemand|es ist niemand da",
        UNSURE: "weiß nicht|ich weiß nicht|ich weiß es nicht|keine ahnung|vielleicht|möglicherweise"
        "|eventuell|unsicher"
        "|ich bin nicht sicher|ich bin mir nicht sicher|bin nicht sicher|schwer zu sagen|kommt darauf an|moment"
        "|einen moment|wie bitte|was|bitte wiederholen|nochmal|noch einmal|ich glaube|ich glaube schon"
        "|ich denke schon|wahrscheinlich|vermutlich|wohl|jein|egal|weiss nicht|ich weiss nicht|ich weiss es nicht",
        Order.HOLD: "stopp|stop|halt|anhalten|warte|warten|bleib stehen|stehen bleiben|warte dort"
        "|sofort anhalten|pause",
        Order.ABORT: "abbrechen|abbruch|aufhören|brich ab|mission abbrechen|sofort abbrechen",
        Order.RETURN: "komm zurück|zurück|zurückkommen|umkehren|kehr um|komm heim|nach hause|komm wieder her",
        "": "bitte|danke|doch|mal|jetzt|sofort|also|ach|äh|ähm|na|nun|drohne",
    },
    "fr": {
        YES: "oui|ouais|ouaip|exact|exactement|c'est exact|correct|c'est ça|bien sûr|certainement|absolument"
        "|tout à fait|d'accord|affirmatif|vas y|allez y|allez|confirmé|je confirme|c'est bon|parfait|évidemment"
        "|entendu|ok|okay|sans problème|oui bien sûr|si",
        NO: "non|non merci|nan|jamais|négatif|pas du tout|surtout pas|faux|c'est faux|pas question"
        "|hors de question|en aucun cas"
        "|absolument pas|certainement pas|mieux vaut pas|plutôt pas|trop dangereux|dangereux|c'est dangereux|toxique"
        "|c'est toxique|personne|il n'y a personne|vide|c'est vide|l'autre|pas celui là|pas celle là|ne fais pas ça"
        "|n'y va pas|ce n'est pas sûr|contourne|évite",
        UNSURE: "je ne sais pas|je sais pas|sais pas|j'sais pas|chais pas|aucune idée|peut être|possible|possiblement"
        "|pas sûr|je ne suis pas sûr|je suis pas sûr|pas certain|difficile à dire|ça dépend|un moment"
        "|un instant|pardon|comment|quoi|répète|répétez|encore une fois|je crois|je crois que oui|je pense"
        "|je pense que oui|probablement|sans doute|oui et non|peu importe",
        Order.HOLD: "stop|attends|attendez|arrête|arrêtez|arrête toi|halte|reste là|ne bouge plus|pause",
        Order.ABORT: "abandonne|abandonner|annuler|abandonnez|annule|annulez|annule la mission"
        "|interromps la mission|avorte",
        Order.RETURN: "reviens|revenez|retour|rentre|rentrez|reviens ici|rentre à la base|retour à la base|demi tour",
        "": "s'il te plaît|s'il vous plaît|merci|donc|alors|euh|bon|ben|maintenant|tout de suite|drone",
    },
    "es": {
        YES: "sí|si|claro|claro que sí|por supuesto|correcto|exacto|exactamente|así es|eso es|es correcto|vale"
        "|de acuerdo|afirmativo|adelante|desde luego|confirmado|confirmo|sin duda|absolutamente|seguro que sí"
        "|sin problema|ok|okay|hazlo|dale|venga|perfecto",
        NO: "no|nunca|jamás|negativo|para nada|de ninguna manera|ni hablar|falso|es falso|incorrecto|en absoluto"
        "|claro que no|por supuesto que no|desde luego que no|mejor no|demasiado peligroso|peligroso|es peligroso"
        "|tóxico|es tóxico|nadie|no hay nadie|vacío|vacía|está vacío|está vacía|el otro|la otra|ese no|esa no"
        "|no gracias|no lo hagas|no vayas|no es seguro|evítalo|rodéalo",
        UNSURE: "no sé|no lo sé|no se|no lo se|ni idea|no tengo ni idea|quizás|quizá|tal vez"
        "|a lo mejor|puede ser|puede"
        "|posiblemente|no estoy seguro|no estoy segura|no seguro|difícil de decir|depende|un momento"
        "|cómo|qué|perdón|repite|repita|otra vez|creo que sí|creo|supongo|probablemente|sí y no|da igual",
        Order.HOLD: "alto|espera|espere|parar|para|pare|detente|deténgase|stop|quieto|quédate ahí|pausa",
        Order.ABORT: "aborta|cancelar|aborte|abortar|cancela|cancele|cancela la misión|cancelar la misión",
        Order.RETURN: "vuelve|volver|regresar|atrás|vuelva|regresa|regrese|vuelve aquí"
        "|vuelve a la base|regresa a la base|a casa",
        "": "por favor|gracias|pues|bueno|eh|entonces|ahora|ya|señor|dron",
    },
}
"""Language → meaning → phrases, split by bars; the empty meaning is politeness."""


def understand_foreign(text: str, language: str) -> tuple[str, Order | None] | None:
    """The reading and, for orders, the command; None where a word is not known or two things are said.

    Args:
        text: the words.
        language: ``de``, ``fr`` or ``es``; in any other nothing is understood.
    """
    words = text.lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'").replace("-", " ")
    words = " ".join(re.sub(r"[^\w\s',;.!?]", " ", words).split())
    phrases = [(p, meaning) for meaning, row in _TABLES.get(language, {}).items() for p in row.split("|")]
    said: set[str] = set()
    for phrase, meaning in sorted(phrases, key=lambda pair: -len(pair[0])):
        words, found = re.subn(rf"(?<![\w']){re.escape(phrase)}(?![\w'])", ";", words)
        if found and meaning:
            said.add(meaning)
    orders = [command for command in (Order.ABORT, Order.RETURN, Order.HOLD) if command in said]
    if orders and not said & {NO}:
        return COMMAND, orders[0]
    if re.search(r"\w", words) or not said:
        return None
    if UNSURE in said:
        return UNSURE, None
    return (said.pop(), None) if len(said) == 1 and not orders else None
