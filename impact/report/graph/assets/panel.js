// The panel beside the drawing: all that is known of what is chosen.
const BATCH = 100, LONG = 160, FEW = 12;
const [NAME, DEFAULT, USES, PATH, LINE, MORE] = Array(6).keys();

// A place is a link into the editor, where the page was made for one; gone: it is one of the base, not of the files.
function place(path, row, gone) {
  const text = path ? (row ? `${path}:${row}` : path) : "";
  if (!path || !graph.editor || gone) return make("span", { class: "place" }, text);
  const full = encodeURI(`${graph.folder}/${path}`).replace(/[?#&]/g, encodeURIComponent);
  return make("a", { class: "place", href: graph.editor.replaceAll("{path}", () => full).replaceAll("{line}", row || 1), title: "open in the editor" }, text);
}
// Code that is longer than a few lines is whole when asked for.
function code(text) {
  if (text.length <= LONG) return make("code", null, text);
  return make("details", { class: "long" }, make("summary", null, make("code", null, `${text.slice(0, LONG)}…`)), make("code", null, text));
}
const marked = (mark, why) => (mark ? make("span", { class: `mark ${mark}` }, why ? `${mark}: ${why}` : mark) : "");
function button(text, act, attributes) {
  const node = make("button", { type: "button", ...attributes }, text);
  node.addEventListener("click", act);
  return node;
}
const link = (box) => button(box.label, () => go(box), { class: "go", title: box.key });

// A heading and a list, the rest of which comes when asked for.
// A place that is written as `path:line`.
function placeOf(text, gone) {
  const [, file, row] = /^(.*):(\d+)$/.exec(text) || [];
  return place(file || text, row, gone);
}

function section(title, rows, item) {
  if (!rows.length) return [];
  const list = make("ul", null, rows.slice(0, BATCH).map(item));
  const parts = [make("h3", null, `${title} (${number(rows.length)})`), list];
  if (rows.length > BATCH) {
    const rest = button(`Show ${number(rows.length - BATCH)} more`, () => { list.append(...rows.slice(BATCH).map(item)); rest.remove(); });
    parts.push(rest);
  }
  return parts;
}

function head(title, mark, facts, tools = []) {
  return [button("×", () => choose(null), { class: "close", "aria-label": "close (escape)" }), make("h2", null, title),
    mark ? make("p", null, mark) : "", ...facts.filter(Boolean).map((fact) => (fact instanceof Node ? fact : make("p", { class: "soft" }, fact))),
    tools.length ? make("div", { class: "tools" }, tools) : ""].filter(Boolean);
}
function toolsOf(box) {
  const found = [near === box ? button("Show all again", () => { near = null; update(); }) : button("Only what is near", () => { near = box; update(); go(box); })];
  const group = groupOf(box);
  if (group?.present > 1 && !near) found.push(isFolded(group) ? button(`Unfold ${group.label}`, () => fold(group, false)) : button(`Fold ${group.label}`, () => fold(group, true)));
  return found;
}

function quality(qos) {
  if (!qos) return null;
  const said = [qos.reliability, qos.durability, qos.history, qos.depth !== undefined && qos.depth >= 0 ? `depth ${qos.depth}` : "",
    qos.deadline !== undefined && qos.deadline !== null ? `deadline ${qos.deadline} s` : "", qos.liveliness, qos.lease !== undefined && qos.lease !== null ? `lease ${qos.lease} s` : ""].filter(Boolean);
  const written = qos.written ? code(qos.written) : "";
  return said.length || written ? make("p", null, `QoS ${said.join(", ")} `, written) : null;
}

const HOW = { default: "not certain: the name is a parameter's default", partly: "not certain: what stands in < > is not known", launch: "the name is set by the launch file", given: "the name is fixed by the framework" };
const isDoubtful = (end) => end.how === "default" || end.how === "partly";
const doubt = (...text) => make("p", { class: "doubt" }, ...text);
function made(end, gone) {
  const lines = [place(end.path, end.line, gone)];
  if (end.written || HOW[end.how]) lines.push(make("p", { class: isDoubtful(end) ? "doubt" : "soft" }, end.written ? code(end.written) : "", HOW[end.how] ? ` ${HOW[end.how]}` : ""));
  if (end.only_if) lines.push(doubt("only if ", code(end.only_if)));
  const qos = quality(end.qos);
  if (qos) lines.push(qos);
  if (end.callback) lines.push(make("p", null, "callback ", code(end.callback.name), " ", place(end.callback.path, end.callback.line, gone)));
  return make("li", null, lines);
}
function published(one, gone) {
  const ways = one.ways.map(([trigger, guards]) => make("li", null,
    trigger ? make("p", null, `on ${trigger}`) : "",
    guards.map(([text, path, row]) => make("p", null, "when ", code(text), " ", place(path, row, gone)))));
  const list = make("ul", null, ways);
  const shown = one.ways.length > 2 ? make("details", null, make("summary", null, counted(one.ways.length + one.more, "way")), list) : list;
  return make("li", null, "publish ", one.expression ? code(one.expression) : "", one.function ? make("span", { class: "soft" }, ` in ${one.function}`) : "",
    place(one.path, one.line, gone), shown, one.more ? make("p", { class: "soft" }, `and ${counted(one.more, "more way")}`) : "");
}
function details(said, gone) {
  return make("ul", null, said.at.map((end) => made(end, gone)), said.publishes.map((one) => published(one, gone)));
}
const detailsOf = (edge) => details(edge, edge.mark === "removed");
function was(edge) {
  if (!edge.before) return "";
  return make("details", { class: "before" }, make("summary", null, `before (${graph.base})`), edge.before.types.length ? make("p", null, edge.before.types.join(" or ")) : "", details(edge.before, true));
}
// One end of an edge, seen from the other.
const entry = (from) => (edge) => make("li", { class: edge.unsure ? "unsure" : "" },
  from === edge.nameBox ? (edge.nodeBox ? link(edge.nodeBox) : make("span", { class: "soft" }, "(no node is known to run it)")) : link(edge.nameBox), " ", marked(edge.mark, edge.why),
  edge.types.length && (from !== edge.nameBox || edge.nameBox.name.types.length > 1) ? make("p", { class: "soft" }, edge.types.join(" or ")) : "", detailsOf(edge), was(edge));

const SECTIONS = [["publisher", "Publishes", "Publishers"], ["subscriber", "Subscribes", "Subscribers"], ["server", "Serves", "Servers"],
  ["client", "Asks", "Clients"], ["action server", "Serves actions", "Action servers"], ["action client", "Asks for actions", "Action clients"]];
const byRole = (box, column) => SECTIONS.flatMap((row) => section(row[column], box.edges.filter((edge) => edge.role === row[0]), entry(box)));

function nodePanel(box) {
  const { node } = box;
  const facts = [[node.kind, node.language, node.package && `package ${node.package}`].filter(Boolean).join(", "),
    node.executable && `executable ${node.executable}`, node.plugin && `class ${node.plugin}`, node.id !== node.label && node.id, node.path && place(node.path, node.line, node.mark === "removed")];
  if (node.started) facts.push(make("p", { class: "soft" }, "started by ", placeOf(node.started, node.mark === "removed")));
  if (launches.length > 1 && node.launches.length) facts.push(make("p", { class: "soft" }, "in ", node.launches.join(", ")));
  for (const reason of node.uncertain) facts.push(doubt("not certain: whether it is started, or its name, depends on ", code(reason)));
  return [...head(box.label, marked(box.mark), facts, toolsOf(box)), ...byRole(box, 1),
    ...section("Timers", node.timers, (timer) => make("li", null, timer.period ? code(timer.period) : "", timer.callback ? ` ${timer.callback.name}` : "", place(timer.path, timer.line))),
    ...section("Parameters", node.parameters, (one) => make("li", null, code(one[NAME]), one[DEFAULT] ? make("span", { class: "soft" }, " = ", code(one[DEFAULT])) : "", ` ${one[USES]}`,
      make("p", null, place(one[PATH], one[LINE]), one[MORE] ? make("span", { class: "soft" }, ` and ${counted(one[MORE], "more place")}`) : ""))),
    ...section("Under a name that is not known", node.unnamed, (one) => make("li", null, `${one.role} `, one.written ? code(one.written) : "", make("p", { class: "soft" }, withCode([one.type, one.why].filter(Boolean).join(": "))), place(one.path, one.line)))];
}

function namePanel(box) {
  const { name } = box;
  const facts = [`${box.kind}, ${name.types.length ? name.types.join(" or ") : "type not known"}`];
  if (name.open) facts.push(doubt("not certain: what stands in < > is not known"));
  if (name.rates.length) facts.push(`published at ${name.rates.map(sayRate).join(", ")}`);
  return [...head(box.label, marked(box.mark), facts, toolsOf(box)), ...name.keys.flatMap(fieldList), ...byRole(box, 2)];
}

// What a message, service or action consists of; what is nested in it opens.
function fieldList(key) {
  const found = Object.hasOwn(graph.interfaces, key) ? graph.interfaces[key] : null;
  if (!found) return [];
  const shown = make("details", { class: "type" }, make("summary", null, make("h3", null, `Fields of ${key}`)), members(key, []));
  shown.open = Object.values(found).flat().length <= FEW;
  return [shown];
}
function members(key, above) {
  return Object.entries(graph.interfaces[key]).flatMap(([part, list]) => [
    part === "message" ? "" : make("p", { class: "soft" }, part), make("ul", { class: "fields" }, list.map((one) => member(one, [...above, key])))].filter(Boolean));
}
function member([name, type, nested, value, constant], above) {
  const said = [make("code", null, name), type ? ` ${type}` : "", value !== "" ? make("span", { class: "soft" }, constant ? " = " : " default ", code(value)) : constant ? make("span", { class: "soft" }, " constant") : ""];
  if (!nested || above.includes(nested) || !Object.hasOwn(graph.interfaces, nested)) return make("li", null, said);
  const inner = make("details", null, make("summary", null, said));
  inner.addEventListener("toggle", () => { if (inner.children.length === 1) inner.append(...members(nested, above)); });
  return make("li", null, inner);
}

function groupPanel(box) {
  const inside = new Set(box.members);
  const used = [...new Set(box.edges.map((edge) => edge.nameBox))].sort((a, b) => (a.label < b.label ? -1 : 1));
  const crosses = (name) => name.edges.some((edge) => !inside.has(edge.nodeBox));
  const item = (one) => make("li", null, link(one), one.kind === "node" ? "" : make("p", { class: "soft" }, one.below));
  const told = (list, out) => list.filter((name) => name.edges.some((edge) => inside.has(edge.nodeBox) && edge.outward === out));
  const across = used.filter(crosses);
  return [...head(box.label, marked(box.mark), [`${box.group}, ${counted(box.members.length, "node")}`], [isFolded(box) ? button("Unfold", () => fold(box, false)) : button("Fold", () => fold(box, true))]),
    ...section("Nodes", box.members, item), ...section("Publishes or asks outside", told(across, true), item), ...section("Subscribes or serves outside", told(across, false), item),
    ...section("Inside alone", used.filter((name) => !crosses(name)), item)];
}

function edgePanel(edge) {
  const title = make("span", null, link(edge.nodeBox), ` ${verb(edge.role)} `, link(edge.nameBox));
  return [...head(title, marked(edge.mark, edge.why), [`${edge.kind}, ${edge.types.join(" or ") || "type not known"}`, edge.unsure && doubt("not certain, see below")]), make("h3", null, "Where"), detailsOf(edge), was(edge)];
}
function arrowPanel(arrow) {
  const title = make("span", null, link(arrow.from), " → ", link(arrow.to));
  const item = (name) => make("li", null, link(name), make("p", { class: "soft" }, name.below), make("ul", null,
    [...arrow.edges].filter((edge) => edge.nameBox === name).map((edge) => make("li", { class: edge.unsure ? "unsure" : "" }, link(edge.nodeBox), ` ${verb(edge.role)} it `, marked(edge.mark, edge.why), place(edge.at[0]?.path, edge.at[0]?.line, edge.mark === "removed")))));
  return [...head(title, marked(arrow.mark), [arrow.unsure && doubt("not certain: each of these connections rests on a name or condition that may be otherwise")]), ...section("Through", [...arrow.names], item)];
}

function summary() {
  const { coverage } = graph;
  const share = coverage.calls ? ` (${Math.round(100 * coverage.resolved / coverage.calls)} %)` : "";
  const changes = edges.filter((edge) => edge.mark);
  return [make("h2", null, graph.root && graph.root !== "." ? graph.root : "Message flow"),
    make("p", { class: "soft" }, "Click a node, a topic or an arrow to see where it is written. Drag to move, turn the wheel to zoom; tab and the arrow keys walk along the graph, shift and the arrow keys move it, enter opens, f folds and unfolds, escape closes."),
    make("h3", null, "Coverage"),
    make("p", null, `${number(coverage.resolved)} of ${counted(coverage.calls, "API call")} resolved${share}${coverage.by_default ? `, ${number(coverage.by_default)} by a parameter's default` : ""}${coverage.in_part ? `, ${number(coverage.in_part)} more known in part` : ""}; ${counted(coverage.files, "file")} read.`),
    ...(graph.base === null ? [] : changes.length ? section(`Changes since ${graph.base}`, changes, (edge) => make("li", null, marked(edge.mark, edge.why), " ",
      edge.nodeBox ? button(`${edge.nodeBox.label} ${verb(edge.role)} ${edge.nameBox.label}`, () => { choose(edge); revealChosen(); }, { class: "go" }) : link(edge.nameBox),
      place(edge.at[0]?.path, edge.at[0]?.line, edge.mark === "removed"))) : [make("h3", null, "Changes"), make("p", null, `None since ${graph.base}.`)]),
    ...section("Groups", grouping() ? groups[grouping()].list.filter((group) => group.present > 1) : [], (group) => make("li", { class: "foldable" }, link(group), group.below, button(isFolded(group) ? "Unfold" : "Fold", () => fold(group, !isFolded(group)), { class: "small", "aria-label": `${isFolded(group) ? "unfold" : "fold"} ${group.label}` }))),
    ...section("Possible nodes, whose code is not here", graph.outside, (one) => make("li", { class: "unsure" }, one.name || `any of a ${one.kind}`, " ", code(`${one.package}/${one.executable}`),
      one.names.length ? make("p", { class: "soft" }, `uses ${one.names.join(", ")}`) : "", ...one.uncertain.map((reason) => doubt("only if ", code(reason))), placeOf(one.started))),
    ...section("Not resolved", coverage.unresolved, (one) => make("li", null, `${one.what} `, one.written ? code(one.written) : "", make("p", { class: "soft" }, withCode(one.reason)), place(one.path, one.line))),
    ...section("Read in part", coverage.unread, (path) => make("li", null, place(path))),
    ...section("Left out, since nothing compiles them", coverage.uncompiled, (path) => make("li", null, place(path))),
    make("p", { class: "soft" }, `rosimpact ${graph.version}, ROS ${graph.ros}`)].filter(Boolean);
}

function panel() {
  if (!chosen) return summary();
  if (chosen.from) return arrowPanel(chosen);
  if (chosen.nodeBox) return edgePanel(chosen);
  return { node: nodePanel, group: groupPanel }[chosen.kind]?.(chosen) || namePanel(chosen);
}
