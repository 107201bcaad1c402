"""Words and sentences of three more languages: German, French, Spanish. Tables only.

A noun is given with its gender (m, f, n; p: plural, feminine where it matters), an adjective by its forms; sentences
take a subject in the nominative, so that no other case is needed but the one after words for a place.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from mintpilot.core.gap import PASSABLE, PRESENT


@dataclass(frozen=True, slots=True, kw_only=True)
class Tongue:
    """What is needed to ask in one language."""

    name: str
    names: Mapping[str, str] = field(default_factory=dict)
    """What the mission itself calls things: English words → the same."""
    articles: Mapping[str, str]
    """Gender → definite article, nominative."""
    places: Mapping[str, Mapping[str, str]]
    """*near*, *in*, *behind*, *from*, *on* → gender → the same with the definite article."""
    nouns: Mapping[str, str]
    """English noun → gender and noun: ``m Rauch``."""
    adjectives: Mapping[str, str]
    """English adjective → stem (German), or masculine and feminine forms."""
    before: frozenset[str]
    """Adjectives that come before the noun."""
    ends_by_case: bool
    """True where an adjective's ending is the same for all genders and changes by case (German after an article)."""
    asks: Mapping[str, str]
    """Kind of cut → question; ``{}`` is the subject."""
    states: Mapping[str, str]
    """Kind of cut → statement, for cuts of several parts."""
    joined: tuple[str, str, str]
    """Frame of a question of several parts, and, or."""
    choice: tuple[str, str, str]
    """Frame of a choice, or, none of these."""
    outcomes: Mapping[str, str]
    """English consequence → the same; ``{}`` stands for what is called by name."""
    quotes: str
    """Quotation marks; ``{}`` stands between them."""
    probably: str
    longer: str


VALUE, ATTRIBUTE = "value", "attribute"

GERMAN = Tongue(
    name="de",
    articles={"m": "der", "f": "die", "n": "das", "p": "die"},
    places={
        "near": {"m": "beim", "f": "bei der", "n": "beim", "p": "bei den"},
        "in": {"m": "im", "f": "in der", "n": "im", "p": "in den"},
        "behind": {"m": "hinter dem", "f": "hinter der", "n": "hinter dem", "p": "hinter den"},
        "from": {"m": "aus dem", "f": "aus der", "n": "aus dem", "p": "aus den"},
        "on": {"m": "auf dem", "f": "auf der", "n": "auf dem", "p": "auf den"},
    },
    nouns={
        "smoke": "m Rauch", "cloud": "f Wolke", "gate": "n Tor", "door": "f Tür", "room": "m Raum", "rack": "n Regal",
        "box": "f Kiste", "crate": "f Kiste", "person": "f Person", "fire": "n Feuer", "wall": "f Wand",
        "barrel": "n Fass", "pillar": "m Pfeiler", "area": "m Bereich", "region": "m Bereich", "start": "m Start",
        "rubble": "m Schutt", "shelf": "n Regal", "object": "n Ding", "space": "m Raum", "people": "p Personen",
        "man": "m Mann", "woman": "f Frau", "child": "n Kind", "worker": "m Arbeiter", "firefighter": "f Einsatzkraft",
        "bottle": "f Flasche", "medicine": "n Medikament", "water": "n Wasser", "bag": "f Tasche", "key": "m Schlüssel",
        "phone": "n Telefon", "table": "m Tisch", "chair": "m Stuhl", "kitchen": "f Küche", "office": "n Büro",
        "bathroom": "n Bad", "bedroom": "n Schlafzimmer", "corridor": "m Flur", "garage": "f Garage",
        "warehouse": "n Lager", "hall": "f Halle", "house": "n Haus", "building": "n Gebäude", "window": "n Fenster",
        "roof": "n Dach", "tree": "m Baum", "car": "n Auto", "truck": "m Lastwagen", "tent": "n Zelt", "tank": "m Tank",
        "valve": "n Ventil", "exit": "m Ausgang", "corner": "f Ecke",
    },
    adjectives={
        "red": "rot", "blue": "blau", "green": "grün", "yellow": "gelb", "white": "weiß", "black": "schwarz",
        "grey": "grau", "brown": "braun", "orange": "orangefarben", "small": "klein", "large": "groß",
        "medium": "mittelgroß", "closed": "geschlossen", "dark": "dunkl", "injured": "verletzt", "nearest": "nächst",
        "second": "zweit", "third": "dritt", "fourth": "viert", "fifth": "fünft", "burning": "brennend",
        "unseen": "ungesehen", "open": "offen",
        "cubic": "würfelförmig", "cylindrical": "zylindrisch", "spherical": "kugelförmig",
    },
    before=frozenset({"*"}),
    ends_by_case=True,
    asks={
        PASSABLE: "Ist {} zum Durchfliegen sicher?",
        PRESENT: "Ist jemand hier drin: {}?",
        VALUE: "Ist es {}?",
        ATTRIBUTE: "Ist das Gesuchte {}?",
    },
    states={
        PASSABLE: "{} ist sicher", PRESENT: "jemand ist hier drin: {}", VALUE: "es ist {}", ATTRIBUTE: "es ist {}",
    },
    joined=("Stimmt das: {}?", "und", "oder"),
    choice=("Welches ist gemeint: {}?", "oder", "keins davon"),
    outcomes={
        "fly through it": "ich fliege hindurch", "fly around it": "ich fliege außen herum",
        "fly through them": "ich fliege hindurch", "fly around them": "ich fliege außen herum",
        "look inside": "ich sehe hinein", "fly past it": "ich fliege vorbei", "fly past them": "ich fliege vorbei",
        "fly to {}": "ich fliege zu: {}", "ask further: {} or {}": "ich frage weiter: {} oder {}",
        "ask further: {} of them are left": "ich frage weiter: {} davon bleiben übrig",
        "ask further: {} others are left": "ich frage weiter: {} andere bleiben übrig",
        "find no safe way": "ich finde keinen sicheren Weg",
        "take it that you mean that": "ich verstehe, dass das gemeint ist",
        "take it that you mean another": "ich verstehe, dass etwas anderes gemeint ist",
    },
    quotes="„{}“",
    probably="wahrscheinlich: {}",
    longer="{}, {} s länger",
)  # fmt: skip

FRENCH = Tongue(
    name="fr",
    articles={"m": "le", "f": "la", "p": "les"},
    places={
        "near": {"m": "près du", "f": "près de la", "p": "près des"},
        "in": {"m": "dans le", "f": "dans la", "p": "dans les"},
        "behind": {"m": "derrière le", "f": "derrière la", "p": "derrière les"},
        "from": {"m": "du", "f": "de la", "p": "des"},
        "on": {"m": "sur le", "f": "sur la", "p": "sur les"},
    },
    nouns={
        "smoke": "f fumée", "cloud": "m nuage", "gate": "m portail", "door": "f porte", "room": "f pièce",
        "rack": "m rayonnage", "box": "f boîte", "crate": "f caisse", "person": "f personne", "fire": "m feu",
        "wall": "m mur", "barrel": "m baril", "pillar": "m pilier", "area": "f zone", "region": "f zone",
        "start": "m départ", "rubble": "p décombres", "shelf": "m rayonnage", "object": "m objet", "space": "m espace",
        "people": "p personnes", "man": "m homme", "woman": "f femme", "child": "m enfant", "worker": "m travailleur",
        "firefighter": "m pompier", "bottle": "f bouteille", "medicine": "m médicament", "water": "f eau",
        "bag": "m sac", "key": "f clé", "phone": "m téléphone", "table": "f table", "chair": "f chaise",
        "kitchen": "f cuisine", "office": "m bureau", "bathroom": "f salle de bain", "bedroom": "f chambre",
        "corridor": "m couloir", "garage": "m garage", "warehouse": "m dépôt", "hall": "m hall", "house": "f maison",
        "building": "m bâtiment", "window": "f fenêtre", "roof": "m toit", "tree": "m arbre", "car": "f voiture",
        "truck": "m camion", "tent": "f tente", "tank": "m réservoir", "valve": "f vanne", "exit": "f sortie",
        "corner": "m coin",
    },
    adjectives={
        "red": "rouge rouge", "blue": "bleu bleue", "green": "vert verte", "yellow": "jaune jaune",
        "white": "blanc blanche", "black": "noir noire", "grey": "gris grise", "brown": "brun brune",
        "orange": "orange orange", "small": "petit petite", "large": "grand grande", "medium": "moyen moyenne",
        "closed": "fermé fermée", "dark": "sombre sombre", "injured": "blessé blessée",
        "nearest": "le_plus_proche la_plus_proche", "burning": "en_feu en_feu",
        "unseen": "non_vu non_vue", "open": "ouvert ouverte",
        "cubic": "cubique cubique", "cylindrical": "cylindrique cylindrique", "spherical": "sphérique sphérique",
    },
    before=frozenset({"small", "large"}),
    ends_by_case=False,
    asks={
        PASSABLE: "Peut-on traverser sans danger {} ?",
        PRESENT: "Y a-t-il quelqu'un ici : {} ?",
        VALUE: "Est-ce {} ?",
        ATTRIBUTE: "L'objet voulu est-il {} ?",
    },
    states={
        PASSABLE: "{} est sans danger", PRESENT: "il y a quelqu'un ici : {}", VALUE: "c'est {}",
        ATTRIBUTE: "il est {}",
    },
    joined=("Est-ce exact : {} ?", "et", "ou"),
    choice=("Lequel est-ce : {} ?", "ou", "aucun d'eux"),
    outcomes={
        "fly through it": "je passe à travers", "fly around it": "je fais le tour",
        "fly through them": "je passe à travers", "fly around them": "je fais le tour",
        "look inside": "je regarde à l'intérieur", "fly past it": "je passe à côté",
        "fly past them": "je passe à côté", "fly to {}": "je vole vers : {}",
        "ask further: {} or {}": "je demande encore : {} ou {}",
        "ask further: {} of them are left": "je demande encore : il en reste {}",
        "ask further: {} others are left": "je demande encore : il en reste {} autres",
        "find no safe way": "je ne trouve aucun chemin sûr",
        "take it that you mean that": "je comprends que c'est cela",
        "take it that you mean another": "je comprends que c'est un autre",
    },
    quotes="« {} »",
    probably="probablement : {}",
    longer="{}, {} s de plus",
)  # fmt: skip

SPANISH = Tongue(
    name="es",
    articles={"m": "el", "f": "la", "p": "las"},
    places={
        "near": {"m": "cerca del", "f": "cerca de la", "p": "cerca de las"},
        "in": {"m": "en el", "f": "en la", "p": "en las"},
        "behind": {"m": "detrás del", "f": "detrás de la", "p": "detrás de las"},
        "from": {"m": "del", "f": "de la", "p": "de las"},
        "on": {"m": "sobre el", "f": "sobre la", "p": "sobre las"},
    },
    nouns={
        "smoke": "m humo", "cloud": "f nube", "gate": "m portón", "door": "f puerta", "room": "f sala",
        "rack": "m estante", "box": "f caja", "crate": "f caja", "person": "f persona", "fire": "m fuego",
        "wall": "f pared", "barrel": "m barril", "pillar": "m pilar", "area": "f zona", "region": "f zona",
        "start": "m inicio", "rubble": "m escombro", "shelf": "m estante", "object": "m objeto", "space": "m espacio",
        "people": "p personas", "man": "m hombre", "woman": "f mujer", "child": "m niño", "worker": "m trabajador",
        "firefighter": "m bombero", "bottle": "f botella", "medicine": "m medicamento", "water": "f agua",
        "bag": "f bolsa", "key": "f llave", "phone": "m teléfono", "table": "f mesa", "chair": "f silla",
        "kitchen": "f cocina", "office": "f oficina", "bathroom": "m baño", "bedroom": "m dormitorio",
        "corridor": "m pasillo",
        "garage": "m garaje", "warehouse": "m almacén", "hall": "f nave", "house": "f casa", "building": "m edificio",
        "window": "f ventana", "roof": "m tejado", "tree": "m árbol", "car": "m coche", "truck": "m camión",
        "tent": "f tienda", "tank": "m depósito", "valve": "f válvula", "exit": "f salida", "corner": "f esquina",
    },
    adjectives={
        "red": "rojo roja", "blue": "azul azul", "green": "verde verde", "yellow": "amarillo amarilla",
        "white": "blanco blanca", "black": "negro negra", "grey": "gris gris", "brown": "marrón marrón",
        "orange": "naranja naranja", "small": "pequeño pequeña", "large": "grande grande",
        "medium": "mediano mediana", "closed": "cerrado cerrada", "dark": "oscuro oscura", "injured": "herido herida",
        "nearest": "más_cercano más_cercana", "burning": "en_llamas en_llamas", "unseen": "no_visto no_vista",
        "open": "abierto abierta",
        "cubic": "cúbico cúbica", "cylindrical": "cilíndrico cilíndrica", "spherical": "esférico esférica",
    },
    before=frozenset(),
    ends_by_case=False,
    asks={
        PASSABLE: "¿Se puede atravesar sin peligro {}?",
        PRESENT: "¿Hay alguien aquí dentro: {}?",
        VALUE: "¿Es {}?",
        ATTRIBUTE: "¿Lo que busca es {}?",
    },
    states={PASSABLE: "{} es seguro", PRESENT: "hay alguien aquí dentro: {}", VALUE: "es {}", ATTRIBUTE: "es {}"},
    joined=("¿Es cierto: {}?", "y", "o"),
    choice=("¿Cuál es: {}?", "o", "ninguno de ellos"),
    outcomes={
        "fly through it": "lo atravieso", "fly around it": "lo rodeo", "fly through them": "los atravieso",
        "fly around them": "los rodeo", "look inside": "miro dentro", "fly past it": "paso de largo",
        "fly past them": "paso de largo", "fly to {}": "vuelo hacia: {}",
        "ask further: {} or {}": "sigo preguntando: {} o {}",
        "ask further: {} of them are left": "sigo preguntando: quedan {} de esos",
        "ask further: {} others are left": "sigo preguntando: quedan otros {}",
        "find no safe way": "no encuentro un camino seguro",
        "take it that you mean that": "entiendo que es eso",
        "take it that you mean another": "entiendo que es otra cosa",
    },
    quotes="«{}»",
    probably="probablemente: {}",
    longer="{}, {} s más",
)  # fmt: skip

TONGUES: Mapping[str, Tongue] = {tongue.name: tongue for tongue in (GERMAN, FRENCH, SPANISH)}
"""By their two-letter codes. English needs none: it is what the templates speak."""
