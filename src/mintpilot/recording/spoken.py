"""What a report says in fixed words, in the operator's language: how it ended, its headings, what looks came to.

What was worked out in figures (reasons, explanations, certificates) is told in English in every language.
"""

from __future__ import annotations

from collections.abc import Mapping

from mintpilot.core.mission import Outcome, Sight
from mintpilot.recording.words import OUTCOME_WORDS

_OUTCOMES: Mapping[str, Mapping[Outcome, str]] = {
    "de": {
        Outcome.SUCCESS: "Auftrag erfüllt",
        Outcome.PARTIAL: "Teilweise erledigt: einiges blieb offen",
        Outcome.COLLISION: "Gescheitert: die Drohne hat etwas berührt",
        Outcome.TOXIC_SMOKE: "Gescheitert: die Drohne flog in giftigen Rauch",
        Outcome.ENDURANCE: "Gescheitert: die Flugzeit ging zu Ende",
        Outcome.LEFT_VOLUME: "Gescheitert: die Drohne verließ ihren Flugraum",
        Outcome.WRONG_TARGET: "Gescheitert: das falsche Ziel wurde erreicht",
        Outcome.PERSON_MISSED: "Gescheitert: jemand wurde nicht gefunden",
        Outcome.NO_SAFE_PLAN: "Nicht geflogen: kein sicherer Weg war bekannt",
        Outcome.ABORTED: "Vor dem Ende abgebrochen",
        Outcome.VEHICLE_FAILED: "Gescheitert: das Fluggerät oder seine Verbindung fiel aus",
        Outcome.RULE_BROKEN: "Gescheitert: eine Regel des Auftrags wurde verletzt",
        Outcome.NOT_REACHED: "Gescheitert: nicht jedes Ziel wurde erreicht",
    },
    "fr": {
        Outcome.SUCCESS: "Mission accomplie",
        Outcome.PARTIAL: "Accomplie en partie : il reste des étapes",
        Outcome.COLLISION: "Échec : le drone a touché quelque chose",
        Outcome.TOXIC_SMOKE: "Échec : le drone est entré dans une fumée toxique",
        Outcome.ENDURANCE: "Échec : le temps de vol est épuisé",
        Outcome.LEFT_VOLUME: "Échec : le drone a quitté son espace autorisé",
        Outcome.WRONG_TARGET: "Échec : la mauvaise cible a été atteinte",
        Outcome.PERSON_MISSED: "Échec : quelqu'un n'a pas été trouvé",
        Outcome.NO_SAFE_PLAN: "Pas de vol : aucun chemin sûr n'était connu",
        Outcome.ABORTED: "Interrompue avant la fin",
        Outcome.VEHICLE_FAILED: "Échec : le drone ou sa liaison est en panne",
        Outcome.RULE_BROKEN: "Échec : une règle de la mission a été enfreinte",
        Outcome.NOT_REACHED: "Échec : tous les buts n'ont pas été atteints",
    },
    "es": {
        Outcome.SUCCESS: "Misión cumplida",
        Outcome.PARTIAL: "Cumplida en parte: quedan pasos por hacer",
        Outcome.COLLISION: "Fracaso: el dron tocó algo",
        Outcome.TOXIC_SMOKE: "Fracaso: el dron entró en humo tóxico",
        Outcome.ENDURANCE: "Fracaso: se agotó el tiempo de vuelo",
        Outcome.LEFT_VOLUME: "Fracaso: el dron salió de su espacio permitido",
        Outcome.WRONG_TARGET: "Fracaso: se alcanzó el objetivo equivocado",
        Outcome.PERSON_MISSED: "Fracaso: no se encontró a alguien",
        Outcome.NO_SAFE_PLAN: "Sin vuelo: no se conocía un camino seguro",
        Outcome.ABORTED: "Interrumpida antes de terminar",
        Outcome.VEHICLE_FAILED: "Fracaso: falló el dron o su enlace",
        Outcome.RULE_BROKEN: "Fracaso: se incumplió una regla de la misión",
        Outcome.NOT_REACHED: "Fracaso: no se alcanzaron todos los objetivos",
    },
}
_HEADINGS: Mapping[str, Mapping[str, str]] = {
    "de": {
        "What it saw": "Was sie sah", "What it did not know": "Was sie nicht wusste", "What it asked": "Was sie fragte",
        "How it decided": "Wie sie entschied", "What it flew": "Was sie flog", "Order": "Auftrag",
        "The way it flew": "Der geflogene Weg", "Nothing.": "Nichts.",
    },
    "fr": {
        "What it saw": "Ce qu'il a vu", "What it did not know": "Ce qu'il ne savait pas",
        "What it asked": "Ce qu'il a demandé", "How it decided": "Comment il a décidé",
        "What it flew": "Ce qu'il a parcouru", "Order": "Ordre", "The way it flew": "Le chemin parcouru",
        "Nothing.": "Rien.",
    },
    "es": {
        "What it saw": "Lo que vio", "What it did not know": "Lo que no sabía", "What it asked": "Lo que preguntó",
        "How it decided": "Cómo decidió", "What it flew": "Lo que voló", "Order": "Orden",
        "The way it flew": "El camino volado", "Nothing.": "Nada.",
    },
}  # fmt: skip
SIGHTS: Mapping[str, Mapping[Sight, str]] = {
    "de": {
        Sight.FOUND: "gefunden: {count} {what}", Sight.EMPTY: "nichts davon ist dort",
        Sight.UNSEEN: "war nicht zu sehen ({share} der Türbreite)",
    },
    "fr": {
        Sight.FOUND: "trouvé : {count} {what}", Sight.EMPTY: "il n'y en a pas",
        Sight.UNSEEN: "n'a pas pu être vu ({share} de la porte)",
    },
    "es": {
        Sight.FOUND: "encontrado: {count} {what}", Sight.EMPTY: "no hay nada de eso",
        Sight.UNSEEN: "no se pudo ver ({share} de la puerta)",
    },
}  # fmt: skip
"""What a look into a room came to; English has sentences of its own."""

PERSONS: Mapping[str, tuple[str, str]] = {
    "de": ("Person", "Personen"), "fr": ("personne", "personnes"), "es": ("persona", "personas"),
}  # fmt: skip
"""One, and several."""


def outcome_words(outcome: Outcome, lang: str) -> str:
    """How a mission ended."""
    return _OUTCOMES.get(lang, OUTCOME_WORDS)[outcome]


def heading(english: str, lang: str) -> str:
    """A heading in that language; as it is where no table has it."""
    return _HEADINGS.get(lang, {}).get(english, english)
