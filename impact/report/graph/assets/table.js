// The table of topics, services and actions that the filters let through.
const COLUMNS = [
  ["name", "Name", (row) => row.box.label],
  ["kind", "Kind", (row) => row.box.kind],
  ["types", "Types", (row) => row.box.name.types.join(", ")],
  ["senders", "Publishers, clients", (row) => row.senders.length],
  ["receivers", "Subscribers, servers", (row) => row.receivers.length],
  ["qos", "QoS", (row) => row.qos],
  ["rate", "Rate", (row) => row.rate],
];
let sorted = { column: "name", down: false };

const endQos = (qos) => (qos ? [...new Set([qos.reliability, qos.durability, qos.depth >= 0 ? `depth ${qos.depth}` : ""])].filter(Boolean).join(" ") : "");
const sayRate = ([period, rate]) => (rate === null ? `each ${period}` : `${number(Number(rate.toPrecision(3)))} Hz`);

function buildRows() {
  const used = new Map();
  for (const edge of fitting.edges) {
    if (!used.has(edge.nameBox)) used.set(edge.nameBox, []);
    used.get(edge.nameBox).push(edge);
  }
  const wanted = words();
  return [...used].filter(([box, list]) => !wanted.length || wanted.every((word) => box.haystack.includes(word) || list.some((edge) => edge.nodeBox.haystack.includes(word)))).map(([box, list]) => ({
    box, senders: list.filter((edge) => edge.outward), receivers: list.filter((edge) => !edge.outward),
    qos: [...new Set(list.flatMap((edge) => edge.at.map((end) => endQos(end.qos))).filter(Boolean))].sort().join("; "),
    // For sorting: the fastest; what is not known comes last, or first.
    rate: Math.max(-1, ...box.name.rates.map(([, rate]) => (rate === null ? 0 : rate))),
  }));
}

const compareTexts = new Intl.Collator("en", { numeric: true }).compare;
function compareRows(a, b) {
  const value = COLUMNS.find(([id]) => id === sorted.column)[2];
  const [x, y] = [value(a), value(b)];
  return (sorted.down ? -1 : 1) * (typeof x === "number" ? x - y : compareTexts(x, y)) || compareTexts(a.box.label, b.box.label);
}

function nodeList(list) {
  const boxes = [...new Set(list.map((edge) => edge.nodeBox))];
  const shown = boxes.slice(0, 3).map((box) => make("div", { class: list.find((edge) => edge.nodeBox === box).unsure ? "unsure" : "" }, button(box.label, () => go(box), { class: "go" })));
  return make("td", null, make("b", null, number(boxes.length)), shown, boxes.length > 3 ? `and ${number(boxes.length - 3)} more` : "");
}

function tabulate() {
  at("heads").replaceChildren(...COLUMNS.map(([id, title]) => {
    const here = sorted.column === id;
    const press = button(`${title}${here ? (sorted.down ? " ▼" : " ▲") : ""}`, () => {
      sorted = { column: id, down: here && !sorted.down };
      tabulate();
      keep();
      at("heads").querySelector(`[data-column="${id}"]`).focus();
    }, { "data-column": id });
    return make("th", { scope: "col", "aria-sort": here ? (sorted.down ? "descending" : "ascending") : "none" }, press);
  }));
  const rows = buildRows().sort(compareRows);
  at("rows").replaceChildren(...rows.map((row) => make("tr", { class: [row.box.mark, row.box === chosen ? "chosen" : ""].join(" ") },
    make("th", { scope: "row", class: row.box.unsure ? "unsure" : "" }, button(row.box.label, () => choose(row.box), { class: "go" })),
    make("td", null, row.box.kind), make("td", null, row.box.name.types.join(" or ")),
    nodeList(row.senders), nodeList(row.receivers), make("td", null, row.qos), make("td", { title: row.box.name.rates.map(sayRate).join(", ") }, [...new Set(row.box.name.rates.map((one) => (one[1] === null ? "timer" : sayRate(one))))].join(", ")))));
  at("empty").hidden = true;
}
