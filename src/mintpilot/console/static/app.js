// Puts the page together: what comes over the link goes to the map, the card, the tree and the lists.

import { Card } from "./card.js";
import { $, make, renew } from "./dom.js";
import { Link } from "./link.js";
import { MapView } from "./map.js";
import { Microphone } from "./microphone.js";
import { Replay } from "./replay.js";
import { Tell } from "./tell.js";
import { showTree } from "./tree.js";
import { say, speak } from "./words.js";

const ORDERS = ["hold", "continue", "return", "land", "abort"];
const STATES = { open: "todo", now: "now", done: "done", "left-out": "left-out" };
const SIGNS = { open: "○", now: "▶", done: "✓", "left-out": "–" };

const link = new Link();
const map = new MapView($("map"), (spot) => card.choose(spot), (found) => tell.pick(found));
const card = new Card(link, map);
const tell = new Tell(link, map);
const replay = new Replay(link);
const microphone = new Microphone(link);
const last = {}; // the newest of each pane, to say it again in another language

const on = (pane, show) => link.addEventListener(pane, (event) => {
  last[pane] = event.detail;
  show(event.detail);
});

on("mission", ({ data }) => {
  if (!localStorage.getItem("lang")) use(data.lang);
  map.setVolume(data.volume);
  showMission(data);
});
on("seat", ({ data }) => showSeat(data));
on("pose", ({ data }) => { map.setPose(data); card.setClock(data.time_s); showBattery(data); });
on("plan", ({ data }) => map.setPlan(data.points));
on("map", ({ data, payload }) => { map.setMap(data, payload); tell.setMap(data); });
on("replay", ({ data }) => { card.hold(); replay.set(data); });
on("told", ({ data }) => tell.set(data.told));
on("flown", ({ from, items }) => map.addFlown(from, items.map((i) => i.at)));
on("steps", ({ data }) => showSteps(data));
on("tree", ({ data }) => showTree(data));
on("question", ({ data }) => card.set(data));
on("microphone", ({ data }) => microphone.caption(data));
on("spoken", ({ data, payload }) => microphone.play(data.n, payload));
on("attention", ({ data }) => card.attend(data.to));
on("camera", ({ data, payload }) => picture($("picture"), payload, data.boxes, say("camera")).then(() => { $("camera").hidden = false; }));
on("log", ({ from, items }) => showLog(from, items));
on("state", (state) => showLink(state));
link.addEventListener("not-taken", () => { $("said").textContent = say("notTaken"); });
for (let i = 0; i < 4; i++) on(`evidence-${i}`, ({ data, payload }) => showEvidence(i, data, payload));

function showMission(m) {
  document.title = `${m.name} – MintPilot`;
  $("name").textContent = m.name;
  $("instruction").textContent = m.instruction;
  $("briefing").replaceChildren(
    ...(m.verdict ? [make("p", { class: `verdict ${m.verdict === "success" ? "good" : "bad"}`, role: "status" }, make("strong", { text: say("ended") }), make("span", { lang: "en", text: m.reason }),
      ...(m.waited_s >= 0.5 ? [make("span", { class: "figures", text: say("waited", Math.round(m.waited_s), Math.max(0, Math.round(m.hidden_s))) })] : []))] : []),
    ...(m.briefing.length && !m.verdict ? [make("details", { open: true }, make("summary", { text: say("briefing") }), ...m.briefing.map((line) => make("p", { lang: "en", text: line })))] : []));
}

function showSeat(s) {
  $("role").textContent = say(s.seated ? "answering" : "watching");
  $("role").classList.toggle("on", s.seated);
  const button = $("seat");
  button.hidden = !s.may_answer || (s.seated && s.viewers < 2);
  button.textContent = say(s.seated ? "leave" : s.taken ? "takeOver" : "take");
  button.onclick = () => link.send({ kind: s.seated ? "leave-seat" : "take-seat" });
  for (const order of document.querySelectorAll("#orders button")) order.disabled = !s.may_answer;
  for (const field of $("say").elements) field.disabled = !s.seated;
  card.setMay(s.seated);
  tell.setMay(s.seated);
  microphone.setMay(s.seated);
  replay.draw();
}

function showOrders() {
  $("orders").setAttribute("aria-label", say("orders"));
  renew($("orders"), ...ORDERS.map((order) => make("button", {
    type: "button", class: `order ${order}`, disabled: !last.seat?.data.may_answer, text: say(order), onclick: () => link.send({ kind: "order", order }),
  })));
}

function showBattery(pose) {
  const has = pose.battery_s, needs = pose.need_s;
  const words = has == null ? say("batteryFree") : say("batteryHas", Math.round(has));
  const need = needs == null ? "" : say("batteryNeeds", Math.round(needs));
  const full = Math.max(has ?? 0, needs ?? 0, 1, showBattery.most ?? 0);
  showBattery.most = full;
  if (!$("charge")) $("battery").replaceChildren(make("p", { id: "charge" }), make("div", { class: "gauge", "aria-hidden": "true" }, make("div", { id: "has" }), make("div", { id: "needs" })));
  $("charge").textContent = [`${say("battery")}: ${words}`, need].filter(Boolean).join(" · ");
  $("has").style.width = `${has == null ? 100 : (100 * has) / full}%`;
  $("has").classList.toggle("low", has != null && needs != null && has < needs);
  $("needs").style.left = `${(100 * (needs ?? 0)) / full}%`;
  $("needs").hidden = needs == null || has == null;
  const rows = [["clock", `${pose.time_s.toFixed(0)} s`], ["height", `${pose.position[2].toFixed(1)} m`], ["speed", `${pose.speed_mps.toFixed(1)} m/s`]];
  $("figures").replaceChildren(...rows.map(([key, value]) => make("div", {}, make("dt", { text: say(key) }), make("dd", { text: value }))));
}

function showSteps(pane) {
  $("steps").replaceChildren(...pane.steps.map((s) => make("li", { class: s.state, "aria-current": s.state === "now" ? "step" : null },
    make("span", { class: "sign", "aria-hidden": "true", text: SIGNS[s.state] }), make("span", { text: s.text }), make("span", { class: "state", text: say(STATES[s.state]) }))));
}

const lines = [];
function showLog(from, items) {
  lines.length = Math.min(lines.length, from);
  lines.push(...items);
  const log = $("log-box"), below = log.scrollHeight - log.scrollTop - log.clientHeight < 40;
  $("log").replaceChildren(...lines.slice(-200).map((l) => make("li", { class: `line-${l.kind}` }, make("time", { text: `${l.time_s.toFixed(0)} s` }), make("b", { text: say(`log-${l.kind}`) }), make("span", { lang: /^(question|answer)$/.test(l.kind) ? null : "en", text: l.text }))));
  if (below) log.scrollTop = log.scrollHeight;
}

async function picture(canvas, blob, boxes, label) {
  const bitmap = await createImageBitmap(blob);
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  const c = canvas.getContext("2d");
  c.drawImage(bitmap, 0, 0);
  for (const { box: [left, top, right, bottom] } of boxes) {
    c.lineWidth = 4; c.strokeStyle = "#000"; c.strokeRect(left, top, right - left, bottom - top);
    c.lineWidth = 2; c.strokeStyle = "#ffd23f"; c.strokeRect(left, top, right - left, bottom - top);
  }
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${label}: ${boxes.map((b) => b.words).join(", ")}`);
}

const shown = [];
async function showEvidence(i, data, blob) {
  shown[i]?.remove();
  shown[i] = null;
  if (data.frame < 0 || !blob) return;
  const canvas = make("canvas", { role: "img" });
  const figure = make("figure", {}, canvas, make("figcaption", { text: data.boxes.map((b) => b.words).join(", ") }));
  shown[i] = figure;
  await picture(canvas, blob, data.boxes, say("evidence"));
  if (shown[i] === figure) $("evidence").append(figure);
}

function showLink(state) {
  microphone.linked(state === "up");
  const box = $("link");
  if (state === "lost" && (last.mission?.data.verdict || replay.shown)) state = "up"; // the mission is over, and the program with it
  box.className = state;
  document.body.classList.toggle("cut", state !== "up");
  if (state === "up") box.replaceChildren();
  else if (state === "refused") box.replaceChildren(make("strong", { text: say("refused") }));
  else box.replaceChildren(make("strong", { text: say("lost") }), make("span", { text: say(card.open ? "lostOpen" : "lostCalm") }));
}

function showLegend() {
  const marks = ["drone", "planned", "flown", "reply", "open", "passable", "blocked", "wall", "unknown"];
  $("legend").replaceChildren(...marks.map((key) => make("li", {}, make("span", { class: `swatch ${key}`, "aria-hidden": "true" }), say(key))));
}

function use(lang) {
  speak(lang);
  $("lang").value = lang;
  showOrders();
  showLegend();
  card.draw();
  tell.draw();
  replay.draw();
  microphone.draw();
  if (last.mission) showMission(last.mission.data);
  if (last.seat) showSeat(last.seat.data);
  if (last.steps) showSteps(last.steps.data);
  if (last.tree) showTree(last.tree.data);
  if (last.pose) { showBattery(last.pose.data); map.setPose(last.pose.data); }
  else $("map").setAttribute("aria-label", say("noMap"));
  if (last.state) showLink(last.state);
  if (lines.length) showLog(lines.length, []);
}

$("lang").addEventListener("change", (event) => {
  localStorage.setItem("lang", event.target.value);
  use(event.target.value);
});
$("evidence").addEventListener("click", () => $("evidence").classList.toggle("large"));
$("say").addEventListener("submit", (event) => {
  event.preventDefault();
  const text = $("words").value.trim();
  if (!text) return;
  $("said").textContent = "";
  link.send({ kind: "say", question: card.open?.id ?? "", text });
  $("words").value = "";
});

use(localStorage.getItem("lang") || (navigator.language || "en").slice(0, 2));
