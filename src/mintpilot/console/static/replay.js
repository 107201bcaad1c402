// A recorded mission: the scrubber, and going from one event to the next.

import { $ } from "./dom.js";
import { say } from "./words.js";

const SEND_MS = 220; // while the slider is dragged, no more often than this

export class Replay {
  #link; #pane = null; #sent = 0;

  constructor(link) {
    this.#link = link;
    $("moment").addEventListener("input", () => { if (performance.now() - this.#sent > SEND_MS) this.#go(Number($("moment").value)); });
    $("moment").addEventListener("change", () => this.#go(Number($("moment").value)));
    $("play").onclick = () => this.#play(this.#pane.speed ? 0 : Number($("speed").value));
    $("speed").addEventListener("change", () => { if (this.#pane.speed) this.#play(Number($("speed").value)); });
    $("back-to").onclick = () => this.#to(this.#pane.passed - (this.#pane.exact ? 2 : 1));
    $("on-to").onclick = () => this.#to(this.#pane.passed);
  }

  get shown() { return this.#pane !== null; }

  #go(time_s) { this.#sent = performance.now(); this.#link.send({ kind: "seek", time_s }); }
  #to(moment) { moment < 0 ? this.#go(0) : this.#link.send({ kind: "seek", moment }); }
  #play(speed) { this.#link.send({ kind: "play", speed }); }

  set(pane) {
    this.#pane = pane;
    $("moment").max = pane.to_s;
    if (document.activeElement !== $("moment") || performance.now() - this.#sent > 800) $("moment").value = pane.time_s;
    this.draw();
  }

  draw() {
    const pane = this.#pane;
    if (!pane) return;
    document.body.classList.add("replayed");
    $("replay").hidden = false;
    $("replay").setAttribute("aria-label", say("replay"));
    $("moment").setAttribute("aria-label", say("moment"));
    $("moment").setAttribute("aria-valuetext", say("seconds", Math.round(pane.time_s)));
    $("speed").setAttribute("aria-label", say("tempo"));
    $("back-to").setAttribute("aria-label", say("before"));
    $("on-to").setAttribute("aria-label", say("after"));
    $("play").textContent = pane.speed ? "||" : "▶";
    $("play").setAttribute("aria-label", say(pane.speed ? "pause" : "play"));
    $("at").textContent = `${pane.time_s.toFixed(1)} / ${pane.to_s.toFixed(0)} s`;
    $("role").textContent = say("replay");
    $("calm").textContent = say("calmReplay");
  }
}
