(() => {
  const graph = data;
  const KINDS = ["topic", "service", "action"];
  const MARKS = ["added", "removed", "changed"];
  const WIDEST = 300, BATCH = 100;
  const [NAME, DEFAULT, USES, PATH, LINE, MORE] = Array(6).keys();

  function draw(tag, attributes, ...children) {
    const node = document.createElementNS("http:" + "//www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
    node.append(...children);
    return node;
  }

  // The package stands below a node's name: it need not stand in it too.
  function short(node) {
    const label = node.label || node.id;
    const rest = label.startsWith(`${node.package}/`) ? label.slice(node.package.length + 1) : label;
    return rest.startsWith(`${node.package}::`) ? rest.slice(node.package.length + 2) : rest;
  }

  // Boxes are nodes and names alike; edges know their boxes, boxes their edges.
  const nodes = graph.nodes.map((node) => ({
    node, kind: "node", label: node.label || node.id, below: node.package, side: 0, mark: node.mark, packages: new Set([node.package]), edges: [],
    key: `node ${node.id}`, words: [node.id, node.label, node.name, node.package, node.executable, node.plugin, node.path],
  }));
  const names = graph.names.map((name) => ({
    name, kind: name.kind, label: name.name, side: 1, mark: name.mark, packages: new Set(), edges: [],
    below: [name.kind === "topic" ? "" : `${name.kind} `, name.types[0] || "type not known", name.types.length > 1 ? ` +${name.types.length - 1}` : ""].join(""),
    key: `${name.kind} ${name.name}`, words: [name.name, ...name.types],
  }));
  const boxes = [...nodes, ...names];
  const edges = graph.edges.map((edge) => ({ ...edge, kind: names[edge.name].kind, nodeBox: edge.node < 0 ? null : nodes[edge.node], nameBox: names[edge.name] }));
  for (const edge of edges) {
    edge.nameBox.edges.push(edge);
    if (!edge.nodeBox) continue;
    edge.nodeBox.edges.push(edge);
    edge.nameBox.packages.add(edge.nodeBox.node.package);
  }
  const lone = (box) => !box.edges.some((edge) => edge.nodeBox);
  for (const box of boxes) box.haystack = box.words.join("\n").toLowerCase();

  const pen = document.createElement("canvas").getContext("2d");
  const family = getComputedStyle(document.body).fontFamily;
  const fonts = { label: `600 13px ${family}`, topic: `13px ${family}`, below: `11px ${family}` };
  // The text as far as it has room; of names the end says most, so what is left out is left out of the middle.
  function fitted(text, font) {
    pen.font = fonts[font];
    let kept = Array.from(text.slice(0, 300).replace(/\s+/g, " "));
    let shown = kept.join("") + (text.length > 300 ? "…" : "");
    while (kept.length > 6 && pen.measureText(shown).width > WIDEST) {
      kept.splice(Math.floor(kept.length * 0.45), Math.max(1, Math.floor(kept.length / 30)));
      const cut = Math.floor(kept.length * 0.45);
      shown = [...kept.slice(0, cut), "…", ...kept.slice(cut)].join("");
    }
    return [shown, pen.measureText(shown).width];
  }
  for (const box of boxes) {
    const [label, wide] = fitted(box.node ? short(box.node) : box.label, box.kind === "node" ? "label" : "topic");
    const [below, wideBelow] = box.below && box.below !== box.label ? fitted(box.below, "below") : ["", 0];
    Object.assign(box, { shown: label, shownBelow: below, width: Math.ceil(Math.max(wide, wideBelow)) + (box.kind === "topic" || box.kind === "service" ? 22 : 34) });
  }

  // ---- what is shown -----------------------------------------------------------------------------------------------

  let chosen = null, shownBoxes = [], shownEdges = [], hits = [], near = null, size = { width: 0, height: 0 };
  const view = { k: 1, x: 0, y: 0 };
  const stage = at("drawing"), world = at("world");

  function visible() {
    const kinds = new Set(KINDS.filter((kind) => at(kind).checked));
    const where = at("package").value;
    let kept = edges.filter((edge) => edge.nodeBox && kinds.has(edge.kind)
      && (where === "" || where === `=${edge.nodeBox.node.package}`)
      && (!at("changed").checked || edge.mark));
    if (near) {
      const close = new Set([near]);
      for (let step = 0; step < 2; step += 1) {
        for (const edge of kept.filter((one) => close.has(one.nodeBox) || close.has(one.nameBox))) { close.add(edge.nodeBox); close.add(edge.nameBox); }
      }
      kept = kept.filter((edge) => close.has(edge.nodeBox) && close.has(edge.nameBox));
    }
    const used = new Set(kept.flatMap((edge) => [edge.nodeBox, edge.nameBox]));
    if (near) used.add(near);
    const fits = (box) => used.has(box) || (at("alone").checked && !near && lone(box)
      && (box.kind === "node" || kinds.has(box.kind)) && (where === "" || box.packages.has(where.slice(1))) && (!at("changed").checked || box.mark));
    return [boxes.filter(fits), kept];
  }

  function update() {
    [shownBoxes, shownEdges] = visible();
    const place = new Map(shownBoxes.map((box, index) => [box, index]));
    for (const box of boxes) box.shape = null;
    for (const box of shownBoxes) {
      const ways = shownEdges.length > 4 ? box.edges.filter((edge) => place.has(edge.nodeBox) && place.has(edge.nameBox)).length : 0;
      box.height = Math.max(box.shownBelow ? 40 : 28, Math.min(130, 14 + ways * 4));
    }
    const links = shownEdges.map((edge) => {
      const ends = [place.get(edge.nodeBox), place.get(edge.nameBox)];
      return Object.assign(edge, { from: ends[edge.outward ? 0 : 1], to: ends[edge.outward ? 1 : 0] });
    });
    const area = stage.getBoundingClientRect();
    size = layered(shownBoxes, links, Math.max(0.5, Math.min(3, area.width / Math.max(1, area.height))));
    paint();
    at("empty").hidden = shownBoxes.length > 0;
    if (chosen && !(chosen.nodeBox ? shownEdges : shownBoxes).includes(chosen)) chosen = null;
    start();
    search();
    show();
  }

  function paint() {
    at("lines").replaceChildren(...[...shownEdges.filter((edge) => !edge.mark), ...shownEdges.filter((edge) => edge.mark)].map(line));
    at("boxes").replaceChildren(...shownBoxes.map(shape));
    if (shownBoxes.length) [...shownBoxes].sort((a, b) => a.x - b.x || a.y - b.y)[0].shape.setAttribute("tabindex", "0");
  }

  function line(edge) {
    const points = edge.points.map((point) => [...point]);
    const tip = edge.back ? points[0] : points.at(-1), way = edge.back ? -1 : 1;
    const arrow = `M${tip[0]} ${tip[1]}l${-9 * way} -4.2v8.4z`;
    tip[0] -= 8 * way;
    let path = `M${points[0][0]} ${points[0][1]}`;
    for (let i = 1; i < points.length; i += 1) {
      const [x0, y0] = points[i - 1], [x1, y1] = points[i];
      const bend = (x1 - x0) / 2;
      path += i % 2 ? `C${x0 + bend} ${y0} ${x1 - bend} ${y1} ${x1} ${y1}` : `L${x1} ${y1}`;
    }
    const title = `${edge.nodeBox.label} ${verb(edge.role)} ${edge.nameBox.label}${edge.mark ? ` (${edge.mark}${edge.why ? `: ${edge.why}` : ""})` : ""}`;
    edge.shape = draw("g", { class: `edge ${edge.kind} ${edge.mark}` },
      draw("title", null, title), draw("path", { class: "line", d: path }), draw("path", { class: "tip", d: arrow }), draw("path", { class: "reach", d: path }));
    edge.shape.addEventListener("click", () => choose(edge));
    return edge.shape;
  }

  function shape(box) {
    const { width: w, height: h, kind } = box;
    const outline = kind === "action"
      ? draw("path", { class: "shape", d: `M${-w / 2} 0L${-w / 2 + 11} ${-h / 2}H${w / 2 - 11}L${w / 2} 0L${w / 2 - 11} ${h / 2}H${-w / 2 + 11}Z` })
      : draw("rect", { class: "shape", x: -w / 2, y: -h / 2, width: w, height: h, rx: kind === "node" ? Math.min(20, h / 2) : 4 });
    const label = [draw("text", { "text-anchor": "middle", y: box.shownBelow ? -2 : 4.5 }, box.shown)];
    if (box.shownBelow) label.push(draw("text", { class: "type", "text-anchor": "middle", y: 12.5 }, box.shownBelow));
    box.shape = draw("g", {
      class: `box ${kind} ${box.mark}`, transform: `translate(${box.x} ${box.y})`, role: "button", tabindex: "-1",
      "aria-label": `${kind} ${box.label}${box.mark ? `, ${box.mark}` : ""}`,
    }, draw("title", null, [box.label, box.below].filter(Boolean).join("\n")), outline, ...label);
    box.shape.addEventListener("click", () => { choose(box); box.shape.focus({ preventScroll: true }); });
    box.shape.addEventListener("focus", () => { rove(box); reveal(box); });
    box.shape.addEventListener("keydown", (event) => walk(event, box));
    return box.shape;
  }

  // ---- moving about ------------------------------------------------------------------------------------------------

  function move() {
    world.setAttribute("transform", `translate(${view.x} ${view.y}) scale(${view.k})`);
    stage.classList.toggle("far", view.k < 0.36);
    stage.classList.toggle("farther", view.k < 0.2);
  }
  function zoom(factor, x, y) {
    const area = stage.getBoundingClientRect();
    const [px, py] = x === undefined ? [area.width / 2, area.height / 2] : [x - area.left, y - area.top];
    const k = Math.max(0.03, Math.min(4, view.k * factor));
    view.x = px - (px - view.x) * k / view.k;
    view.y = py - (py - view.y) * k / view.k;
    view.k = k;
    move();
  }
  const MARGIN = { side: 28, top: 24, bottom: 64 };
  function whole() {
    const area = stage.getBoundingClientRect();
    return Math.min(1.25, (area.width - 2 * MARGIN.side) / Math.max(1, size.width), (area.height - MARGIN.top - MARGIN.bottom) / Math.max(1, size.height));
  }
  function fit(k) {
    const area = stage.getBoundingClientRect();
    view.k = Math.max(0.03, k);
    view.x = Math.max(MARGIN.side, (area.width - size.width * view.k) / 2);
    view.y = Math.max(MARGIN.top, (area.height - MARGIN.bottom + MARGIN.top - size.height * view.k) / 2);
    move();
  }
  // Where the whole would be too small to read, it begins readable.
  function start() { fit(whole() >= 0.4 ? whole() : 0.6); }
  function reveal(box, middle) {
    const area = stage.getBoundingClientRect();
    const x = view.x + box.x * view.k, y = view.y + box.y * view.k, w = box.width * view.k / 2 + 12, h = box.height * view.k / 2 + 12;
    const out = x - w < 0 || x + w > area.width || y - h < 0 || y + h > area.height;
    if (!out && !middle) return;
    if (middle && view.k < 0.5) view.k = 0.8;
    else if (!out) return;
    view.x = area.width / 2 - box.x * view.k;
    view.y = area.height / 2 - box.y * view.k;
    move();
  }

  const fingers = new Map();
  let dragged = 0;
  stage.addEventListener("wheel", (event) => { event.preventDefault(); zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0016)), event.clientX, event.clientY); }, { passive: false });
  stage.addEventListener("pointerdown", (event) => { fingers.set(event.pointerId, [event.clientX, event.clientY]); dragged = 0; });
  addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const before = Math.hypot(last[0] - other[0], last[1] - other[1]), now = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
      if (before) zoom(now / before, other[0], other[1]);
    } else { view.x += dx; view.y += dy; }
    dragged += Math.abs(dx) + Math.abs(dy);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    stage.classList.toggle("dragged", dragged > 4);
    move();
  });
  for (const name of ["pointerup", "pointercancel"]) addEventListener(name, (event) => { fingers.delete(event.pointerId); stage.classList.remove("dragged"); });
  stage.addEventListener("click", (event) => {
    if (dragged > 4) { event.stopPropagation(); event.preventDefault(); } else if (event.target === stage) choose(null);
  }, true);
  stage.addEventListener("dblclick", (event) => { if (event.target === stage) zoom(1.5, event.clientX, event.clientY); });

  // One box at a time is reached by the tab key; from it the arrows go on.
  function rove(box) {
    for (const other of at("boxes").querySelectorAll('[tabindex="0"]')) other.setAttribute("tabindex", "-1");
    box.shape.setAttribute("tabindex", "0");
  }
  function walk(event, box) {
    const far = { ArrowRight: 1, ArrowLeft: -1 }[event.key], down = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(box); return; }
    if (!far && !down) return;
    event.preventDefault();
    const beside = far
      ? shownEdges.filter((edge) => edge.nodeBox === box || edge.nameBox === box).map((edge) => (edge.nodeBox === box ? edge.nameBox : edge.nodeBox)).filter((other) => (other.x - box.x) * far > 0)
      : shownBoxes.filter((other) => other !== box && Math.abs(other.x - box.x) < Math.max(2, box.width / 2) && (other.y - box.y) * down > 0);
    const [next] = beside.sort((a, b) => Math.abs(a.y - box.y) - Math.abs(b.y - box.y));
    if (next) next.shape.focus({ preventScroll: true });
  }

  // ---- choosing and searching --------------------------------------------------------------------------------------

  function choose(what) {
    chosen = what;
    if (what && !(what.nodeBox ? shownEdges : shownBoxes).includes(what)) {
      const wanted = what;
      near = null;
      for (const id of FIELDS) at(id).value = "";
      for (const id of BOXES) at(id).checked = at(id).defaultChecked;
      if (!wanted.nodeBox && lone(wanted)) at("alone").checked = true;
      update();
      chosen = wanted;
    }
    show();
    at("panel").scrollTop = 0;
  }
  function go(box) { choose(box); if (box.shape) { reveal(box, true); rove(box); } }

  function show() {
    const on = new Set(), far = new Set();
    if (chosen?.nodeBox) [chosen, chosen.nodeBox, chosen.nameBox].forEach((one) => on.add(one));
    else if (chosen) {
      on.add(chosen);
      for (const edge of shownEdges) if (edge.nodeBox === chosen || edge.nameBox === chosen) [edge, edge.nodeBox, edge.nameBox].forEach((one) => on.add(one));
      if (chosen.kind === "node") {
        // Those at the other ends of what a node says and hears, less strongly.
        const said = new Map(shownEdges.filter((edge) => edge.nodeBox === chosen).map((edge) => [edge.nameBox, edge.outward]));
        for (const edge of shownEdges) if (!on.has(edge) && said.has(edge.nameBox) && said.get(edge.nameBox) !== edge.outward) [edge, edge.nodeBox].forEach((one) => { if (!on.has(one)) far.add(one); });
      }
    } else hits.forEach((box) => on.add(box));
    stage.classList.toggle("dim", on.size > 0);
    const found = new Set(hits);
    for (const one of [...shownBoxes, ...shownEdges]) {
      const list = one.shape.classList;
      list.toggle("on", on.has(one) || far.has(one) || (Boolean(chosen) && found.has(one)));
      list.toggle("near", far.has(one));
      list.toggle("chosen", one === chosen);
      list.toggle("hit", found.has(one));
    }
    at("panel").replaceChildren(...(chosen?.nodeBox ? edgePanel(chosen) : chosen?.kind === "node" ? nodePanel(chosen) : chosen ? namePanel(chosen) : summary()));
    keep();
  }

  function search() {
    const words = at("search").value.toLowerCase().split(/\s+/).filter(Boolean);
    hits = words.length ? shownBoxes.filter((box) => words.every((word) => box.haystack.includes(word))) : [];
    at("count").textContent = words.length ? (hits.length ? `${number(hits.length)} found` : "nothing found") : "";
  }
  function nextHit(step) {
    if (!hits.length) return;
    const position = hits.indexOf(chosen);
    go(hits[(position + step + hits.length + (position < 0 && step < 0 ? 1 : 0)) % hits.length]);
  }

  // ---- the panel ---------------------------------------------------------------------------------------------------

  const verb = (role) => ({ publisher: "publishes", subscriber: "subscribes to", server: "serves", client: "asks", "action server": "serves", "action client": "asks" }[role]);
  const place = (path, row) => make("span", { class: "place" }, path ? (row ? `${path}:${row}` : path) : "");
  const code = (text) => make("code", null, text);
  const marked = (mark, why) => (mark ? make("span", { class: `mark ${mark}` }, why ? `${mark}: ${why}` : mark) : "");
  function button(text, act, attributes) {
    const node = make("button", { type: "button", ...attributes }, text);
    node.addEventListener("click", act);
    return node;
  }
  const link = (box) => button(box.label, () => go(box), { class: "go", title: box.key });

  // A heading and a list, the rest of which comes when asked for.
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

  function head(title, mark, facts, box) {
    const tools = box ? [make("div", { class: "tools" },
      near === box ? button("Show all again", () => { near = null; update(); }) : button("Only what is near", () => { near = box; update(); go(box); }))] : [];
    return [button("×", () => choose(null), { class: "close", "aria-label": "close (escape)" }), make("h2", null, title),
      mark ? make("p", null, mark) : "", ...facts.filter(Boolean).map((fact) => (fact instanceof Node ? fact : make("p", { class: "soft" }, fact))), ...tools].filter(Boolean);
  }

  function quality(qos) {
    if (!qos) return null;
    const said = [qos.reliability, qos.durability, qos.history, qos.depth !== undefined && qos.depth >= 0 ? `depth ${qos.depth}` : "",
      qos.deadline !== undefined && qos.deadline !== null ? `deadline ${qos.deadline} s` : "", qos.liveliness, qos.lease !== undefined && qos.lease !== null ? `lease ${qos.lease} s` : ""].filter(Boolean);
    const written = qos.written ? code(qos.written) : "";
    return said.length || written ? make("p", null, `QoS ${said.join(", ")} `, written) : null;
  }

  const HOW = { default: "the name is a parameter's default", launch: "the name is set by the launch file", given: "the name is fixed by the framework" };
  function made(end) {
    const lines = [place(end.path, end.line)];
    if (end.written || HOW[end.how]) lines.push(make("p", { class: "soft" }, end.written ? code(end.written) : "", HOW[end.how] ? ` ${HOW[end.how]}` : ""));
    const qos = quality(end.qos);
    if (qos) lines.push(qos);
    if (end.callback) lines.push(make("p", null, "callback ", code(end.callback.name), " ", place(end.callback.path, end.callback.line)));
    return make("li", null, lines);
  }
  function published(one) {
    const ways = one.ways.map(([trigger, guards]) => make("li", null,
      trigger ? make("p", null, `on ${trigger}`) : "",
      guards.map(([text, path, row]) => make("p", null, "when ", code(text), " ", place(path, row)))));
    const list = make("ul", null, ways);
    const shown = one.ways.length > 2 ? make("details", null, make("summary", null, counted(one.ways.length + one.more, "way")), list) : list;
    return make("li", null, "publish ", one.expression ? code(one.expression) : "", one.function ? make("span", { class: "soft" }, ` in ${one.function}`) : "",
      place(one.path, one.line), shown, one.more ? make("p", { class: "soft" }, `and ${counted(one.more, "more way")}`) : "");
  }
  function details(said) {
    return make("ul", null, said.at.map(made), said.publishes.map(published));
  }
  function was(edge) {
    if (!edge.before) return "";
    return make("details", { class: "before" }, make("summary", null, `before (${graph.base})`), edge.before.types.length ? make("p", null, edge.before.types.join(" or ")) : "", details(edge.before));
  }
  // One end of an edge, seen from the other.
  const entry = (from) => (edge) => make("li", null,
    from === edge.nameBox ? (edge.nodeBox ? link(edge.nodeBox) : make("span", { class: "soft" }, "(no node is known to run it)")) : link(edge.nameBox), " ", marked(edge.mark, edge.why),
    edge.types.length && (from !== edge.nameBox || edge.nameBox.name.types.length > 1) ? make("p", { class: "soft" }, edge.types.join(" or ")) : "", details(edge), was(edge));

  const SECTIONS = [["publisher", "Publishes", "Publishers"], ["subscriber", "Subscribes", "Subscribers"], ["server", "Serves", "Servers"],
    ["client", "Asks", "Clients"], ["action server", "Serves actions", "Action servers"], ["action client", "Asks for actions", "Action clients"]];
  const byRole = (box, column) => SECTIONS.flatMap((row) => section(row[column], box.edges.filter((edge) => edge.role === row[0]), entry(box)));

  function nodePanel(box) {
    const { node } = box;
    const facts = [[node.kind, node.language, node.package && `package ${node.package}`].filter(Boolean).join(", "),
      node.executable && `executable ${node.executable}`, node.plugin && `class ${node.plugin}`, node.id !== node.label && node.id, node.path && place(node.path, node.line)];
    if (node.started) facts.push(make("p", { class: "soft" }, "started by ", make("span", { class: "place" }, node.started)));
    return [...head(box.label, marked(box.mark), facts, box), ...byRole(box, 1),
      ...section("Timers", node.timers, (timer) => make("li", null, timer.period ? code(timer.period) : "", timer.callback ? ` ${timer.callback.name}` : "", place(timer.path, timer.line))),
      ...section("Parameters", node.parameters, (one) => make("li", null, code(one[NAME]), one[DEFAULT] ? make("span", { class: "soft" }, " = ", code(one[DEFAULT])) : "", ` ${one[USES]}`,
        make("p", null, place(one[PATH], one[LINE]), one[MORE] ? make("span", { class: "soft" }, ` and ${counted(one[MORE], "more place")}`) : ""))),
      ...section("Under a name that is not known", node.unnamed, (one) => make("li", null, `${one.role} `, one.written ? code(one.written) : "", make("p", { class: "soft" }, withCode([one.type, one.why].filter(Boolean).join(": "))), place(one.path, one.line)))];
  }
  function namePanel(box) {
    const types = box.name.types.length ? box.name.types.join(" or ") : "type not known";
    return [...head(box.label, marked(box.mark), [`${box.kind}, ${types}`], box), ...byRole(box, 2)];
  }
  function edgePanel(edge) {
    const title = make("span", null, link(edge.nodeBox), ` ${verb(edge.role)} `, link(edge.nameBox));
    return [...head(title, marked(edge.mark, edge.why), [`${edge.kind}, ${edge.types.join(" or ") || "type not known"}`]), make("h3", null, "Where"), details(edge), was(edge)];
  }

  function summary() {
    const { coverage } = graph;
    const share = coverage.calls ? ` (${Math.round(100 * coverage.resolved / coverage.calls)} %)` : "";
    const changes = edges.filter((edge) => edge.mark);
    return [make("h2", null, graph.root && graph.root !== "." ? graph.root : "Message flow"),
      make("p", { class: "soft" }, "Click a node, a topic or an arrow to see where it is written. Drag to move, turn the wheel to zoom; tab and the arrow keys walk along the graph, enter opens, escape closes."),
      make("h3", null, "Coverage"),
      make("p", null, `${number(coverage.resolved)} of ${counted(coverage.calls, "API call")} resolved${share}${coverage.by_default ? `, ${number(coverage.by_default)} by a parameter's default` : ""}; ${counted(coverage.files, "file")} read.`),
      graph.hidden ? make("p", { class: "soft" }, `${number(graph.hidden)} names that most nodes have are hidden; --all shows them.`) : "",
      ...(graph.base === null ? [] : changes.length ? section(`Changes since ${graph.base}`, changes, (edge) => make("li", null, marked(edge.mark, edge.why), " ",
        edge.nodeBox ? button(`${edge.nodeBox.label} ${verb(edge.role)} ${edge.nameBox.label}`, () => { choose(edge); if (edge.shape) reveal(edge.nodeBox, true); }, { class: "go" }) : link(edge.nameBox),
        place(edge.at[0]?.path, edge.at[0]?.line))) : [make("h3", null, "Changes"), make("p", null, `None since ${graph.base}.`)]),
      ...section("Not resolved", coverage.unresolved, (one) => make("li", null, `${one.what} `, one.written ? code(one.written) : "", make("p", { class: "soft" }, withCode(one.reason)), place(one.path, one.line))),
      ...section("Read in part", coverage.unread, (path) => make("li", null, place(path))),
      make("p", { class: "soft" }, `rosimpact ${graph.version}, ROS ${graph.ros}`)].filter(Boolean);
  }

  // ---- controls ----------------------------------------------------------------------------------------------------

  function legend() {
    const sample = (kind, mark, text) => make("li", null, draw("svg", { width: 26, height: 14, viewBox: "-13 -7 26 14", "aria-hidden": "true" },
      kind === "line" ? draw("g", { class: `edge ${mark}` }, draw("path", { class: "line", d: "M-12 0H5" }), draw("path", { class: "tip", d: "M12 0l-9 -4.2v8.4z" }))
        : draw("g", { class: `box ${kind}` }, kind === "action" ? draw("path", { class: "shape", d: "M-12 0L-7 -5.5H7L12 0L7 5.5H-7Z" })
          : draw("rect", { class: "shape", x: -12, y: -5.5, width: 24, height: 11, rx: kind === "node" ? 5.5 : 2 }))), text);
    const present = ["node", ...KINDS.filter((kind) => names.some((box) => box.kind === kind))];
    at("legend").append(...present.map((kind) => sample(kind, "", kind)));
    if (graph.base !== null) at("legend").append(...MARKS.map((mark) => sample("line", mark, mark)));
  }

  const FIELDS = ["search", "package"], BOXES = [...KINDS, "changed", "alone"];
  function keep() {
    const shown = chosen && (chosen.nodeBox ? `${chosen.nodeBox.key} ${chosen.role} ${chosen.nameBox.key}` : chosen.key);
    remember(FIELDS, BOXES, { show: shown, near: near?.key });
  }
  function comeBack() {
    const state = recall(FIELDS, BOXES);
    near = boxes.find((box) => box.key === state.get("near")) || null;
    const wanted = state.get("show");
    chosen = !wanted ? null : boxes.find((box) => box.key === wanted) || edges.find((edge) => edge.nodeBox && `${edge.nodeBox.key} ${edge.role} ${edge.nameBox.key}` === wanted) || null;
  }

  at("root").textContent = graph.root === "." ? "" : graph.root.split("/").filter(Boolean).slice(-2).join("/");
  at("root").title = graph.root;
  at("facts").textContent = [counted(nodes.length, "node"), ...KINDS.map((kind) => [kind, names.filter((box) => box.kind === kind).length]).filter(([, count]) => count).map(([kind, count]) => counted(count, kind)),
    ...(graph.rev ? [`at ${graph.rev.slice(0, 12)}`] : []), ...(graph.base !== null ? [`against ${graph.base}`] : [])].join(" · ");
  at("package").append(make("option", { value: "" }, "every package"));
  const tally = new Map();
  for (const box of nodes) tally.set(box.node.package, (tally.get(box.node.package) || 0) + 1);
  for (const [name, count] of [...tally].sort((a, b) => (a[0] < b[0] ? -1 : 1))) at("package").append(make("option", { value: `=${name}` }, `${name || "no package"} (${number(count)})`));
  for (const kind of KINDS) {
    const count = names.filter((box) => box.kind === kind).length;
    at(kind).nextElementSibling.textContent = counted(count, kind);
    at(kind).parentElement.hidden = !count;
  }
  const loners = boxes.filter(lone).length;
  at("alone").nextElementSibling.textContent = `${number(loners)} unconnected`;
  at("alone").parentElement.hidden = !loners;
  at("alone").defaultChecked = at("alone").checked = loners > 0 && !edges.some((edge) => edge.nodeBox);
  at("changed-label").hidden = graph.base === null;
  legend();
  comeBack();
  update();
  if (chosen) reveal(chosen.nodeBox || chosen);
  performance.mark("rosimpact graph drawn");

  at("filters").addEventListener("input", (event) => { if (event.target === at("search")) { chosen = null; search(); show(); } else update(); });
  at("filters").addEventListener("submit", (event) => event.preventDefault());
  at("filters").addEventListener("reset", () => setTimeout(() => { near = null; chosen = null; update(); }));
  at("search").addEventListener("keydown", (event) => {
    if (event.key === "Enter") { event.preventDefault(); nextHit(event.shiftKey ? -1 : 1); }
  });
  at("in").addEventListener("click", () => zoom(1.3));
  at("out").addEventListener("click", () => zoom(1 / 1.3));
  at("fit").addEventListener("click", () => fit(whole()));
  // On paper the whole is shown, as large as the sheet allows.
  addEventListener("beforeprint", () => {
    stage.setAttribute("viewBox", `-10 -10 ${size.width + 20} ${size.height + 20}`);
    stage.classList.remove("far", "farther");
    world.removeAttribute("transform");
  });
  addEventListener("afterprint", () => { stage.removeAttribute("viewBox"); move(); });
  addEventListener("hashchange", () => { comeBack(); update(); });
  addEventListener("resize", () => { if (!chosen && !hits.length) start(); });
  addEventListener("keydown", (event) => {
    if (event.key === "Escape") {
      const last = chosen && !chosen.nodeBox ? chosen : null;
      if (chosen) choose(null);
      else if (at("search").value) { at("search").value = ""; search(); show(); } else if (near) { near = null; update(); }
      if (last?.shape && document.activeElement !== at("search")) last.shape.focus({ preventScroll: true });
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(document.activeElement.tagName)) return;
    if (event.key === "+" || event.key === "=") zoom(1.3);
    if (event.key === "-") zoom(1 / 1.3);
    if (event.key === "0") fit(whole());
  });
})();
