"""The words by which answers are read, in four languages (method, section 12). Tables only.

Entries are in lower case, without marks, separated by ``|``. `LISTED` entries count only as whole utterances; the
others are regular expressions that are looked for among the words.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from mintpilot.core.query import Order
from mintpilot.core.reading import ReadingKind

LISTED = 60
"""Most closed utterances that a language may have for replies, and most for orders."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AnswerWords:
    """One language; ``yes`` to ``confirm``, ``orders`` and ``back`` are closed lists."""

    yes: str
    no: str
    passable: str
    """The region may be crossed."""
    absent: str
    """Nobody is there."""
    confirm: str
    """Confirms a read-back, typed or by voice."""
    keys: Mapping[str, str] = field(default_factory=dict)
    """Letters of this language beside y, n, u and ?."""
    seems_passable: str
    """Agrees that the region may be crossed, good for a read-back only."""
    seems_absent: str
    courtesies: str
    """Say nothing; also taken off both ends of orders and questions back."""
    fillers: str
    """May stand in an agreement beside the words of the closed lists and of the question."""
    nay: str
    """Veto of a Yes."""
    aye: str
    """Veto of a No."""
    denial: str
    """Veto, as the five after it: turns or takes back what is said beside it."""
    danger: str
    doubt: str
    condition: str
    limits: str
    """Another time, a part, another place, or what somebody else said."""
    asks: str
    blocked: str
    """Read loosely: the region must not be entered."""
    not_blocked: str
    """Cancels it: a danger that is denied, a No that refuses nothing."""
    present: str
    """Read loosely: somebody is there."""
    unsure: str
    """Read loosely: the person does not know."""
    orders: Mapping[Order, str]
    back: Mapping[ReadingKind, str]
    """Questions back, and asking for time."""
    articles: str
    things: str
    """Stand for a thing's name: ``one``."""
    states: str
    """Stand before an attribute: ``it is``, ``I mean``."""
    negates: str
    """Denies the attribute after it."""
    attributes: Mapping[str, str]
    """Other words for English attribute values."""


ENGLISH = AnswerWords(
    yes="y|yes|yeah|yep|yup|yes please|yes it is|affirmative|correct|that's right|that is right|that's correct|that is "
        "correct|absolutely|definitely|certainly|of course|sure",
    no="n|no|nope|negative|no sir",
    passable="safe|it is safe|it's safe|yes it is safe|yes it's safe|yes safe|perfectly safe|harmless|it is harmless|"
        "it's harmless|it is safe to fly through|it's safe to fly through|you can fly through it|the smoke is safe",
    absent="nobody|no one|nobody is inside|nobody is in there|no one is inside|no one is in there|there is nobody "
        "inside|there's nobody inside|there is nobody in there|there is no one inside|there's no one inside|empty|it "
        "is empty|it's empty|the room is empty|no it is empty|no it's empty|no nobody",
    confirm="confirm|confirmed|i confirm",
    seems_passable="safe|harmless|it is (?:okay|ok|fine|clear)|it's (?:okay|ok|fine|clear)|(?:fly|go|pass) through",
    seems_absent="nobody|no ?one|empty|no person|no(?=[,.;!]|$)",
    courtesies="please|thanks|thank you|sir|madam|drone|well|uh|um|er|hm|okay|ok|alright|all right|hello|hi|hey|bye",
    fillers="it is it's that that's this there there's the a an one in inside through to you can may fly go pass "
        "perfectly completely totally absolutely really indeed definitely all good fine clear",
    nay="no|nope|nah|negative|none|nobody|no ?one|neither|nor|empty|unsafe",
    aye="y|yes|yeah|yep|yup|sure|affirmative|correct|somebody|someone|person inside|people",
    denial=r"not|never|\w+n't|dont|isnt|cant|wont|cannot|without|wrong|false|mistake|incorrect|refuse\w*|forget|"
        r"forbid\w*|kidding|jok\w+|sorry|opposite|unless|hardly|lied?|yeah,? right|take (?:it|that) back",
    danger=r"toxic|poison\w*|danger\w*|hazard\w*|risk\w*|burn\w*|fire|flames?|hot|acid|chlorine|gas|kill\w*|dead\w*|"
        r"die[ds]?|lethal|hurts?|injur\w*|explo\w*|careful\w*|caution|beware|watch|mind|avoid|away|around|stay|keep|"
        r"unsafe|mask",
    doubt=r"maybe|perhaps|probabl[ey]|possibl[ey]|likely|guess|think|believe|suppose\w*|hope\w*|seem\w*|looks?|might|"
        r"could|should|would|almost|nearly|fairly|mostly|more or less|kind of|sort of|theory|principle|unsure|doubt\w*|"
        r"assum\w*|ought|pretty|know|normally|usually|generally|reckon|feel|idea|ish",
    condition=r"if|once|provided|depend\w*|as long as|except\w*|apart|but|only|until|till|while|when|then|just",
    limits=r"was|were|used|will|soon|later|yet|tomorrow|yesterday|today|tonight|morning|noon|ago|still|already|any "
        r"?more|earlier|minutes?|hours?|seconds?|before|after|last|wait|moment|sometimes|often|always|not now|later on|"
        r"going to|some|part\w*|half|side|edges?|most|others?|few|upper|lower|above|below|middle|bits?|either|both|"
        r"another|rest|far|far enough|said|says?|heard|hear|told|tells?|apparently|supposedly|allegedly|according|"
        r"manual|log|they|he|she|thinks|claims?",
    asks="what|why|who|where|how|which|(?:^(?:is|are|am|do|does|did|can|could|may|will|would|should|has)(?= .))",
    blocked=r"(?:not|isn't|isnt|aren't|ain't|never|hardly) (?:\w+ ){0,2}(?:safe|okay|ok|harmless|clear|passable|wise|a "
        r"good idea)|unsafe|no way|never|toxic|poison\w*|danger\w*|hazardous|chlorine|acid|burning|burns?|flames?|"
        r"explo\w*|lethal|deadly|kills?|(?:stay|keep) (?:out|away|clear|off)|avoid|(?<!i )(?<!we )(?<!they )(?:do not|"
        r"don't|dont)(?! (?:know|worry|think|care|mind|stop))|(?:must not|mustn't|cannot|can't|should not|"
        r"shouldn't)(?! (?:know|tell|say|see))|(?:rather|better|would|prefer) not|rather you didn't|wouldn't|(?:go|fly|"
        r"goes) (?:a)?round(?: it)?|absolutely not|forbidden",
    not_blocked=r"(?:not|\w+n't|no|non|without|nothing|never|hardly) (?:\w+ ){0,2}(?:unsafe|toxic|poison\w*|danger\w*|"
        r"hazard\w*|acid|burning|flames?)|no (?:problem|worries|objections?|issues?|doubt|matter|risk|reason)",
    present=r"some(?:body|one)|(?:a|an|my|one|two|three|four|five|six|several|some|many|\d+) (?:\w+ )?(?:man|woman|men|"
        r"women|person|people|child|children|kids?|workers?|colleagues?|victims?|guards?|guys?)|(?:he|she|they)(?:'s|"
        r"'re| is| are)?(?: still)? (?:in|inside|trapped|stuck)|(?:not|isn't|isnt) empty|trapped|occupied|unaccounted|"
        r"(?:nobody|no one),? (?:but|except|besides|came|made|got|escaped|has (?:left|come))|(?:has not|hasn't|have "
        r"not|haven't) (?:\w+ )?(?:come|left|got)",
    unsure=r"(?:do not|don't|dont|wouldn't) know|dunno|no idea|no clue|not sure|unsure|(?:can't|cannot|couldn't|can "
        r"not) (?:\w+ )?(?:tell|say|see)|hard to (?:say|tell)|no way of knowing|who knows|beats me|not certain",
    orders={
        Order.HOLD: "stop|stop it|halt|hold|hold position|hold it|freeze|pause|hover|stay|stay there|stop there|stop "
            "now",
        Order.CONTINUE: "continue|carry on|resume|continue the mission|resume the mission",
        Order.RETURN: "return|come back|come home|return home|return to base|go home|fly back|fly home|rtl|come back "
            "now",
        Order.ABORT: "abort|abort mission|abort the mission|cancel|cancel the mission|end the mission|call it off",
        Order.LAND: "land|land now|land here|land there|land immediately|put it down|set it down|touch down",
    },
    back={
        ReadingKind.WAIT: "wait|wait a moment|wait a minute|wait a second|one moment|just a moment|hang on|hold on|"
            "stand by|standby|one second|just a second|just a sec|one minute|give me a minute|give me a moment|moment",
        ReadingKind.WHERE: "where|where is it|where is that|where's that|where exactly|where are you|which one|which",
        ReadingKind.SHOW: "show|show me|show it|show me that|show me a picture|picture|can i see it|let me see",
        ReadingKind.WHY: "why|why do you ask|why do you want to know|why do you need to know|what for",
        ReadingKind.REPEAT: "repeat|say again|say that again|pardon|come again|again|repeat the question|what",
    },
    articles="the|a|an|that|this", things="one|thing", states="it is|it's|i mean|that is|that's", negates="not|isn't",
    attributes={"big": "large", "bigger": "large", "little": "small", "smaller": "small", "gray": "grey"},
)  # fmt: skip

GERMAN = AnswerWords(
    yes="j|y|ja|jawohl|jap|ja genau|genau|richtig|stimmt|das stimmt|ja das stimmt|ja bitte|ja ganz sicher|ja sicher|"
        "auf jeden fall|selbstverständlich|natürlich|korrekt|bejahe",
    no="n|nein|nee|nö|negativ|nein danke",
    passable="sicher|es ist sicher|ja ist sicher|ja es ist sicher|er ist sicher|der rauch ist sicher|ungefährlich|es "
        "ist ungefährlich|er ist ungefährlich|harmlos|er ist harmlos|der rauch ist harmlos|flieg durch|flieg hindurch|"
        "ja flieg durch|du kannst durchfliegen|ja du kannst durchfliegen",
    absent="niemand|keiner|niemand drin|keiner drin|niemand ist drin|keiner ist drin|da ist niemand|da ist keiner|da "
        "ist niemand drin|es ist niemand drin|leer|er ist leer|der raum ist leer|nein niemand|nein leer",
    confirm="bestätigt|bestätige|ich bestätige|bestätigen",
    keys={"j": "yes"},
    seems_passable="sicher|ungefährlich|harmlos|durchfliegen|(?:flieg|fliege) (?:durch|hindurch)|in ordnung",
    seems_absent="niemand|keiner|leer|nein(?=[,.;!]|$)",
    courtesies="bitte|danke|drohne|äh|ähm|hm|also|na|okay|ok|gut|hallo|tschüss|alles klar|ende|so",
    fillers="es ist er das da der die ganz völlig absolut wirklich klar kannst du durch hindurch fliegen flieg drin im "
        "in",
    nay="nein|nee|nö|ne|negativ|niemand|keine?[rsnm]?|leer",
    aye="ja|jawohl|doch|jemand|genau|richtig|stimmt|leute|person ist",
    denial="nicht|nie|niemals|ohne|falsch|irrtum|quatsch|scherz|spaß|witz|sorry|gegenteil|kaum|vergiss|verboten|weder",
    danger=r"giftig\w*|toxisch\w*|gefahr|gefährlich\w*|riskant|risiko|brenn\w*|feuer|flammen?|heiß|säure|chlor|gas|tot|"
        r"tödlich|explo\w*|vorsicht\w*|achtung|pass auf|meide\w*|weg|außen|herum|maske",
    doubt=r"vielleicht|wahrscheinlich|vermutlich|möglich\w*|eventuell|glaube?|denke?|hoff\w+|scheint|wohl|könnte|"
        r"sollte|müsste|würde|dürfte|fast|ziemlich|eher|eigentlich|unklar|unsicher|zweifel\w*|normalerweise|jein|oder",
    condition="wenn|falls|sobald|sofern|solange|drauf an|außer|bis|nur|aber|während|dann|notfall|nachdem",
    limits=r"war|waren|wird|werden|bald|später|noch|morgen|gestern|heute|vorher|früher|minuten?|stunden?|vor|nach|"
        r"schon|mehr|immer|warte|moment|teil\w*|halb|hälfte|seite|rand|meiste\w*|andere\w*|oben|unten|über|mitte|etwas|"
        r"links|rechts|sagt\w*|gesagt|gehört|angeblich|laut|heißt|meint|soll|liste",
    asks=r"was|warum|wieso|wer|wo|wie|welche\w*|ob|(?:^(?:ist|sind|bin|kann|darf|soll|hast|bist|haben|wird)(?= .))",
    blocked=r"(?:nicht|nie|keineswegs|kein) (?:\w+ ){0,2}(?:sicher|harmlos|ungefährlich|ok|okay|in ordnung)|sicher "
        r"nicht|giftig\w*|toxisch\w*|gefährlich\w*|gefahr|lebensgefahr|brennt|flammen|chlor|säure|tödlich|explo\w*|"
        r"bloß nicht|lieber nicht|besser nicht|auf keinen fall|(?:flieg|geh|fahr)e? (?:\w+ ){0,2}nicht|nicht "
        r"(?:durch\w*|rein\w*|hinein\w*)|(?:außen|drum)? ?herum|meide\w*|bleib weg|fernhalten|verboten",
    not_blocked=r"(?:nicht|nie|kein\w*|ohne|weder) (?:\w+ ){0,2}(?:giftig\w*|toxisch\w*|gefährlich\w*|gefahr|flammen)|"
        r"kein problem|keine sorge",
    present=r"jemand\w*|(?:ein|eine|einen|mein|meine|zwei|drei|vier|fünf|mehrere|einige|\d+) (?:\w+ )?(?:mann|frau|"
        r"leute|person|personen|menschen?|kinder|kind|kollegen?|kollegin|opfer|männer|frauen)|(?:er|sie|es) ist "
        r"(?:noch )?(?:drin|drinnen)|nicht leer|eingeschlossen|eingesperrt|(?:niemand|keiner),? (?:außer|bis auf|kam|"
        r"ist (?:\w+)?(?:heraus|raus)\w*|hat)|noch (?:nicht draußen|drin)|fehlt noch",
    unsure="weiß (?:ich |es |das )*(?:leider |auch )?nicht|weiss (?:ich |es |das )*(?:leider )?nicht|keine ahnung|"
        "nicht sicher(?= *$)|schwer zu sagen|kann (?:ich )?(?:es |das )?nicht (?:sagen|sehen|erkennen)|überfragt|"
        "unklar|bin (?:mir )?nicht sicher",
    orders={
        Order.HOLD: "stopp|stop|halt|anhalten|halt an|bleib stehen|stehen bleiben|bleib da|warte dort|pause",
        Order.CONTINUE: "weiter|weitermachen|mach weiter|flieg weiter|fortsetzen|mission fortsetzen",
        Order.RETURN: "zurück|komm zurück|zurückkommen|kehr um|umkehren|komm heim|nach hause|flieg zurück",
        Order.ABORT: "abbrechen|abbruch|brich ab|mission abbrechen|sofort abbrechen|abbruch der mission|aufhören",
        Order.LAND: "landen|lande|lande jetzt|lande sofort|lande hier|lande dort|sofort landen|jetzt landen",
    },
    back={
        ReadingKind.WAIT: "warte|warte mal|warte kurz|warten|moment|moment mal|einen moment|sekunde|eine minute",
        ReadingKind.WHERE: "wo|wo ist das|wo genau|wo bist du|welche|welcher|welches|wo denn|wo meinst du",
        ReadingKind.SHOW: "zeig|zeig mir|zeig mal|zeigen|zeig es mir|zeig mir ein bild|bild|lass sehen",
        ReadingKind.WHY: "warum|wieso|weshalb|wozu|warum fragst du|wieso fragst du",
        ReadingKind.REPEAT: "wie bitte|noch mal|nochmal|noch einmal|wiederhole|wiederholen|was war die frage|was|wie",
    },
    articles="der|die|das|den|dem|eine?n?|diese[rs]?", things="ding|teil",
    states="es ist|ich meine|das ist|sie ist|er ist", negates="nicht",
    attributes={"weiss": "white"},
)  # fmt: skip

FRENCH = AnswerWords(
    yes="o|y|oui|oui oui|ouais|oui c'est ça|c'est ça|exact|exactement|c'est exact|tout à fait|oui bien sûr|bien sûr|"
        "affirmatif|absolument|oui certain|certainement|oui s'il vous plaît|oui s'il te plaît|correct",
    no="n|non|non non|négatif|non merci",
    passable="sans danger|c'est sans danger|oui c'est sans danger|oui sans danger|c'est sûr|oui c'est sûr|la fumée est "
        "sans danger|elle est sans danger|inoffensive|elle est inoffensive|tu peux passer|oui tu peux passer|tu peux "
        "traverser|vous pouvez passer|on peut traverser",
    absent="personne|il n'y a personne|non il n'y a personne|y a personne|personne dedans|personne n'est dedans|il n'y "
        "a personne dedans|non personne|vide|c'est vide|elle est vide|la pièce est vide",
    confirm="confirmé|je confirme|confirme|confirmer",
    keys={"o": "yes"},
    seems_passable="sans danger|inoffensi(?:f|ve)|c'est (?:sûr|bon)|(?:peux|peut|pouvez) (?:passer|traverser)",
    seems_absent="personne|vide|non(?=[,.;!]|$)",
    courtesies="merci|s'il te plaît|s'il vous plaît|drone|euh|bon|alors|eh bien|ok|d'accord|bonjour|salut|terminé",
    fillers="c'est il elle est la le les cette on tu vous peux peut pouvez passer traverser y a à dedans ici "
        "l'intérieur ça va vas-y vas bien totalement complètement vraiment tout fait n'y n'est",
    nay="non|négatif|personne|aucune?|vide|rien", aye="oui|ouais|si|quelqu'un|(?:une|la|cette) personne|gens|bien sûr",
    denial=r"pas|jamais|ne|n'(?!y a personne|est dedans)\w+|faux|erreur|désolée?|plaisante\w*|blague|rigole|contraire|"
        r"oublie|interdit\w*",
    danger=r"toxiques?|(?<!sans )dangers?|dangereu\w+|risqu\w+|périls?|brûl\w+|feu|flammes?|chaud|acide|chlore|gaz|tue|"
        r"mort\w*|explos\w+|attention|prudent\w*|évite\w*|contourne\w*|loin|masque|poison",
    doubt=r"peut[- ]être|probable\w*|possible\w*|crois|pense|suppose\w*|espère\w*|semble\w*|dirait|pourrait|devrait|"
        r"doute\w*|presque|assez|plutôt|principe|normalement|enfin|mouais|sais",
    condition=r"si|s'il (?!te|vous)|sauf|condition|tant que|dès|dépend\w*|pourvu|seulement|mais|à part|quand|cas|moins",
    limits="était|étaient|sera|bientôt|tard|encore|demain|hier|aujourd'hui|matin|soir|avant|après|minutes?|heures?|"
        "déjà|plus|attends?|attendez|instant|moment|partie|moitié|côté|bords?|plupart|autres?|haut|bas|dessus|milieu|"
        "un peu|deux|toutes?|gauche|droite|dit|dis|entendu|paraît|selon|d'après|apparemment|liste",
    asks="quoi|pourquoi|qui|où|comment|quels?|quelles?|lequel|laquelle|est[- ]ce|(?:^(?:peut-on|puis-je|dois-je|y "
        "a-t-il)(?= .))",
    blocked=r"pas (?:\w+ ){0,2}(?:sûre?|sans danger|inoffensi\w+|bon|prudent)|toxiques?|(?<!sans )danger|dangereu\w+|"
        r"chlore|acide|flammes|brûle|mortel\w*|explos\w+|surtout pas|(?:n'y va|ne passe|n'entre|ne va|ne traverse|"
        r"n'approche)\w* pas|contourne\w*|évite\w*|mieux vaut (?:éviter|pas)|que non|préférerais (?:pas|que non)|"
        r"jamais|pas question|reste\w* (?:loin|dehors)|interdit",
    not_blocked=r"pas (?:\w+ ){0,2}(?:toxiques?|dangereu\w+|de danger|mortel\w*)|aucun danger|pas de (?:problème|"
        r"souci)|rien de (?:toxique|dangereux)",
    present=r"quelqu'un|(?:un|une|la|mon|ma|deux|trois|quatre|cinq|plusieurs|des|\d+) (?:homme|femme|personnes?|"
        r"collègues?|enfants?|gens|blessée?s?|hommes|femmes|gardien)|(?:il|elle|ils|elles) (?:est|sont) (?:encore "
        r")?(?:dedans|à l'intérieur|coincée?s?)|pas vide|coincée?s?|enfermée?s?|occupée|personne,? (?:sauf|à part|"
        r"n'est sorti\w*|n'a quitté)|pas encore sorti\w*|il manque",
    unsure="(?:ne |n'en )?sais (?:pas|rien)|aucune idée|pas sûre?(?= *$)|difficile à dire|peux pas (?:dire|voir)",
    orders={
        Order.HOLD: "stop|halte|arrête|arrêtez|arrête-toi|ne bouge plus|ne bougez plus|reste là|restez là|pause",
        Order.CONTINUE: "continue|continuez|continue la mission|reprends|reprends la mission",
        Order.RETURN: "reviens|revenez|retour|rentre|rentrez|reviens ici|retour à la base|rentre à la base|demi-tour",
        Order.ABORT: "annule|annulez|annuler|abandonne|abandonnez|annule la mission|abandonne la mission",
        Order.LAND: "atterris|atterrissez|pose-toi|posez-vous|atterris maintenant|atterris ici|atterrir",
    },
    back={
        ReadingKind.WAIT: "attends|attendez|attends un instant|attends un moment|un instant|un moment|une seconde|une "
            "minute",
        ReadingKind.WHERE: "où|où ça|où exactement|c'est où|où es-tu|où est-ce|laquelle|lequel|où donc",
        ReadingKind.SHOW: "montre|montre-moi|montrez|montrez-moi|montre une photo|montre-moi une photo|photo|fais voir",
        ReadingKind.WHY: "pourquoi|pourquoi tu demandes|pourquoi cette question|pour quoi faire",
        ReadingKind.REPEAT: "répète|répétez|pardon|comment|quoi|encore|répète la question|plaît-il",
    },
    articles="le|la|les|une?|celle|celui|cette|ce", things="chose", states="c'est|il est|elle est|je veux dire",
    negates="pas",
    attributes={"gros": "large", "grosse": "large", "marron": "brown"},
)  # fmt: skip

SPANISH = AnswerWords(
    yes="s|y|sí|si|sí sí|sí claro|claro que sí|sí por favor|sí seguro|por supuesto|correcto|exacto|así es|es correcto|"
        "afirmativo|sí señor",
    no="n|no|no no|negativo|no gracias",
    passable="es seguro|sí es seguro|el humo es seguro|sin peligro|sí sin peligro|es inofensivo|sí es inofensivo|"
        "inofensivo|puedes pasar|sí puedes pasar|puede pasar|puedes atravesarlo|se puede atravesar|se puede pasar",
    absent="nadie|no hay nadie|no nadie|nadie dentro|no hay nadie dentro|no no hay nadie|nadie está dentro|no hay "
        "nadie ahí|no hay nadie ahí dentro|vacío|está vacío|está vacía|vacía|la sala está vacía",
    confirm="confirmo|confirmado|confirmar|confirma",
    keys={"s": "yes"},
    seems_passable="es seguro|seguro|sin peligro|inofensivo|(?:puedes?|puede) (?:pasar|atravesarlo|atravesar)",
    seems_absent="nadie|vací[oa]|no(?=[,.;!]|$)",
    courtesies="por favor|gracias|dron|eh|bueno|pues|vale|ok|de acuerdo|hola|adiós|señor|señora|oye|mira|cambio",
    fillers="es está el la lo se puede puedes pasar atravesar atravesarlo hay dentro ahí allí aquí en muy totalmente "
        "completamente realmente bien claro que",
    nay=r"no|negativo|nadie|ningún|ningun\w*|vací[oa]|nada", aye="sí|alguien|claro|correcto|gente|una persona",
    denial="nunca|jamás|tampoco|ni|sin(?! peligro)|falso|error|mentira|broma|perdón|contrario|olvida|prohibido|no "
        "est[áa]|no del todo|no es|no son|apenas|que no",
    danger=r"tóxic\w+|(?<!sin )peligro\w*|riesgo\w*|quema\w*|fuego|llamas?|caliente|ácido|cloro|gas|mata|muert\w+|"
        r"mortal|explo\w+|cuidado|ojo|evita\w*|rodea\w*|lejos|mascarilla|veneno\w*",
    doubt=r"quizás?|tal vez|probable\w*|posible\w*|creo|pienso|supongo|espero|parece\w*|podría|debería|duda\w*|casi|"
        r"bastante|más o menos|principio|normalmente|sé|puede ser|algo",
    condition=r"si(?=[ ,]+\w)|siempre que|salvo|excepto|menos|depende\w*|cuando|s[oó]lo|pero|hasta|mientras|caso",
    limits=r"era|estaba|fue|será|pronto|luego|todavía|aún|mañana|ayer|hoy|antes|después|minutos?|horas?|ya|tarde|"
        r"espera|momento|parte|mitad|lado|bordes?|mayoría|otr[oa]s?|arriba|abajo|encima|un poco|algunos?|ambos|todos|"
        r"izquierd\w+|derech\w+|dicen?|dijo|dijeron|oí|según|al parecer|lista",
    asks=r"qué|por qué|quién|dónde|cómo|cuál\w*|cuánto\w*|(?:^(?:puedo|debo|eres|hay alguien|tengo que)(?= .))",
    blocked=r"no (?:\w+ ){0,2}(?:seguro|inofensivo|bueno)|seguro que no|tóxic\w+|(?<!sin )peligro\w*|cloro|ácido|"
        r"llamas|quema|mortal|explo\w+|veneno\w*|ni se te ocurra|mejor no|prefiero que no|no (?:pases|entres|vayas|"
        r"vueles|atravieses|te acerques)|rode[aá]\w*|evita\w*|nunca|jamás|prohibido|aléjate",
    not_blocked=r"(?:no|nada|sin) (?:\w+ ){0,2}(?:tóxic\w+|peligros\w+|mortal|veneno\w*)|ningún peligro|no hay "
        r"(?:problema|peligro)|no te preocupes",
    present=r"(?<!no hay )alguien|(?:un|una|mi|dos|tres|cuatro|cinco|varias|varios|\d+) (?:hombre|mujer|personas?|"
        r"compañer\w+|niñ\w+|herid\w+|hombres|mujeres|guardia)|(?<!nadie )(?:sigue|está|siguen|están) (?:todavía "
        r")?(?:dentro|atrapad\w+)|no está vací[oa]|atrapad\w+|ocupad\w+|gente|nadie,? (?:salvo|excepto|menos|ha salido|"
        r"salió)|no ha salido|falta un\w*",
    unsure=r"no (?:lo )?sé|ni idea|no estoy segur[oa]|difícil de decir|no sabría|no puedo (?:decir|ver)\w*|quién sabe",
    orders={
        Order.HOLD: "alto|para|pare|detente|deténgase|stop|quieto|quédate ahí|quédate quieto|pausa|no te muevas|párate",
        Order.CONTINUE: "continúa|continúe|sigue|siga|continúa la misión|reanuda",
        Order.RETURN: "vuelve|vuelva|regresa|regrese|vuelve aquí|vuelve a casa|regresa a la base|volver|regresar",
        Order.ABORT: "aborta|aborte|abortar|cancela|cancele|cancelar|cancela la misión|aborta la misión",
        Order.LAND: "aterriza|aterrice|aterriza ya|aterriza ahora|aterriza aquí|aterrizar",
    },
    back={
        ReadingKind.WAIT: "espera|espere|espera un momento|un momento|un segundo|un minuto|dame un minuto|momento",
        ReadingKind.WHERE: "dónde|donde|dónde está|dónde está eso|dónde exactamente|dónde estás|cuál|en dónde",
        ReadingKind.SHOW: "muestra|muéstrame|muéstramelo|enséñame|enséñame una foto|muéstrame una foto|foto|a ver",
        ReadingKind.WHY: "por qué|por que|por qué preguntas|para qué|por qué lo preguntas",
        ReadingKind.REPEAT: "repite|repita|repítelo|otra vez|cómo|cómo dice|perdón|qué|repite la pregunta",
    },
    articles="el|la|los|las|una?|es[ea]|est[ea]", things="cosa", states="es|quiero decir|me refiero a", negates="no",
    attributes={"chica": "small", "chico": "small"},
)  # fmt: skip

ANSWER_WORDS: Mapping[str, AnswerWords] = {"en": ENGLISH, "de": GERMAN, "fr": FRENCH, "es": SPANISH}
"""By two-letter code."""
