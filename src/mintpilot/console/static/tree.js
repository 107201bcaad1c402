// The tree as it stands, and what became of each gap.

import { $, make } from "./dom.js";
import { say } from "./words.js";

export function showTree(pane) {
  $("certificate").textContent = pane.certificate;
  $("answers").replaceChildren(...pane.earlier.map((r) => make("details", { open: true },
    make("summary", { text: r.answers.map((a) => `${a.question} – ${a.reply}`).join("; ") }), make("ul", { class: "tree" }, node(r.root, 0)))),
  ...pane.answers.map((a, i) => make("p", {}, make("strong", { text: `${say("answerNo", i + 1)}: ` }), make("span", { text: `${a.question} – ${a.reply}` }))));
  $("tree").replaceChildren(pane.root ? make("ul", { class: "tree" }, node(pane.root, 0)) : make("p", { text: say("noTree") }));
  $("gaps").replaceChildren(...pane.gaps.map((g) => make("li", { class: g.asked ? "asked" : "" },
    make("strong", { lang: "en", text: g.words }), " ", make("span", { class: "chip", text: say(g.asked ? "asked" : "notAsked") }),
    make("p", { lang: "en", text: g.why }))));
}

function node(n, depth) {
  const figures = [`${(100 * n.probability).toFixed(0)} %`,
    ...(n.cost_s != null ? [say("seconds", n.cost_s.toFixed(1))] : []),
    ...(n.divergence_m != null ? [say("apart", n.divergence_m.toFixed(1))] : []),
    ...(n.leaf ? [n.leaf] : []),
    ...(n.ruled_out_by ? [say("ruledOut", n.ruled_out_by)] : []),
    ...(n.flown ? [say("flownPlan")] : [])].join(" · ");
  const head = [make("span", { class: "given", lang: "en", text: n.words }), make("span", { class: "figures", text: figures }),
    ...(n.branch ? [make("span", { class: "branch", lang: "en", text: `${n.branch}?` })] : [])];
  const cls = [n.ruled_out_by ? "out" : "", n.flown ? "flown" : ""].join(" ").trim();
  if (!n.children.length) return make("li", { class: cls || null }, make("div", { class: "node" }, ...head));
  return make("li", { class: cls || null }, make("details", { open: depth < 3 && !n.ruled_out_by }, make("summary", { class: "node" }, ...head),
    make("ul", {}, ...n.children.map((child) => node(child, depth + 1)), ...(n.left_out ? [make("li", { text: say("omitted", n.left_out) })] : []))));
}
