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
