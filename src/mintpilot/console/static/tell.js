// What the person tells of their own accord: drawn regions, regions and rooms that they know, "this one".

import { $, make, renew } from "./dom.js";
import { say } from "./words.js";

const FACTS = { region: ["blocked", "passable"], room: ["searched"], thing: ["this-one"] };
const ASKED = { "read-back": "toldAsk", "undo-read-back": "undoAsk" }; // what waits to be confirmed
const ENDED = ["undone", "lapsed", "refused"];

export class Tell {
  #link; #map; #may = false; #told = []; #picked = null; #pane = null; #asked = "";

  constructor(link, map) {
    this.#link = link;
    this.#map = map;
    $("draw").onclick = () => (map.drawing ? this.#stop() : this.#start());
  }

  setMay(may) { this.#may = may; if (!may && this.#map.drawing) this.#stop(); this.draw(); }
  setMap(pane) { this.#pane = pane; this.draw(); }

  set(told) {
    this.#told = told;
    this.#map.setTold(told.filter((t) => t.corners.length && ["counts", "undo-read-back"].includes(t.standing)).map((t) => t.corners));
    const back = told.findLast((t) => ASKED[t.standing]), asked = back ? `${back.id} ${back.standing}` : "";
    if (back && asked !== this.#asked) $("hear").textContent = say(ASKED[back.standing], this.#words(back));
    this.#asked = asked;
    this.draw();
  }

  pick(found) {
    this.#picked = found;
    this.draw();
    if (found) $("picked").scrollIntoView({ block: "nearest" });
  }

  #start() {
    this.#map.startDrawing((corners) => {
      this.#stop();
      if (corners) this.#link.send({ kind: "keep-out", corners });
    });
    this.draw();
    $("map").focus();
  }

  #stop() { this.#map.stopDrawing(); this.draw(); }

  #words(t) { return say(`told-${t.fact}`, t.words); }

  #button(word, send, name = "") {
    let sent = false; // once: what is pressed twice would answer what is asked back
    const press = () => { if (!sent) this.#link.send(send); sent = true; };
    return make("button", { type: "button", disabled: !this.#may, onclick: press, "aria-label": name ? `${say(word)}: ${name}` : null, text: say(word) });
  }

  #facts(kind, id, words) {
    return FACTS[kind].map((fact) => this.#button(`fact-${fact}`, { kind: "tell", fact, subject: id }, words));
  }

  #row(kind, one) { return make("li", {}, make("span", { text: one.words }), make("span", { class: "row small" }, ...this.#facts(kind, one.id, one.words))); }

  draw() {
    $("draw").textContent = say(this.#map.drawing ? "stopDrawing" : "draw");
    $("draw").setAttribute("aria-pressed", String(this.#map.drawing));
    $("draw").disabled = !this.#may;
    $("how").textContent = this.#map.drawing ? say("howToDraw") : "";
    const back = this.#told.filter((t) => ASKED[t.standing]), here = $("tell").contains(document.activeElement);
    renew($("back"), ...back.map((t) => make("div", { class: "understood", tabindex: "-1" }, make("p", { text: say(ASKED[t.standing], this.#words(t)) }),
      make("div", { class: "row small" }, this.#button("right", { kind: "confirm", told: t.id }), this.#button("no", { kind: "undo", told: t.id })))));
    const found = this.#picked;
    renew($("picked"), ...(found ? [make("strong", { text: found.words }), ...this.#facts(found.kind, found.id, found.words)] : []));
    const regions = (this.#pane?.regions ?? []).filter((r) => r.passable !== "no" && !r.id.startsWith("told-"));
    const rooms = (this.#pane?.things ?? []).filter((t) => t.label === "room" && t.state === "open");
    $("known").hidden = !regions.length && !rooms.length;
    renew($("knowns"), ...regions.map((r) => this.#row("region", r)), ...rooms.map((r) => this.#row("room", r)));
    renew($("told"), ...this.#told.filter((t) => t.standing !== "read-back").slice(-12).reverse().map((t) => make("li", { class: ENDED.includes(t.standing) ? "over" : null },
      make("span", {}, make("span", { class: "what", text: this.#words(t) }), make("small", { text: `${t.who} · ${Math.round(t.time_s)} s${ENDED.includes(t.standing) ? ` · ${say(`standing-${t.standing}`, t.why)}` : ""}` })),
      ...(t.standing === "counts" ? [this.#button("undo", { kind: "undo", told: t.id }, this.#words(t))] : []))));
    if (here && document.activeElement === document.body) ($("back").querySelector(".understood") ?? $("draw")).focus(); // what was pressed is gone
  }
}
