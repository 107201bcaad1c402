// The page's own words. What the drone says comes in the mission's language.

const WORDS = {
  en: {
    talk: "Hold to talk", talking: "Listening …", handsFree: "Hands-free", playVoice: "Play the drone's voice", micOff: "Microphone off", micAsking: "Your browser asks whether this page may use the microphone.", micHold: "The microphone is ready. Hold the button while you speak, or choose hands-free.", micOpen: "The microphone is on. Say yes or no; an order: stop.", micRefused: "The microphone was refused. Allow it for this page in the browser's settings, or answer by key.", micMissing: "This device has no microphone. Answer by key.", micBusy: "The microphone cannot be opened; another program may use it. Answer by key.", micInsecure: "Browsers give the microphone only to pages of this machine or with TLS. Answer by key.", micGone: "The microphone is gone. Answer by key.", micOther: "Another browser answers: the microphone is off here.", micHeard: "Heard: {}", micSaid: "The drone says: {}", micLevel: "Level of the microphone",
    briefing: "As it was understood", noMap: "No map yet", skip: "To the question", language: "Language", question: "Question", say: "In your own words", send: "Send",
    map: "Map", camera: "What the drone sees", mission: "Mission", log: "What happened", tree: "How it thinks", gaps: "What it does not know",
    hold: "Hold", continue: "Continue", return: "Return", land: "Land", abort: "Abort", orders: "Orders",
    answering: "You answer", watching: "You watch", take: "Answer from here", takeOver: "Take over answering", leave: "Hand over",
    calm: "Nothing is asked. You can give an order at any time.", asks: "The drone asks", asksAgain: "The drone asks again, in other words",
    yes: "Yes", no: "No", unsure: "I don't know", unsureMeans: "it asks something else, or takes the careful way",
    silence: "No answer", silenceMeans: "it takes the way that is safe whatever holds", seconds: "{} s", likely: "most likely", undone: "left undone: {}",
    understood: "I understood: {}", isRight: "Is that right?", right: "Yes, that is right", wrong: "No, ask me again",
    again: "I did not understand. Please use a button, or say yes, no, or what is the case.", more: "More time", repeat: "Repeat", aloud: "Read aloud", mute: "Mute",
    why: "Why do you ask?", where: "Where?", left: "{} s left", over: "Time is over", thisOne: "This one", reasons: "{0} bit about the plan, {1} s expected to be saved; best of {2} possible questions; {3} things are not known.",
    lost: "LINK LOST", lostOpen: "The drone waits for an answer until its time is over, then takes the careful way. What you press is kept and sent when the link is back.",
    lostCalm: "The drone goes on with its checked plan. What you press is kept and sent when the link is back.", refused: "This address does not open the console. Use the whole address that the program printed.",
    free: "free", wall: "occupied", unknown: "not seen", open: "not known", passable: "may be flown through", blocked: "must not be entered", planned: "planned", flown: "flown", drone: "drone", room: "closed room", reply: "way after that answer",
    battery: "Battery", batteryHas: "{} s left", batteryNeeds: "the plan needs {} s", batteryFree: "without limit", height: "Height", speed: "Speed", clock: "Mission clock",
    now: "now", done: "done", "left-out": "left out", todo: "to do", closed: "Closed: {}", ended: "The mission is over", sent: "Sent.", notTaken: "Not taken: another browser answers.", nothingAsked: "Nothing is asked now. Orders: hold, continue, return, land, abort.",
    asked: "asked", notAsked: "not asked", best: "best", flownPlan: "this is flown", ruledOut: "ruled out by answer {}", omitted: "{} more", nodes: "{} nodes", apart: "{} m apart", noTree: "This way of asking builds no tree.", answerNo: "Answer {}",
    mapLabel: "Map from above. The drone is at {0} east, {1} north, {2} high.", evidence: "What the question is about", noQuestion: "no question",
    known: "Tell what you know", draw: "Draw a region to keep out of", stopDrawing: "Stop drawing", howToDraw: "Draw around the region with mouse or finger. With keys: arrows move, Enter sets a corner, Enter once more closes, Escape ends.", "fact-blocked": "Keep out", "fact-passable": "Safe to fly through", "fact-searched": "Was searched", "fact-this-one": "This one", "told-keep-out": "Keep out of the drawn region", "told-blocked": "Keep out: {}", "told-passable": "Safe to fly through: {}", "told-searched": "Was searched: {}", "told-this-one": "This one is meant: {}", "standing-undone": "taken back", "standing-lapsed": "no longer counts", "standing-refused": "not taken over: {}", toldAsk: "This takes caution away. I understood: {}. Is that right?", undo: "Undo",
    replay: "Replay", moment: "Moment of the mission", tempo: "Speed of the replay", before: "Event before", after: "Next event", play: "Play", pause: "Pause", calmReplay: "At this moment nothing is asked.",
    waited: "It waited {0} s for answers and flew on meanwhile: {1} s of that were not lost.",
    "log-question": "asks", "log-answer": "answer", "log-order": "order", "log-says": "says", "log-note": "note", "log-plan": "plan", "log-begun": "begins", "log-ended": "end",
  },
  de: {
    talk: "Zum Sprechen halten", talking: "Ich höre …", handsFree: "Freisprechen", playVoice: "Stimme der Drohne abspielen", micOff: "Mikrofon aus", micAsking: "Ihr Browser fragt, ob diese Seite das Mikrofon benutzen darf.", micHold: "Das Mikrofon ist bereit. Halten Sie die Taste, während Sie sprechen, oder wählen Sie Freisprechen. Gehört wird nur Englisch.", micOpen: "Das Mikrofon ist an. Gehört wird nur Englisch: yes, no, stop.", micRefused: "Das Mikrofon wurde verweigert. Erlauben Sie es dieser Seite in den Einstellungen des Browsers, oder antworten Sie mit Tasten.", micMissing: "Dieses Gerät hat kein Mikrofon. Antworten Sie mit Tasten.", micBusy: "Das Mikrofon lässt sich nicht öffnen; vielleicht benutzt es ein anderes Programm. Antworten Sie mit Tasten.", micInsecure: "Browser geben das Mikrofon nur Seiten dieses Rechners oder mit TLS. Antworten Sie mit Tasten.", micGone: "Das Mikrofon ist weg. Antworten Sie mit Tasten.", micOther: "Ein anderer Browser antwortet: das Mikrofon ist hier aus.", micHeard: "Gehört: {}", micSaid: "Die Drohne sagt: {}", micLevel: "Pegel des Mikrofons",
    briefing: "So wurde es verstanden", noMap: "Noch keine Karte", skip: "Zur Frage", language: "Sprache", question: "Frage", say: "In eigenen Worten", send: "Senden",
    map: "Karte", camera: "Was die Drohne sieht", mission: "Mission", log: "Was geschah", tree: "Wie sie überlegt", gaps: "Was sie nicht weiß",
    hold: "Halt", continue: "Weiter", return: "Zurück", land: "Landen", abort: "Abbrechen", orders: "Befehle",
    answering: "Sie antworten", watching: "Sie sehen zu", take: "Von hier antworten", takeOver: "Das Antworten übernehmen", leave: "Übergeben",
    calm: "Gerade wird nichts gefragt. Befehle gehen jederzeit.", asks: "Die Drohne fragt", asksAgain: "Die Drohne fragt noch einmal, mit anderen Worten",
    yes: "Ja", no: "Nein", unsure: "Weiß nicht", unsureMeans: "sie fragt etwas anderes oder nimmt den vorsichtigen Weg",
    silence: "Keine Antwort", silenceMeans: "sie nimmt den Weg, der in jedem Fall sicher ist", seconds: "{} s", likely: "am ehesten", undone: "bleibt ungetan: {}",
    understood: "Ich habe verstanden: {}", isRight: "Stimmt das?", right: "Ja, das stimmt", wrong: "Nein, noch einmal fragen",
    again: "Das habe ich nicht verstanden. Bitte eine Taste, oder ja, nein, oder was der Fall ist.", more: "Mehr Zeit", repeat: "Wiederholen", aloud: "Vorlesen", mute: "Stumm",
    why: "Warum fragst du?", where: "Wo?", left: "noch {} s", over: "Die Zeit ist um", thisOne: "Dieses", reasons: "{0} bit über den Plan, {1} s Ersparnis zu erwarten; beste von {2} möglichen Fragen; {3} Dinge sind nicht bekannt.",
    lost: "VERBINDUNG VERLOREN", lostOpen: "Die Drohne wartet auf eine Antwort, bis die Zeit um ist, und nimmt dann den vorsichtigen Weg. Was Sie drücken, wird aufgehoben und später gesendet.",
    lostCalm: "Die Drohne fliegt ihren geprüften Plan weiter. Was Sie drücken, wird aufgehoben und später gesendet.", refused: "Diese Adresse öffnet die Konsole nicht. Bitte die ganze Adresse benutzen, die das Programm genannt hat.",
    free: "frei", wall: "belegt", unknown: "nicht gesehen", open: "nicht bekannt", passable: "darf durchflogen werden", blocked: "darf nicht betreten werden", planned: "geplant", flown: "geflogen", drone: "Drohne", room: "geschlossener Raum", reply: "Weg nach dieser Antwort",
    battery: "Akku", batteryHas: "noch {} s", batteryNeeds: "der Plan braucht {} s", batteryFree: "ohne Grenze", height: "Höhe", speed: "Tempo", clock: "Missionszeit",
    now: "jetzt", done: "getan", "left-out": "ausgelassen", todo: "offen", closed: "Geschlossen: {}", ended: "Die Mission ist zu Ende", sent: "Gesendet.", notTaken: "Nicht angenommen: ein anderer Browser antwortet.", nothingAsked: "Gerade wird nichts gefragt. Befehle: halt, weiter, zurück, landen, abbrechen.",
    asked: "gefragt", notAsked: "nicht gefragt", best: "bester", flownPlan: "wird geflogen", ruledOut: "ausgeschlossen durch Antwort {}", omitted: "{} weitere", nodes: "{} Knoten", apart: "{} m auseinander", noTree: "Diese Art zu fragen baut keinen Baum.", answerNo: "Antwort {}",
    mapLabel: "Karte von oben. Die Drohne ist bei {0} Ost, {1} Nord, {2} hoch.", evidence: "Worum es geht", noQuestion: "keine Frage",
    known: "Was Sie wissen", draw: "Sperrgebiet zeichnen", stopDrawing: "Zeichnen beenden", howToDraw: "Das Gebiet mit Maus oder Finger umfahren. Mit Tasten: Pfeile bewegen, Enter setzt eine Ecke, noch einmal Enter schließt, Escape beendet.", "fact-blocked": "Fernbleiben", "fact-passable": "Darf durchflogen werden", "fact-searched": "Ist durchsucht", "fact-this-one": "Dieses", "told-keep-out": "Dem gezeichneten Gebiet fernbleiben", "told-blocked": "Fernbleiben: {}", "told-passable": "Darf durchflogen werden: {}", "told-searched": "Ist durchsucht: {}", "told-this-one": "Dieses ist gemeint: {}", "standing-undone": "zurückgenommen", "standing-lapsed": "gilt nicht mehr", "standing-refused": "nicht übernommen: {}", toldAsk: "Das nimmt Vorsicht weg. Ich habe verstanden: {}. Stimmt das?", undo: "Zurücknehmen",
    replay: "Wiedergabe", moment: "Zeitpunkt der Mission", tempo: "Tempo der Wiedergabe", before: "Ereignis davor", after: "Nächstes Ereignis", play: "Abspielen", pause: "Pause", calmReplay: "In diesem Augenblick wird nichts gefragt.",
    waited: "Sie hat {0} s auf Antworten gewartet und ist dabei weitergeflogen: {1} s davon waren nicht verloren.",
    "log-question": "fragt", "log-answer": "Antwort", "log-order": "Befehl", "log-says": "sagt", "log-note": "Hinweis", "log-plan": "Plan", "log-begun": "Beginn", "log-ended": "Ende",
  },
  fr: {
    talk: "Maintenir pour parler", talking: "J'écoute …", handsFree: "Mains libres", playVoice: "Faire entendre la voix du drone", micOff: "Couper le micro", micAsking: "Votre navigateur demande si cette page peut utiliser le micro.", micHold: "Le micro est prêt. Maintenez le bouton pendant que vous parlez, ou choisissez mains libres. Seul l'anglais est entendu.", micOpen: "Le micro est ouvert. Seul l'anglais est entendu : yes, no, stop.", micRefused: "Le micro a été refusé. Autorisez-le pour cette page dans les réglages du navigateur, ou répondez par touche.", micMissing: "Cet appareil n'a pas de micro. Répondez par touche.", micBusy: "Le micro ne s'ouvre pas ; un autre programme l'utilise peut-être. Répondez par touche.", micInsecure: "Les navigateurs ne donnent le micro qu'aux pages de cette machine ou avec TLS. Répondez par touche.", micGone: "Le micro n'est plus là. Répondez par touche.", micOther: "Un autre navigateur répond : le micro est coupé ici.", micHeard: "Entendu : {}", micSaid: "Le drone dit : {}", micLevel: "Niveau du micro",
    briefing: "Ce qui a été compris", noMap: "Pas encore de carte", skip: "Vers la question", language: "Langue", question: "Question", say: "Avec vos mots", send: "Envoyer",
    map: "Carte", camera: "Ce que voit le drone", mission: "Mission", log: "Ce qui s'est passé", tree: "Comment il raisonne", gaps: "Ce qu'il ignore",
    hold: "Stop", continue: "Continuer", return: "Revenir", land: "Atterrir", abort: "Annuler", orders: "Ordres",
    answering: "Vous répondez", watching: "Vous regardez", take: "Répondre d'ici", takeOver: "Reprendre les réponses", leave: "Passer la main",
    calm: "Rien n'est demandé. Vous pouvez donner un ordre à tout moment.", asks: "Le drone demande", asksAgain: "Le drone demande encore, en d'autres mots",
    yes: "Oui", no: "Non", unsure: "Je ne sais pas", unsureMeans: "il demande autre chose ou prend le chemin prudent",
    silence: "Sans réponse", silenceMeans: "il prend le chemin sûr dans tous les cas", seconds: "{} s", likely: "le plus probable", undone: "reste à faire : {}",
    understood: "J'ai compris : {}", isRight: "C'est juste ?", right: "Oui, c'est juste", wrong: "Non, redemandez-moi",
    again: "Je n'ai pas compris. Utilisez un bouton, ou dites oui, non, ou ce qu'il en est.", more: "Plus de temps", repeat: "Répéter", aloud: "Lire à voix haute", mute: "Muet",
    why: "Pourquoi cette question ?", where: "Où ?", left: "encore {} s", over: "Le temps est écoulé", thisOne: "Celui-ci", reasons: "{0} bit sur le plan, {1} s à gagner en moyenne ; la meilleure de {2} questions possibles ; {3} choses sont inconnues.",
    lost: "LIAISON PERDUE", lostOpen: "Le drone attend une réponse jusqu'à la fin du délai, puis prend le chemin prudent. Ce que vous pressez est gardé et envoyé au retour de la liaison.",
    lostCalm: "Le drone poursuit son plan vérifié. Ce que vous pressez est gardé et envoyé au retour de la liaison.", refused: "Cette adresse n'ouvre pas la console. Utilisez l'adresse entière que le programme a affichée.",
    free: "libre", wall: "occupé", unknown: "non vu", open: "inconnu", passable: "peut être traversé", blocked: "interdit", planned: "prévu", flown: "parcouru", drone: "drone", room: "pièce fermée", reply: "chemin après cette réponse",
    battery: "Batterie", batteryHas: "encore {} s", batteryNeeds: "le plan demande {} s", batteryFree: "sans limite", height: "Hauteur", speed: "Vitesse", clock: "Temps de mission",
    now: "en cours", done: "fait", "left-out": "omis", todo: "à faire", closed: "Close : {}", ended: "La mission est terminée", sent: "Envoyé.", notTaken: "Refusé : un autre navigateur répond.", nothingAsked: "Rien n'est demandé. Ordres : stop, continue, reviens, atterris, annule.",
    asked: "demandé", notAsked: "non demandé", best: "meilleur", flownPlan: "plan suivi", ruledOut: "exclu par la réponse {}", omitted: "{} de plus", nodes: "{} nœuds", apart: "écart de {} m", noTree: "Cette façon de demander ne construit pas d'arbre.", answerNo: "Réponse {}",
    mapLabel: "Carte vue d'en haut. Le drone est à {0} est, {1} nord, hauteur {2}.", evidence: "L'objet de la question", noQuestion: "pas de question",
    known: "Ce que vous savez", draw: "Dessiner une zone interdite", stopDrawing: "Arrêter le dessin", howToDraw: "Entourez la zone à la souris ou au doigt. Au clavier : les flèches déplacent, Entrée pose un coin, Entrée encore ferme, Échap arrête.", "fact-blocked": "Ne pas entrer", "fact-passable": "Peut être traversé", "fact-searched": "A été fouillée", "fact-this-one": "Celui-ci", "told-keep-out": "Ne pas entrer dans la zone dessinée", "told-blocked": "Ne pas entrer : {}", "told-passable": "Peut être traversé : {}", "told-searched": "A été fouillée : {}", "told-this-one": "C'est celui-ci : {}", "standing-undone": "retiré", "standing-lapsed": "ne compte plus", "standing-refused": "pas retenu : {}", toldAsk: "Cela enlève de la prudence. J'ai compris : {}. C'est juste ?", undo: "Retirer",
    replay: "Relecture", moment: "Instant de la mission", tempo: "Vitesse de relecture", before: "Événement précédent", after: "Événement suivant", play: "Lire", pause: "Pause", calmReplay: "À cet instant, rien n'est demandé.",
    waited: "Il a attendu les réponses {0} s en continuant de voler : {1} s n'ont pas été perdues.",
    "log-question": "demande", "log-answer": "réponse", "log-order": "ordre", "log-says": "dit", "log-note": "note", "log-plan": "plan", "log-begun": "début", "log-ended": "fin",
  },
  es: {
    talk: "Mantener para hablar", talking: "Escucho …", handsFree: "Manos libres", playVoice: "Reproducir la voz del dron", micOff: "Apagar el micrófono", micAsking: "Su navegador pregunta si esta página puede usar el micrófono.", micHold: "El micrófono está listo. Mantenga el botón mientras habla, o elija manos libres. Solo se entiende inglés.", micOpen: "El micrófono está abierto. Solo se entiende inglés: yes, no, stop.", micRefused: "El micrófono fue rechazado. Permítalo para esta página en los ajustes del navegador, o responda con teclas.", micMissing: "Este dispositivo no tiene micrófono. Responda con teclas.", micBusy: "El micrófono no se abre; quizá lo usa otro programa. Responda con teclas.", micInsecure: "Los navegadores dan el micrófono solo a páginas de esta máquina o con TLS. Responda con teclas.", micGone: "El micrófono ya no está. Responda con teclas.", micOther: "Otro navegador responde: el micrófono está apagado aquí.", micHeard: "Entendido: {}", micSaid: "El dron dice: {}", micLevel: "Nivel del micrófono",
    briefing: "Lo que se ha entendido", noMap: "Aún no hay mapa", skip: "A la pregunta", language: "Idioma", question: "Pregunta", say: "Con sus palabras", send: "Enviar",
    map: "Mapa", camera: "Lo que ve el dron", mission: "Misión", log: "Qué ha pasado", tree: "Cómo razona", gaps: "Lo que no sabe",
    hold: "Alto", continue: "Seguir", return: "Volver", land: "Aterrizar", abort: "Cancelar", orders: "Órdenes",
    answering: "Usted responde", watching: "Usted observa", take: "Responder desde aquí", takeOver: "Tomar las respuestas", leave: "Ceder el turno",
    calm: "No se pregunta nada. Puede dar una orden en cualquier momento.", asks: "El dron pregunta", asksAgain: "El dron pregunta otra vez, con otras palabras",
    yes: "Sí", no: "No", unsure: "No sé", unsureMeans: "pregunta otra cosa o toma el camino prudente",
    silence: "Sin respuesta", silenceMeans: "toma el camino que es seguro en cualquier caso", seconds: "{} s", likely: "lo más probable", undone: "queda sin hacer: {}",
    understood: "He entendido: {}", isRight: "¿Es correcto?", right: "Sí, es correcto", wrong: "No, pregunte otra vez",
    again: "No he entendido. Use un botón, o diga sí, no, o lo que ocurre.", more: "Más tiempo", repeat: "Repetir", aloud: "Leer en voz alta", mute: "Silencio",
    why: "¿Por qué lo pregunta?", where: "¿Dónde?", left: "quedan {} s", over: "Se acabó el tiempo", thisOne: "Este", reasons: "{0} bit sobre el plan, {1} s de ahorro esperado; la mejor de {2} preguntas posibles; {3} cosas no se conocen.",
    lost: "ENLACE PERDIDO", lostOpen: "El dron espera una respuesta hasta que acabe el tiempo y luego toma el camino prudente. Lo que pulse se guarda y se envía cuando vuelva el enlace.",
    lostCalm: "El dron sigue su plan comprobado. Lo que pulse se guarda y se envía cuando vuelva el enlace.", refused: "Esta dirección no abre la consola. Use la dirección completa que mostró el programa.",
    free: "libre", wall: "ocupado", unknown: "no visto", open: "no se sabe", passable: "se puede atravesar", blocked: "no se debe entrar", planned: "previsto", flown: "volado", drone: "dron", room: "sala cerrada", reply: "camino tras esa respuesta",
    battery: "Batería", batteryHas: "quedan {} s", batteryNeeds: "el plan necesita {} s", batteryFree: "sin límite", height: "Altura", speed: "Velocidad", clock: "Tiempo de misión",
    now: "ahora", done: "hecho", "left-out": "omitido", todo: "pendiente", closed: "Cerrada: {}", ended: "La misión ha terminado", sent: "Enviado.", notTaken: "No aceptado: responde otro navegador.", nothingAsked: "No se pregunta nada ahora. Órdenes: alto, sigue, vuelve, aterriza, cancela.",
    asked: "preguntado", notAsked: "no preguntado", best: "mejor", flownPlan: "se vuela", ruledOut: "descartado por la respuesta {}", omitted: "{} más", nodes: "{} nodos", apart: "{} m de diferencia", noTree: "Esta forma de preguntar no construye árbol.", answerNo: "Respuesta {}",
    mapLabel: "Mapa desde arriba. El dron está a {0} este, {1} norte, {2} de altura.", evidence: "De qué se trata", noQuestion: "sin pregunta",
    known: "Lo que usted sabe", draw: "Dibujar una zona prohibida", stopDrawing: "Terminar el dibujo", howToDraw: "Rodee la zona con el ratón o el dedo. Con teclas: las flechas mueven, Intro pone una esquina, Intro otra vez cierra, Escape termina.", "fact-blocked": "No entrar", "fact-passable": "Se puede atravesar", "fact-searched": "Ya registrada", "fact-this-one": "Este", "told-keep-out": "No entrar en la zona dibujada", "told-blocked": "No entrar: {}", "told-passable": "Se puede atravesar: {}", "told-searched": "Ya registrada: {}", "told-this-one": "Es este: {}", "standing-undone": "retirado", "standing-lapsed": "ya no cuenta", "standing-refused": "no aceptado: {}", toldAsk: "Esto quita precaución. He entendido: {}. ¿Es correcto?", undo: "Retirar",
    replay: "Repetición", moment: "Momento de la misión", tempo: "Velocidad de la repetición", before: "Suceso anterior", after: "Suceso siguiente", play: "Reproducir", pause: "Pausa", calmReplay: "En este momento no se pregunta nada.",
    waited: "Esperó respuestas {0} s y siguió volando: {1} s no se perdieron.",
    "log-question": "pregunta", "log-answer": "respuesta", "log-order": "orden", "log-says": "dice", "log-note": "nota", "log-plan": "plan", "log-begun": "inicio", "log-ended": "fin",
  },
};

let lang = "en";

export const language = () => lang;

export function speak(name) {
  lang = WORDS[name] ? name : "en";
  document.documentElement.lang = lang;
  for (const element of document.querySelectorAll("[data-word]")) element.textContent = say(element.dataset.word);
}

export function say(key, ...values) {
  const text = WORDS[lang][key] ?? WORDS.en[key] ?? key;
  return text.replace("{}", values[0] ?? "").replace(/\{(\d)\}/g, (_, i) => values[i] ?? "");
}
