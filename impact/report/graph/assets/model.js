// What there is to show: boxes for nodes, names and folded groups, and which arrows stand between those that are shown.
const graph = data;
const KINDS = ["topic", "service", "action"];
const MARKS = ["added", "removed", "changed"];
// More boxes than a person takes in at once: the graph is shown folded at first.
const MANY = 150;

// The package stands below a node's name: it need not stand in it too.
function short(node) {
  const label = node.label || node.id;
  const rest = label.startsWith(`${node.package}/`) ? label.slice(node.package.length + 1) : label;
  return rest.startsWith(`${node.package}::`) ? rest.slice(node.package.length + 2) : rest;
}

// Edges (a node uses a name in a role) know their boxes, boxes their edges.
const nodes = graph.nodes.map((node) => ({
  node, kind: "node", label: node.label || node.id, below: node.package, side: 0, mark: node.mark, unsure: node.uncertain.length > 0, edges: [],
  key: `node ${node.id}`, words: [node.id, node.label, node.name, node.package, node.executable, node.plugin, node.path, ...node.launches],
}));
const names = graph.names.map((name) => ({
  name, kind: name.kind, label: name.name, side: 1, mark: name.mark, unsure: name.open, edges: [],
  below: [name.kind === "topic" ? "" : `${name.kind} `, name.types[0] || "type not known", name.types.length > 1 ? ` +${name.types.length - 1}` : ""].join(""),
  key: `${name.kind} ${name.name}`, words: [name.name, ...name.types],
}));
const edges = graph.edges.map((edge) => ({
  ...edge, kind: names[edge.name].kind, nodeBox: edge.node < 0 ? null : nodes[edge.node], nameBox: names[edge.name],
  // Not certain where each place that makes it rests on what may be otherwise.
  unsure: edge.at.length > 0 && edge.at.every((end) => end.how === "default" || end.how === "partly" || end.only_if),
}));
for (const edge of edges) {
  edge.nameBox.edges.push(edge);
  if (edge.nodeBox) edge.nodeBox.edges.push(edge);
}
for (const box of names) if (box.edges.length && box.edges.every((edge) => edge.unsure)) box.unsure = true;
for (const box of [...nodes, ...names]) box.haystack = box.words.join("\n").toLowerCase();
const lone = (box) => !box.edges.some((edge) => edge.nodeBox);
const launches = [...new Set(nodes.flatMap((box) => box.node.launches))].sort();

// ---- groups --------------------------------------------------------------------------------------------------------

const GROUPINGS = { package: (node) => node.package || "(no package)", namespace: (node) => node.name.slice(0, node.name.lastIndexOf("/")) || "/" };
const groups = Object.fromEntries(Object.entries(GROUPINGS).map(([how, find]) => [how, groupNodes(how, find)]));

// Boxes of groups, each node's by its place. A group of one node is the node itself.
function groupNodes(how, find) {
  const found = new Map();
  for (const box of nodes) {
    const name = find(box.node);
    if (!found.has(name)) found.set(name, { group: how, kind: "group", label: name, side: 0, mark: "", unsure: false, key: `group ${how} ${name}`, members: [], edges: [] });
    found.get(name).members.push(box);
  }
  const real = [...found.values()].filter((group) => group.members.length > 1).sort((a, b) => (a.label < b.label ? -1 : 1));
  for (const group of real) {
    group.edges = group.members.flatMap((box) => box.edges);
    group.mark = group.edges.some((edge) => edge.mark) ? "changed" : "";
  }
  return { list: real, of: new Map(real.flatMap((group) => group.members.map((box) => [box, group]))) };
}

// How a graph of many boxes is grouped at first: by namespaces where these divide it, else by packages.
function firstGrouping() {
  if (nodes.length + names.filter((box) => !box.name.standard).length <= MANY) return "none";
  const divides = ({ list }) => list.length > 1 && Math.max(...list.map((group) => group.members.length)) < nodes.length * 0.6;
  return ["namespace", "package"].find((how) => divides(groups[how])) || "none";
}

// ---- what is shown -------------------------------------------------------------------------------------------------

// Edges that fit the filters. asked: kinds (a set), package and launch (as the selects have them), changed, ends,
// standard (whether these are shown).
function select(asked) {
  const fitting = edges.filter((edge) => edge.nodeBox && asked.kinds.has(edge.kind) && (asked.standard || !edge.nameBox.name.standard)
    && startedBy(edge.nodeBox.node, asked.launch));
  const ends = asked.ends ? new Set() : deadEnds(fitting);
  return fitting.filter((edge) => !ends.has(edge.nameBox)
    && (!asked.package || asked.package === `=${edge.nodeBox.node.package}`) && (!asked.changed || edge.mark));
}

// launch: `=` and a launch file, `=` alone for nodes that none of them starts; empty for all nodes.
const startedBy = (node, launch) => !launch || (launch === "=" ? !node.launches.length : node.launches.includes(launch.slice(1)));

// Names that have one side only among some edges: nobody hears what is said there, or nobody says what is heard.
function deadEnds(some) {
  const sides = new Map();
  for (const edge of some) {
    if (edge.mark === "removed" && edge.nameBox.mark !== "removed") continue;
    sides.set(edge.nameBox, (sides.get(edge.nameBox) || 0) | (edge.outward ? 1 : 2));
  }
  return new Set([...sides].filter(([, both]) => both !== 3).map(([box]) => box));
}

// Edges within two steps of a box.
function nearby(box, some) {
  const close = new Set([box]);
  for (let step = 0; step < 2; step += 1) {
    for (const edge of some.filter((one) => close.has(one.nodeBox) || close.has(one.nameBox))) { close.add(edge.nodeBox); close.add(edge.nameBox); }
  }
  return some.filter((edge) => close.has(edge.nodeBox) && close.has(edge.nameBox));
}

// The boxes and arrows that stand for some edges. view: `both`, `nodes` or `topics`; stand: gives the box that stands for
// a node, its own or that of its folded group. A name that folded groups alone use is an arrow between these. An arrow
// has from, to, kind, mark, unsure, edges, names, and `edge` where it is nothing but one.
function project(some, view, stand) {
  const arrows = new Map(), shown = new Set(), byName = new Map();
  const add = (from, to, parts, unsure, kind, alone) => {
    const key = alone ? `${from.key} ${alone.role} ${to.key}` : `${from.key} > ${to.key}`;
    if (!arrows.has(key)) arrows.set(key, { key, from, to, kind, mark: parts[0].mark, unsure: true, edges: new Set(), names: new Set(), through: new Set(), edge: alone || null });
    const arrow = arrows.get(key);
    for (const part of parts) {
      arrow.edges.add(part);
      arrow.names.add(part.nameBox);
      arrow.through.add(part.nodeBox);
      if (part.mark !== arrow.mark) arrow.mark = "changed";
    }
    if (arrow.edge !== alone) arrow.edge = null;
    if (kind === "topic") arrow.kind = kind;
    arrow.unsure &&= unsure;
  };
  const pairs = (list, from, to) => {
    const out = list.filter((edge) => edge.outward), inn = list.filter((edge) => !edge.outward);
    for (const a of out) for (const b of inn) if (a.kind === b.kind && from(a, b) !== to(a, b)) add(from(a, b), to(a, b), [a, b], a.unsure || b.unsure, a.kind, null);
  };
  for (const edge of some) {
    const centre = view === "topics" ? edge.nodeBox : edge.nameBox;
    if (!byName.has(centre)) byName.set(centre, []);
    byName.get(centre).push(edge);
    shown.add(view === "topics" ? edge.nameBox : stand(edge.nodeBox));
  }
  for (const [centre, list] of byName) {
    if (view === "topics") { pairs(list, (a, b) => b.nameBox, (a) => a.nameBox); continue; }
    if (view === "nodes" || list.every((edge) => stand(edge.nodeBox) !== edge.nodeBox)) { pairs(list, (a) => stand(a.nodeBox), (a, b) => stand(b.nodeBox)); continue; }
    shown.add(centre);
    for (const edge of list) {
      const box = stand(edge.nodeBox), ends = edge.outward ? [box, centre] : [centre, box];
      add(...ends, [edge], edge.unsure, edge.kind, box === edge.nodeBox ? edge : null);
    }
  }
  return [shown, [...arrows.values()]];
}
