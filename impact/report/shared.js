"use strict";
// What the pages share: their data, elements, words and the light.
const data = JSON.parse(document.getElementById("data").textContent);
const at = (id) => document.getElementById(id);
const number = (value) => value.toLocaleString("en");
const counted = (value, noun) => `${number(value)} ${noun}${value === 1 ? "" : "s"}`;

// Everything is a text node or an attribute that holds no address, so nothing in it is ever read as markup.
function make(tag, attributes, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
  node.append(...children.flat().filter((child) => child !== null && child !== ""));
  return node;
}

// Backticks become code.
const withCode = (text) => text.split(/(`[^`]+`)/).filter(Boolean).map(
  (part) => (part.length > 2 && part[0] === "`" ? make("code", null, part.slice(1, -1)) : part));

// Filters live in the address, so that a link to a part of a page can be kept. fields, boxes: ids of inputs, and of
// boxes to tick; more: what else is kept, by name. recall() gives all that the address holds.
function remember(fields, boxes, more) {
  const state = new URLSearchParams();
  for (const id of fields) if (at(id).value) state.set(id, at(id).value);
  for (const id of boxes) if (at(id).checked !== at(id).defaultChecked) state.set(id, at(id).checked ? "1" : "0");
  for (const [name, value] of Object.entries(more || {})) if (value) state.set(name, value);
  try { history.replaceState(null, "", `#${state}`); } catch { /* some viewers forbid it */ }
}
function recall(fields, boxes) {
  const state = new URLSearchParams(location.hash.slice(1));
  for (const id of fields) {
    const value = state.get(id) || "";
    at(id).value = value;
    if (at(id).value !== value) at(id).value = "";
  }
  for (const id of boxes) at(id).checked = state.has(id) ? state.get(id) === "1" : at(id).defaultChecked;
  return state;
}

const typing = () => /^(INPUT|SELECT|TEXTAREA)$/.test(document.activeElement.tagName);
addEventListener("keydown", (event) => {
  if (event.key !== "/" || event.ctrlKey || event.metaKey || event.altKey || typing()) return;
  event.preventDefault();
  at("search").focus();
});

const dark = matchMedia("(prefers-color-scheme: dark)");
const theme = (name) => { document.documentElement.dataset.theme = name; };
theme(dark.matches ? "dark" : "light");
dark.addEventListener("change", () => theme(dark.matches ? "dark" : "light"));
at("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
// On paper it is always light.
let before = "";
addEventListener("beforeprint", () => { before = document.documentElement.dataset.theme; theme("light"); });
addEventListener("afterprint", () => theme(before));
