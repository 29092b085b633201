// A finding as html.py writes it: its fields, and how its place, its lines of code, its evidence and its help are shown.
const [RULE, SEVERITY, PACKAGE, PATH, LINE, COLUMN, SUBJECT, TARGETS, MESSAGE, HELP, NEW, CODE, EVIDENCE, ALSO] = Array(14).keys();
const SEVERITIES = ["error", "warning", "note"];

const placeOf = (finding) => finding[PATH] + (finding[LINE] ? `:${finding[LINE]}` + (finding[COLUMN] ? `:${finding[COLUMN]}` : "") : "");

// Place and code, which several findings of one cause have each for itself.
function whereOf(finding) {
  if (!finding[PATH]) return [];
  const place = make("div", { class: "place" }, placeOf(finding));
  if (!finding[CODE]) return [place];
  const [first, lines, start, width] = finding[CODE];
  const block = make("pre", { tabindex: "0", "aria-label": `lines of ${finding[PATH]}` });
  lines.forEach((line, index) => {
    const here = first + index === finding[LINE];
    const row = make("div", here ? { class: "here" } : null, make("i", { "aria-hidden": "true" }, String(first + index)));
    if (here && width) {
      // Offsets count characters, as Python does; JavaScript counts UTF-16 units.
      const signs = Array.from(line);
      row.append(signs.slice(0, start).join(""), make("mark", null, signs.slice(start, start + width).join("")), signs.slice(start + width).join(""));
    } else row.append(line);
    block.append(row);
  });
  return [place, block];
}

// Findings of one cause together, which say the same of one package at several places. Errors are apart; of what is a
// warning at its first place and a note at the others, the warning leads.
function alikeOf(findings) {
  const groups = new Map();
  for (const finding of findings) {
    const said = [RULE, PACKAGE, MESSAGE, HELP, TARGETS, NEW].map((index) => finding[index]).join("\n");
    const key = `${finding[SEVERITY] === "error"}\n${said}`;
    if (groups.has(key)) groups.get(key).push(finding);
    else groups.set(key, [finding]);
  }
  const rank = (finding) => Number(finding[SEVERITY] === "note");
  return [...groups.values()].map((group) => group.sort((a, b) => rank(a) - rank(b)));
}

// The places behind the first of a cause, folded; they are made when they are asked for.
function morePlacesOf(others) {
  if (!others.length) return [];
  const more = make("details", { class: "places" }, make("summary", null, `and ${counted(others.length, "more place")}`));
  more.addEventListener("toggle", () => { if (more.children.length === 1) more.append(...others.flatMap(whereOf)); });
  return [more];
}

// `1 finding in 40 places`.
const countedCauses = (groups, noun) => {
  const places = groups.reduce((sum, group) => sum + group.length, 0);
  return counted(groups.length, noun) + (places > groups.length ? ` in ${number(places)} places` : "");
};

// What the finding rests on, folded.
function evidenceOf(finding) {
  if (!finding[EVIDENCE].length) return [];
  const rows = make("dl");
  for (const [label, text] of finding[EVIDENCE]) rows.append(make("dt", null, label), make("dd", null, text));
  return [make("details", { class: "evidence" }, make("summary", null, "evidence"), rows)];
}

const helpOf = (finding) => (finding[HELP] ? [make("p", { class: "help" }, make("b", null, "help: "), ...withCode(finding[HELP]))] : []);

const wordsOf = (finding) => [RULE, PACKAGE, PATH, SUBJECT, MESSAGE, HELP].map((index) => finding[index]).join("\n").toLowerCase();

function targetOf(target, reason) {
  const detail = [target.distro === target.name ? "" : target.distro, target.date, target.platform];
  const item = make("li", null, make("b", null, target.name), " ", make("span", null, detail.filter(Boolean).join(", ")));
  for (const note of [reason, ...target.notes]) if (note) item.append(make("br"), make("span", null, note));
  return item;
}

// The choices of a select: all, then pairs of value and text.
function fill(id, all, entries) {
  at(id).append(make("option", { value: "" }, all));
  for (const [value, text] of entries) at(id).append(make("option", { value }, text));
}
