// The drawing: shapes, what is chosen, and moving about. What moves only changes a transform; nothing is laid out anew.
const WIDEST = 300;
const stage = at("drawing"), world = at("world");
const view = { k: 1, x: 0, y: 0 };
// What is shown; boxes that fit the search; what is chosen (a box, an edge or an arrow); the box whose surroundings alone
// are shown; groups that are not folded, by their keys.
let shownBoxes = [], shownArrows = [], hits = [], chosen = null, near = null, open = new Set(), size = { width: 0, height: 0 };
// All that the filters let through, folded or not.
let fitting = { boxes: new Set(), edges: [] };

function draw(tag, attributes, ...children) {
  const node = document.createElementNS("http:" + "//www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

const pen = document.createElement("canvas").getContext("2d");
const family = getComputedStyle(document.body).fontFamily;
const fonts = { group: `600 17px ${family}`, label: `600 13px ${family}`, topic: `13px ${family}`, below: `11px ${family}` };
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
function measureBox(box) {
  if (box.shown !== undefined) return;
  const [label, wide] = fitted(box.node ? short(box.node) : box.label, box.name ? "topic" : box.node ? "label" : "group");
  const [below, wideBelow] = box.below && box.below !== box.label ? fitted(box.below, "below") : ["", 0];
  Object.assign(box, { shown: label, shownBelow: below, width: Math.ceil(Math.max(wide, wideBelow)) + (box.kind === "topic" || box.kind === "service" ? 22 : 34) });
}

// ---- shapes --------------------------------------------------------------------------------------------------------

function paint() {
  for (const box of [...nodes, ...names]) box.shape = null;
  at("lines").replaceChildren(...[...shownArrows.filter((arrow) => !arrow.mark), ...shownArrows.filter((arrow) => arrow.mark)].map(line));
  at("boxes").replaceChildren(...shownBoxes.map(shape));
  if (shownBoxes.length) [...shownBoxes].sort((a, b) => a.x - b.x || a.y - b.y)[0].shape.setAttribute("tabindex", "0");
}

const verb = (role) => ({ publisher: "publishes", subscriber: "subscribes to", server: "serves", client: "asks", "action server": "serves", "action client": "asks" }[role]);
const nameCount = (arrow) => (arrow.names.size === 1 ? [...arrow.names][0].label : counted(arrow.names.size, "name"));
function titleOf(arrow) {
  const { edge } = arrow;
  const text = edge ? `${edge.nodeBox.label} ${verb(edge.role)} ${edge.nameBox.label}` : `${arrow.from.label} → ${arrow.to.label}${arrow.from.name || arrow.to.name ? "" : `: ${nameCount(arrow)}`}`;
  return `${text}${arrow.mark ? ` (${arrow.mark}${edge?.why ? `: ${edge.why}` : ""})` : ""}${arrow.unsure ? " (not certain)" : ""}`;
}
const look = (one) => `${one.mark}${one.unsure ? " unsure" : ""}`;

function line(arrow) {
  const points = arrow.points.map((point) => [...point]);
  const tip = arrow.back ? points[0] : points.at(-1), way = arrow.back ? -1 : 1;
  const head = `M${tip[0]} ${tip[1]}l${-9 * way} -4.2v8.4z`;
  tip[0] -= 8 * way;
  let path = `M${points[0][0]} ${points[0][1]}`;
  for (let i = 1; i < points.length; i += 1) {
    const [x0, y0] = points[i - 1], [x1, y1] = points[i];
    const bend = (x1 - x0) / 2;
    path += i % 2 ? `C${x0 + bend} ${y0} ${x1 - bend} ${y1} ${x1} ${y1}` : `L${x1} ${y1}`;
  }
  const count = arrow.edge ? 1 : arrow.names.size;
  arrow.shape = draw("g", { class: `edge ${arrow.kind} ${look(arrow)}` },
    draw("title", null, titleOf(arrow)), draw("path", { class: "line", d: path }), draw("path", { class: "tip", d: head }), draw("path", { class: "reach", d: path }));
  if (count > 1) {
    arrow.shape.classList.add(count > 4 ? "thick" : "some");
    const [a, b] = points.slice(arrow.back ? -2 : 0).slice(0, 2);
    arrow.shape.append(draw("text", { class: "names", x: a[0] + (b[0] - a[0]) * 0.5, y: (a[1] + b[1]) / 2 - 3, "text-anchor": "middle" }, number(count)));
  }
  arrow.shape.addEventListener("click", () => choose(arrow.edge || arrow));
  return arrow.shape;
}

function shape(box) {
  const { width: w, height: h, kind } = box;
  const rect = (move, radius) => draw("rect", { class: "shape", x: -w / 2 + move, y: -h / 2 + move, width: w, height: h, rx: radius });
  const outline = kind === "action"
    ? [draw("path", { class: "shape", d: `M${-w / 2} 0L${-w / 2 + 11} ${-h / 2}H${w / 2 - 11}L${w / 2} 0L${w / 2 - 11} ${h / 2}H${-w / 2 + 11}Z` })]
    : kind === "group" ? [rect(4, 6), rect(0, 6)] : [rect(0, kind === "node" ? Math.min(20, h / 2) : 4)];
  const label = [draw("text", { "text-anchor": "middle", y: box.shownBelow ? -2 : 4.5 }, box.shown)];
  if (box.shownBelow) label.push(draw("text", { class: "type", "text-anchor": "middle", y: 12.5 }, box.shownBelow));
  box.shape = draw("g", {
    class: `box ${kind} ${look(box)}`, transform: `translate(${box.x} ${box.y})`, role: "button", tabindex: "-1",
    "aria-label": `${kind} ${box.label}${kind === "group" ? `, ${box.below}` : ""}${box.mark ? `, ${box.mark}` : ""}${box.unsure ? ", not certain" : ""}`,
  }, draw("title", null, [box.label, box.below].filter(Boolean).join("\n")), ...outline, ...label);
  box.shape.addEventListener("click", () => { choose(box); box.shape.focus({ preventScroll: true }); });
  box.shape.addEventListener("dblclick", () => { if (box.members) fold(box, false); });
  box.shape.addEventListener("focus", () => { rove(box); reveal(box); });
  box.shape.addEventListener("keydown", (event) => walk(event, box));
  return box.shape;
}

// ---- moving about --------------------------------------------------------------------------------------------------

const MAP = { width: 190, height: 124 };
const MARGIN = { side: 28, top: 24, bottom: 64 };
// Asked of the browser when it may have changed, not at every move.
let area = stage.getBoundingClientRect();

function move() {
  world.setAttribute("transform", `translate(${view.x} ${view.y}) scale(${view.k})`);
  stage.classList.toggle("far", view.k < 0.36);
  stage.classList.toggle("farther", view.k < 0.2);
  const part = at("map-part");
  at("map").classList.toggle("whole", view.x >= 0 && view.y >= 0 && view.x + size.width * view.k <= area.width && view.y + size.height * view.k <= area.height);
  for (const [name, value] of Object.entries({ x: -view.x / view.k, y: -view.y / view.k, width: area.width / view.k, height: area.height / view.k })) part.setAttribute(name, value);
}
function drawMap() {
  const wide = Math.max(size.width, size.height * MAP.width / MAP.height, 1), high = wide * MAP.height / MAP.width;
  at("map").setAttribute("viewBox", `${(size.width - wide) / 2} ${(size.height - high) / 2} ${wide} ${high}`);
  at("map-boxes").setAttribute("d", shownBoxes.map((box) => `M${box.x - box.width / 2} ${box.y - box.height / 2}h${box.width}v${box.height}h${-box.width}z`).join(""));
}
function zoom(factor, x, y) {
  const [px, py] = x === undefined ? [area.width / 2, area.height / 2] : [x - area.left, y - area.top];
  const k = Math.max(Math.min(0.03, whole()), Math.min(4, view.k * factor));
  view.x = px - (px - view.x) * k / view.k;
  view.y = py - (py - view.y) * k / view.k;
  view.k = k;
  move();
}
function pan(dx, dy) { view.x += dx; view.y += dy; move(); }
function whole() {
  return Math.min(1.25, (area.width - 2 * MARGIN.side) / Math.max(1, size.width), (area.height - MARGIN.top - MARGIN.bottom) / Math.max(1, size.height));
}
function fit() {
  view.k = whole();
  view.x = Math.max(MARGIN.side, (area.width - size.width * view.k) / 2);
  view.y = Math.max(MARGIN.top, (area.height - MARGIN.bottom + MARGIN.top - size.height * view.k) / 2);
  move();
}
function reveal(box, middle) {
  const x = view.x + box.x * view.k, y = view.y + box.y * view.k, w = box.width * view.k / 2 + 12, h = box.height * view.k / 2 + 12;
  const out = x - w < 0 || x + w > area.width || y - h < 0 || y + h > area.height;
  if (!out && !middle) return;
  if (middle && view.k < 0.5) view.k = 0.8;
  else if (!out) return;
  centre(box.x, box.y);
}
function centre(x, y) {
  view.x = area.width / 2 - x * view.k;
  view.y = area.height / 2 - y * view.k;
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
  dragged += Math.abs(dx) + Math.abs(dy);
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
  stage.classList.toggle("dragged", dragged > 4);
  if (other) {
    const before = Math.hypot(last[0] - other[0], last[1] - other[1]), now = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
    if (before) zoom(now / before, other[0], other[1]);
  } else pan(dx, dy);
});
for (const name of ["pointerup", "pointercancel"]) addEventListener(name, (event) => { fingers.delete(event.pointerId); stage.classList.remove("dragged"); });
stage.addEventListener("click", (event) => {
  if (dragged > 4) { event.stopPropagation(); event.preventDefault(); } else if (event.target === stage) choose(null);
}, true);
stage.addEventListener("dblclick", (event) => { if (event.target === stage) zoom(1.5, event.clientX, event.clientY); });

// On the map, the pointer says what stands in the middle.
function follow(event) {
  if (event.type === "pointermove" && !event.buttons) return;
  const spot = new DOMPoint(event.clientX, event.clientY).matrixTransform(at("map").getScreenCTM().inverse());
  centre(spot.x, spot.y);
}
at("map").addEventListener("pointerdown", (event) => { at("map").setPointerCapture(event.pointerId); follow(event); });
at("map").addEventListener("pointermove", follow);

const ARROWS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] };
// Whether a key was one that moves the drawing.
function moveByKey(event) {
  const way = ARROWS[event.key];
  if (!way || !(event.shiftKey || document.activeElement === at("map"))) return false;
  event.preventDefault();
  pan(-way[0] * area.width / 4, -way[1] * area.height / 4);
  return true;
}

// One box at a time is reached by the tab key; from it the arrows go on.
function rove(box) {
  for (const other of at("boxes").querySelectorAll('[tabindex="0"]')) other.setAttribute("tabindex", "-1");
  box.shape.setAttribute("tabindex", "0");
}
function walk(event, box) {
  if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(box); return; }
  const way = ARROWS[event.key];
  if (!way || event.shiftKey) return;
  event.preventDefault();
  const [far, down] = way;
  const beside = far
    ? shownArrows.filter((arrow) => arrow.from === box || arrow.to === box).map((arrow) => (arrow.from === box ? arrow.to : arrow.from)).filter((other) => (other.x - box.x) * far > 0)
    : shownBoxes.filter((other) => other !== box && Math.abs(other.x - box.x) < Math.max(2, box.width / 2) && (other.y - box.y) * down > 0);
  const [next] = beside.sort((a, b) => Math.abs(a.y - box.y) - Math.abs(b.y - box.y));
  if (next) next.shape.focus({ preventScroll: true });
}
