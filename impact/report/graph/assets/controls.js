// The controls: what they ask for is selected, projected, laid out and drawn; the address keeps it.
const FIELDS = ["search", "view", "group", "launch", "package"], TICKS = [...KINDS, "ends", "standard", "alone", "changed"];
const FIRST = firstGrouping();
const VIEWS = { both: "nodes and topics", nodes: "nodes only", topics: "topics only", table: "table" };

// The first option of a select has no value, so that an address without one means it.
const viewed = () => at("view").value || "both";
const grouping = () => { const how = at("group").value || FIRST; return how === "none" ? "" : how; };
const groupOf = (box) => (grouping() && box.kind === "node" ? groups[grouping()].of.get(box) : box.members ? box : null);
const isFolded = (group) => !open.has(group.key);
// The box that stands for a node; what is near a box is never folded.
function stand(box) {
  const group = near ? null : groupOf(box);
  return group && isFolded(group) && group.present > 1 ? group : box;
}
// How many nodes of each group the filters let through; a group of which that is one stands as this one.
function countPresent() {
  for (const group of grouping() ? groups[grouping()].list : []) {
    group.present = group.members.filter((box) => fitting.boxes.has(box)).length;
    const all = counted(group.members.length, "node"), below = group.present < group.members.length ? `${number(group.present)} of ${all}` : all;
    if (group.below !== below) Object.assign(group, { below, shown: undefined });
  }
}
function fold(group, shut) {
  if (shut) open.delete(group.key); else open.add(group.key);
  if (chosen === group || (shut && groupOf(chosen || group) === group)) chosen = shut ? group : null;
  update();
  const box = shut ? group : group.members.find((one) => one.shape);
  if (box?.shape) { rove(box); box.shape.focus({ preventScroll: true }); }
}
function foldAll(shut) {
  open = new Set(shut ? [] : groups[grouping()].list.map((group) => group.key));
  update();
}

function update() {
  const asked = { kinds: new Set(KINDS.filter((kind) => at(kind).checked)), package: at("package").value, launch: at("launch").value,
    changed: at("changed").checked, ends: at("ends").checked, standard: at("standard").checked };
  const kept = near ? nearby(near, select(asked)) : select(asked);
  const loners = !near && at("alone").checked ? [...nodes, ...names].filter((box) => lone(box) && (!asked.changed || box.mark)
    && (box.node ? (!asked.package || asked.package === `=${box.node.package}`) && startedBy(box.node, asked.launch) : asked.kinds.has(box.kind) && !asked.package && !asked.launch)) : [];
  fitting = { edges: kept, boxes: new Set([...kept.flatMap((edge) => [edge.nodeBox, edge.nameBox]), ...loners, ...(near ? [near] : [])]) };
  countPresent();
  const table = viewed() === "table";
  at("stage").hidden = table;
  at("table").hidden = !table;
  at("legend").querySelector('[data-kind="group"]').hidden = !grouping();
  at("folding").hidden = table || !grouping() || viewed() === "topics";
  if (!table) arrange(kept, loners);
  const wanted = chosen?.key;
  if (chosen?.from) chosen = shownArrows.find((arrow) => arrow.key === wanted) || null;
  else if (chosen && !isFitting(chosen)) chosen = null;
  search();
  show();
}
const isFitting = (what) => (what.nodeBox ? fitting.edges.includes(what) : what.members ? what.members.some((box) => fitting.boxes.has(box)) : fitting.boxes.has(what));

// Lays out what fits, and shows the whole of it.
function arrange(kept, loners) {
  const start = performance.now();
  const [used, arrows] = project(kept, viewed(), stand);
  const lonely = loners.map((box) => (box.node ? stand(box) : box)).filter((box) => viewed() !== "topics" || !box.node).filter((box) => viewed() !== "nodes" || !box.name);
  const all = new Set([...used, ...lonely, ...(near && !used.size ? [near] : [])]);
  shownBoxes = [...nodes, ...(grouping() ? groups[grouping()].list : []), ...names].filter((box) => all.has(box));
  shownArrows = arrows;
  const position = new Map(shownBoxes.map((box, index) => [box, index]));
  const ways = new Map();
  for (const arrow of shownArrows) for (const box of [arrow.from, arrow.to]) ways.set(box, (ways.get(box) || 0) + 1);
  for (const box of shownBoxes) {
    measureBox(box);
    box.height = Math.max(box.members ? 48 : box.shownBelow ? 40 : 28, Math.min(130, 14 + (shownArrows.length > 4 ? ways.get(box) || 0 : 0) * 4));
  }
  area = stage.getBoundingClientRect();
  // The layout works on numbers of boxes.
  const links = shownArrows.map((arrow) => ({ from: position.get(arrow.from), to: position.get(arrow.to), kind: arrow.kind }));
  size = layered(shownBoxes, links, Math.max(0.5, Math.min(3, area.width / Math.max(1, area.height))));
  links.forEach(({ points, back }, index) => Object.assign(shownArrows[index], { points, back }));
  paint();
  drawMap();
  fit();
  at("empty").hidden = shownBoxes.length > 0;
  if (!nodes.length && !names.length) at("empty").textContent = "No node was found; the panel says what was read.";
  performance.measure("rosimpact graph layout", { start, end: performance.now() });
}

// ---- choosing and searching ----------------------------------------------------------------------------------------

function choose(what) {
  chosen = what;
  if (what && !what.from && !isFitting(what)) {
    near = null;
    for (const id of ["search", "launch", "package"]) at(id).value = "";
    for (const id of TICKS) at(id).checked = at(id).defaultChecked;
    if (what.name?.standard || what.nameBox?.name.standard) at("standard").checked = true;
    if (!what.nodeBox && !what.members && lone(what)) at("alone").checked = true;
    update();
    chosen = what;
  }
  show();
  at("panel").scrollTop = 0;
}
function go(box) { choose(box); revealChosen(); }
// The box that stands for what is chosen, if one does.
function shownFor(box) {
  const found = box.node ? stand(box) : box;
  return found.shape && shownBoxes.includes(found) ? found : null;
}
function revealChosen() {
  const box = shownFor(chosen.nodeBox || chosen);
  if (box) { reveal(box, true); rove(box); }
}

function show() {
  const on = new Set(), far = new Set(), found = new Set(hits.map(shownFor).filter(Boolean));
  const box = chosen && !chosen.from && !chosen.nodeBox ? shownFor(chosen) : null;
  const carries = (arrow) => arrow === chosen || arrow.edge === chosen || (!arrow.edge && arrow.edges.has(chosen)) || (!box && (arrow.names.has(chosen) || arrow.through.has(chosen)));
  if (chosen && !box) for (const arrow of shownArrows.filter(carries)) [arrow, arrow.from, arrow.to].forEach((one) => on.add(one));
  else if (box) {
    on.add(box);
    for (const arrow of shownArrows) if (arrow.from === box || arrow.to === box) [arrow, arrow.from, arrow.to].forEach((one) => on.add(one));
    if (box.side === 0) {
      // Those at the other ends of what a node says and hears, less strongly.
      const said = new Map(shownArrows.filter((arrow) => on.has(arrow)).map((arrow) => (arrow.from === box ? [arrow.to, true] : [arrow.from, false])).filter(([other]) => other.name));
      for (const arrow of shownArrows) {
        const ends = said.get(arrow.from) === true ? arrow.to : said.get(arrow.to) === false ? arrow.from : null;
        if (ends && !on.has(arrow)) [arrow, ends].forEach((one) => { if (!on.has(one)) far.add(one); });
      }
    }
  } else found.forEach((one) => on.add(one));
  stage.classList.toggle("dim", on.size > 0);
  if (viewed() === "table") tabulate();
  else for (const one of [...shownBoxes, ...shownArrows]) {
    const list = one.shape.classList;
    list.toggle("on", on.has(one) || far.has(one) || (Boolean(chosen) && found.has(one)));
    list.toggle("near", far.has(one));
    list.toggle("chosen", Boolean(chosen) && (one === box || one === chosen || one.edge === chosen));
    list.toggle("hit", found.has(one));
  }
  at("panel").replaceChildren(...panel());
  keep();
}

const words = () => at("search").value.toLowerCase().split(/\s+/).filter(Boolean);
function search() {
  const wanted = words();
  hits = wanted.length ? [...nodes, ...names].filter((box) => fitting.boxes.has(box) && wanted.every((word) => box.haystack.includes(word))) : [];
  at("count").textContent = wanted.length ? (hits.length ? `${number(hits.length)} found` : "nothing found") : "";
}
function nextHit(step) {
  if (!hits.length) return;
  const position = hits.indexOf(chosen);
  go(hits[(position + step + hits.length + (position < 0 && step < 0 ? 1 : 0)) % hits.length]);
}

// ---- the address ---------------------------------------------------------------------------------------------------

const keyOf = (what) => what && (what.nodeBox ? `${what.nodeBox.key} ${what.role} ${what.nameBox.key}` : what.key);
function keep() {
  const order = sorted.column === "name" && !sorted.down ? "" : `${sorted.column}${sorted.down ? " down" : ""}`;
  remember(FIELDS, TICKS, { show: keyOf(chosen), near: near?.key, open: open.size ? JSON.stringify([...open]) : "", sort: order });
}
function comeBack() {
  const state = recall(FIELDS, TICKS);
  const every = [...nodes, ...names, ...Object.values(groups).flatMap(({ list }) => list)];
  near = [...nodes, ...names].find((box) => box.key === state.get("near")) || null;
  const [column, down] = (state.get("sort") || "").split(" ");
  sorted = { column: COLUMNS.some(([id]) => id === column) ? column : "name", down: down === "down" };
  let listed = [];
  try { listed = JSON.parse(state.get("open") || "[]"); } catch { /* not an address of ours */ }
  open = new Set(every.filter((box) => box.members && Array.isArray(listed) && listed.includes(box.key)).map((box) => box.key));
  const wanted = state.get("show");
  const find = () => every.find((box) => box.key === wanted) || edges.find((edge) => edge.nodeBox && keyOf(edge) === wanted) || shownArrows.find((arrow) => arrow.key === wanted) || null;
  chosen = null;
  update();
  if (!wanted) return;
  chosen = find();
  if (chosen && !chosen.from && !isFitting(chosen)) chosen = null;
  show();
  if (chosen && !chosen.from) revealChosen();
}

// ---- what the controls offer ---------------------------------------------------------------------------------------

function legend() {
  const sample = (kind, mark, text) => make("li", { "data-kind": kind }, draw("svg", { width: 26, height: 14, viewBox: "-13 -7 26 14", "aria-hidden": "true" },
    kind === "line" ? draw("g", { class: `edge ${mark}` }, draw("path", { class: "line", d: "M-12 0H5" }), draw("path", { class: "tip", d: "M12 0l-9 -4.2v8.4z" }))
      : draw("g", { class: `box ${kind}` }, kind === "action" ? draw("path", { class: "shape", d: "M-12 0L-7 -5.5H7L12 0L7 5.5H-7Z" })
        : draw("rect", { class: "shape", x: -12, y: -5.5, width: 24, height: 11, rx: kind === "node" ? 5.5 : 2 }))), text);
  const present = ["node", "group", ...KINDS.filter((kind) => names.some((box) => box.kind === kind))];
  at("legend").append(...present.map((kind) => sample(kind, "", kind)));
  if ([...nodes, ...names, ...edges].some((one) => one.unsure)) at("legend").append(sample("line", "unsure", "not certain"));
  if (graph.base !== null) at("legend").append(...MARKS.map((mark) => sample("line", mark, mark)));
}

function offer(id, first, rest) {
  at(id).append(make("option", { value: "" }, first), ...rest.map(([value, text]) => make("option", { value }, text)));
}
const tally = (list) => [...list.reduce((found, one) => found.set(one, (found.get(one) || 0) + 1), new Map())].sort((a, b) => (a[0] < b[0] ? -1 : 1));
function offerAll() {
  at("root").textContent = graph.root === "." ? "" : graph.root.split("/").filter(Boolean).slice(-2).join("/");
  at("root").title = graph.root;
  at("facts").textContent = [counted(nodes.length, "node"), ...KINDS.map((kind) => [kind, names.filter((box) => box.kind === kind).length]).filter(([, count]) => count).map(([kind, count]) => counted(count, kind)),
    ...(graph.rev ? [`at ${graph.rev.slice(0, 12)}`] : []), ...(graph.base !== null ? [`against ${graph.base}`] : [])].join(" · ");
  offer("view", VIEWS.both, Object.entries(VIEWS).slice(1));
  const ways = { none: "not grouped", namespace: "by namespace", package: "by package" };
  offer("group", ways[FIRST], Object.entries(ways).filter(([how]) => how !== FIRST && (how === "none" || groups[how].list.length)));
  at("group").hidden = at("group").options.length < 2;
  offer("package", "every package", tally(nodes.map((box) => box.node.package)).map(([name, count]) => [`=${name}`, `${name || "no package"} (${number(count)})`]));
  const started = tally(nodes.flatMap((box) => box.node.launches)), other = nodes.filter((box) => !box.node.launches.length).length;
  offer("launch", "every launch file", [...started.map(([path, count]) => [`=${path}`, `${path.split("/").slice(-3).join("/")} (${number(count)})`]), ...(other ? [["=", `no launch file (${number(other)})`]] : [])]);
  at("launch").hidden = started.length < 2;
  const label = (id, text, there) => { at(id).nextElementSibling.textContent = text; at(id).parentElement.hidden = !there; };
  for (const kind of KINDS) {
    const count = names.filter((box) => box.kind === kind).length;
    label(kind, counted(count, kind), count);
  }
  const standard = names.filter((box) => box.name.standard).length, loners = [...nodes, ...names].filter(lone).length;
  const ends = [...deadEnds(edges.filter((edge) => edge.nodeBox))].filter((box) => !box.name.standard).length;
  label("ends", counted(ends, "dead end"), ends);
  label("standard", `${number(standard)} standard`, standard);
  label("alone", `${number(loners)} unconnected`, loners);
  at("standard").defaultChecked = graph.everything || names.every((box) => box.name.standard);
  at("alone").defaultChecked = loners > 0 && !edges.some((edge) => edge.nodeBox);
  at("changed-label").hidden = graph.base === null;
}

offerAll();
legend();
comeBack();
performance.mark("rosimpact graph drawn");

at("filters").addEventListener("input", (event) => {
  if (event.target === at("search")) { chosen = null; search(); show(); return; }
  if (event.target === at("group")) { open.clear(); if (chosen?.members) chosen = null; }
  update();
});
at("filters").addEventListener("submit", (event) => event.preventDefault());
at("filters").addEventListener("reset", () => setTimeout(() => { near = chosen = null; open.clear(); update(); }));
at("search").addEventListener("keydown", (event) => {
  if (event.key === "Enter") { event.preventDefault(); nextHit(event.shiftKey ? -1 : 1); }
});
at("fold").addEventListener("click", () => foldAll(true));
at("unfold").addEventListener("click", () => foldAll(false));
at("in").addEventListener("click", () => zoom(1.3));
at("out").addEventListener("click", () => zoom(1 / 1.3));
at("fit").addEventListener("click", fit);
// On paper the whole is shown, as large as the sheet allows.
addEventListener("beforeprint", () => {
  stage.setAttribute("viewBox", `-10 -10 ${size.width + 20} ${size.height + 20}`);
  stage.classList.remove("far", "farther");
  world.removeAttribute("transform");
});
addEventListener("afterprint", () => { stage.removeAttribute("viewBox"); move(); });
addEventListener("hashchange", comeBack);
addEventListener("resize", () => { area = stage.getBoundingClientRect(); if (!chosen && !hits.length) fit(); else move(); });
addEventListener("keydown", (event) => {
  if (event.key === "Escape") {
    const last = chosen && !chosen.nodeBox && !chosen.from ? shownFor(chosen) : null;
    if (chosen) choose(null);
    else if (at("search").value) { at("search").value = ""; search(); show(); } else if (near) { near = null; update(); }
    if (last?.shape && document.activeElement !== at("search")) last.shape.focus({ preventScroll: true });
    return;
  }
  if (event.ctrlKey || event.metaKey || event.altKey || typing()) return;
  if (viewed() === "table" || moveByKey(event)) return;
  if (event.key === "+" || event.key === "=") zoom(1.3);
  if (event.key === "-") zoom(1 / 1.3);
  if (event.key === "0") fit();
  if (event.key === "f") {
    const focused = [...shownBoxes].find((box) => box.shape === document.activeElement) || (chosen && !chosen.from && !chosen.nodeBox ? chosen : null);
    const group = focused && groupOf(focused);
    if (group && !near) fold(group, !isFolded(group));
  }
});
