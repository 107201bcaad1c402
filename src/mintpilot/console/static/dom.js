// Elements are made here, and texts are always text: nothing is ever read as markup.

export const $ = (id) => document.getElementById(id);

export function make(tag, options = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(options)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === "text") element.textContent = value;
    else if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children);
  return element;
}

/** Replaces what is inside, and leaves the focus where it was: on what is called the same. */
export function renew(parent, ...children) {
  const name = (one) => one.dataset.reply ?? one.getAttribute("aria-label") ?? one.textContent;
  const held = parent.contains(document.activeElement) && document.activeElement !== parent ? name(document.activeElement) : null;
  parent.replaceChildren(...children);
  if (held !== null) [...parent.querySelectorAll("button, summary, a, [tabindex]")].find((one) => name(one) === held)?.focus();
}
