// The question card: one question, what each answer leads to, and how long there is.

import { $, make, renew } from "./dom.js";
import { language, say } from "./words.js";

const CALM_MS = 500; // what was pressed for the last question answers no new one

export class Card {
  #link; #map; #question = null; #since = 0; #clock = null; #may = false; #told = ""; #aloud = false; #why = false; #seen = "";

  constructor(link, map) {
    this.#link = link;
    this.#map = map;
    setInterval(() => this.#count(), 250);
    addEventListener("keydown", (event) => this.#key(event));
  }

  get open() { return this.#question?.id ? this.#question : null; }

  setMay(may) { if (may !== this.#may) { this.#may = may; this.draw(); } }
  hold() { this.#held = true; } // time passes only as it is told
  setClock(time_s) { this.#clock = { time_s, at: performance.now() }; }

  set(question) {
    const before = this.#question;
    const isNew = question.id !== before?.id || question.read_back !== before?.read_back || question.text !== before?.text;
    this.#question = question;
    if (isNew) { this.#since = performance.now(); this.#why = false; }
    this.draw();
    if (!question.id) {
      this.#map.setWay([]);
      this.#map.setSpots([]);
      if (before?.id && question.closed) this.#announce(say("closed", question.closed));
      $("said").textContent = "";
      return;
    }
    this.#map.setSpots(question.spots);
    if (isNew) {
      this.#map.blink();
      this.repeat(false);
    } else if (question.again) this.#announce(say("again"));
    if (this.#may && this.#seen !== question.id) {
      this.#seen = question.id;
      this.#link.send({ kind: "seen", question: question.id });
    }
  }

  repeat(focus = true) {
    const q = this.open;
    if (!q) return;
    this.#map.blink();
    const text = q.read_back ? `${say("understood", this.#readBack())}. ${say("isRight")}` : q.text;
    this.#announce(`${say("asks")}: ${text}`);
    if (this.#aloud && globalThis.speechSynthesis) {
      const local = speechSynthesis.getVoices().filter((v) => v.localService && v.lang.startsWith(q.lang));
      speechSynthesis.cancel();
      if (local.length) speechSynthesis.speak(Object.assign(new SpeechSynthesisUtterance(text), { voice: local[0], lang: q.lang }));
    }
    if (focus) $("ask").focus();
  }

  attend(to) {
    if (to === "why") { this.#why = true; this.draw(); }
    else if (to === "where") { this.#map.blink(); $("map").scrollIntoView({ block: "nearest" }); }
    else if (to === "show") $("evidence").classList.add("large");
    else if (to === "repeat") this.repeat();
    else if (to === "nothing-asked") $("said").textContent = say("nothingAsked");
  }

  choose(spot) {
    const q = this.open;
    if (q && spot.choosable && this.#ready()) this.#link.send({ kind: "this-one", question: q.id, thing: spot.id });
  }

  #ready() { return this.#may && performance.now() - this.#since > CALM_MS; }

  #reply(reply, option = null) {
    const q = this.open;
    if (!q || !this.#ready()) return;
    this.#link.send({ kind: "reply", question: q.id, reply, option, confirms: q.read_back !== "" });
    $("said").textContent = say("sent");
  }

  #announce(text) {
    if (text === this.#told) return;
    this.#told = text;
    $("hear").textContent = text;
  }

  #readBack() {
    const q = this.#question;
    const said = { yes: say("yes"), no: say("no") }[q.read_back] ?? q.read_back;
    return q.read_back_means ? `${said} – ${q.read_back_means}` : said;
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
    const q = this.open, key = event.key.toLowerCase();
    if (!q) return;
    const choice = q.consequences.some((c) => c.reply === "option");
    if ((key === "y" || key === "n") && (!choice || q.read_back)) this.#reply(key === "y" ? "yes" : "no");
    else if (key === "u") this.#reply("unsure");
    else if (/^[1-4]$/.test(key) && choice && !q.read_back && q.consequences[key - 1]?.reply === "option") this.#reply("option", key - 1);
    else if (key === "t") this.#more();
    else if (key === "r") this.repeat();
  }

  #more() { if (this.open && this.#may) this.#link.send({ kind: "more-time", question: this.open.id }); }

  draw() {
    const q = this.open, card = $("card");
    $("calm").hidden = Boolean(q);
    $("calm").textContent = say("calm");
    card.hidden = !q;
    document.body.classList.toggle("asking", Boolean(q));
    if (!q) { card.replaceChildren(); return; }
    renew(card,
      make("div", { class: "top" },
        make("p", { class: "who", text: say(q.attempt > 1 ? "asksAgain" : "asks") }),
        make("p", { class: "left", id: "left" })),
      make("div", { class: "bar" }, make("div", { id: "bar" })),
      make("p", { class: "text", lang: q.lang, text: q.text }),
      ...(q.again ? [make("p", { class: "again", text: say("again") })] : []),
      ...(q.read_back ? this.#confirm(q) : this.#answers(q)),
      make("div", { class: "row small" },
        make("button", { type: "button", onclick: () => this.#more(), disabled: q.extended || !this.#may, text: say("more"), "aria-keyshortcuts": "T" }),
        make("button", { type: "button", onclick: () => this.repeat(), text: say("repeat"), "aria-keyshortcuts": "R" }),
        make("button", { type: "button", onclick: () => { this.#aloud = !this.#aloud; globalThis.speechSynthesis?.cancel(); this.draw(); if (this.#aloud) this.repeat(false); }, "aria-pressed": String(this.#aloud), text: say(this.#aloud ? "mute" : "aloud") }),
        ...(q.spots.length ? [make("button", { type: "button", onclick: () => this.attend("where"), text: say("where") })] : []),
        ...(q.why.length || q.worth ? [make("button", { type: "button", onclick: () => { this.#why = !this.#why; this.draw(); }, "aria-expanded": String(this.#why), text: say("why") })] : [])),
      ...(this.#why ? [make("ul", { class: "why" }, ...q.why.map((one) => this.#reason(one)),
        ...(q.worth ? [make("li", { text: say("reasons", q.worth.gain_bits.toFixed(2), q.worth.saved_s.toFixed(1), q.worth.queries, q.worth.gaps) })] : []))] : []),
      ...this.#candidates(q));
    this.#count();
  }

  #answers(q) {
    const rows = q.consequences.map((c) => {
      const name = c.reply === "option" ? `${c.option + 1}` : say(c.reply);
      return this.#row(c, name, { yes: "Y", no: "N", unsure: "U", option: name }[c.reply], c.words || say(`${c.reply}Means`));
    });
    return [make("div", { class: "answers", role: "group", "aria-label": q.text }, ...rows)];
  }

  #row(c, name, key, words) {
    const figures = [
      ...(c.seconds != null ? [say("seconds", Math.round(c.seconds))] : []),
      ...(c.share != null && c.share < 0.995 ? [`${say("likely")}, ${Math.round(100 * c.share)} %`] : []),
      ...(c.undone?.length ? [say("undone", c.undone.join(", "))] : []),
    ].join(" · ");
    const show = () => this.#map.setWay(c.path ?? []);
    const hide = () => this.#map.setWay([]);
    const press = () => {
      if (c.reply === "silence") show();
      else this.#reply(c.reply, c.reply === "option" ? c.option : null);
    };
    return make("button", {
      type: "button", class: `answer ${c.reply}${c.frees ? " frees" : ""}`, "data-reply": c.reply + (c.option ?? ""), "aria-keyshortcuts": key,
      disabled: !this.#may && c.reply !== "silence", onclick: press, onmouseenter: show, onmouseleave: hide, onfocus: show, onblur: hide,
    },
    make("strong", { text: name }, ...(key && key !== name ? [make("kbd", { text: key, "aria-hidden": "true" })] : [])),
    make("span", { class: "means", lang: this.#question.lang, text: words }),
    ...(figures ? [make("span", { class: "figures", text: figures })] : []),
    ...(c.frees ? [make("span", { class: "warns", text: say("frees") })] : []));
  }

  #reason({ words, best_s, worst_s, apart_m }) {
    if (best_s == null || worst_s == null) return make("li", { lang: "en", text: words });
    const figures = [best_s, worst_s, Math.abs(worst_s - best_s), apart_m ?? 0].map((value) => value.toFixed(1));
    return make("li", { text: say("hangs", ...figures) });
  }

  #confirm(q) {
    return [
      make("p", { class: "understood" }, make("span", { text: `${say("understood", this.#readBack())}.` }), " ", make("strong", { text: say("isRight") })),
      make("div", { class: "answers two" },
        make("button", { type: "button", class: "answer yes", "data-reply": "yes", disabled: !this.#may, onclick: () => this.#reply("yes") }, make("strong", { text: say("right") }, make("kbd", { text: "Y", "aria-hidden": "true" }))),
        make("button", { type: "button", class: "answer no", "data-reply": "no", disabled: !this.#may, onclick: () => this.#reply("no") }, make("strong", { text: say("wrong") }, make("kbd", { text: "N", "aria-hidden": "true" })))),
    ];
  }

  #candidates(q) {
    const spots = q.spots.filter((s) => s.choosable);
    if (!spots.length || q.read_back) return [];
    return [make("ul", { class: "candidates" }, ...q.spots.map((s, i) => make("li", {},
      make("span", { lang: q.lang, text: `${i + 1}. ${s.words}` }),
      make("button", { type: "button", disabled: !this.#may, onclick: () => this.choose(s), "aria-label": `${say("thisOne")}: ${s.words}`, text: say("thisOne") }))))];
  }

  #count() {
    const q = this.open;
    if (!q || !this.#clock || !$("left")) return;
    const passed = this.#held ? 0 : Math.min(2, (performance.now() - this.#clock.at) / 1000);
    const left = Math.max(0, q.deadline_s - this.#clock.time_s - passed);
    this.#longest = q.id === this.#longestOf ? Math.max(this.#longest, left) : left;
    this.#longestOf = q.id;
    $("left").textContent = left > 0 ? say("left", Math.ceil(left)) : say("over");
    $("bar").style.width = `${(100 * left) / Math.max(1, this.#longest)}%`;
    $("bar").classList.toggle("short", left < 8);
    if (left > 0 && left < 10 && this.#warned !== q.id) { this.#warned = q.id; this.#announce(say("left", 10)); }
  }

  #held = false; #longest = 0; #longestOf = ""; #warned = "";
}
