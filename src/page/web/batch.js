// A batch: one mark for each piece in the plan's order, and a card for each of those that are asked for.

const MOST_CARDS = 120;  // at once: a page of thousands of pictures would take a browser's memory

const data = JSON.parse(byId("data").textContent);
const KINDS = [
  { id: "good", title: "Good" }, { id: "doubtful", title: "Doubtful" }, { id: "failed", title: "Failed" },
  { id: "without", title: "No result" }, { id: "waiting", title: "Not made yet" },
];
const ORDERS = [
  { title: "As planned", key: piece => piece.index },
  { title: "By name", key: piece => piece.name },
  { title: "Longest first", key: piece => -(piece.wall_seconds || 0) },
  { title: "Fewest triangles first", key: piece => piece.triangles || 0 },
];

function kindOf(piece) {
  if (piece.verdict === undefined) return "waiting";
  return piece.verdict || "without";
}

const pieces = data.pieces.map((piece, index) => ({ ...piece, index, kind: kindOf(piece) }));
const titleOf = kind => KINDS.find(each => each.id === kind).title;
const inFolder = (piece, file) => encodeURIComponent(piece.name) + "/" + file;

let kind = "all", order = ORDERS[0], most = MOST_CARDS;

function fillSummary() {
  const seconds = pieces.reduce((sum, piece) => sum + (piece.cpu_seconds || 0), 0);
  const parts = [shown(pieces.length) + (pieces.length === 1 ? " scene" : " scenes")];
  for (const each of KINDS) {
    const count = pieces.filter(piece => piece.kind === each.id).length;
    if (count) parts.push(shown(count) + " " + each.title.toLowerCase());
  }
  byId("summary").textContent = [...parts, duration(seconds) + " of processor time"].join(" \u00b7 ");
  byId("made").textContent = "Made by photohull " + data.photohull + ". batch.csv beside this page has every figure.";
}

function fillTimeline() {
  byId("timeline").append(...pieces.map(piece => {
    const text = piece.name + ": " + titleOf(piece.kind).toLowerCase();
    return element("a", { className: piece.kind, title: text, "aria-label": text, href: "#piece-" + piece.index,
      onclick: event => {
        event.preventDefault();
        show(piece);
      } });
  }));
}

/** Whatever was filtered: this one is asked for. */
function show(piece) {
  choose("all");
  byId("search").value = "";
  most = Math.max(most, chosen().indexOf(piece) + 1);
  fillCards();
  byId("piece-" + piece.index).scrollIntoView({ block: "center" });
}

function choose(id) {
  kind = id;
  byId("filter-" + id).checked = true;
}

function fillControls() {
  for (const each of [{ id: "all", title: "All" }, ...KINDS.filter(each => pieces.some(piece => piece.kind === each.id))]) {
    const input = element("input", { type: "radio", name: "filter", id: "filter-" + each.id, checked: each.id === kind });
    input.addEventListener("change", () => {
      kind = each.id;
      fillCards();
    });
    byId("filter").append(element("label", {}, input, element("span", {}, each.title)));
  }
  byId("order").append(...ORDERS.map(each => new Option(each.title)));
  byId("order").addEventListener("change", event => {
    order = ORDERS[event.target.selectedIndex];
    fillCards();
  });
  byId("search").addEventListener("input", fillCards);
  byId("more").firstChild.addEventListener("click", () => {
    most += MOST_CARDS;
    fillCards();
  });
}

function chosen() {
  const text = byId("search").value.toLowerCase();
  const compare = (a, b) => a < b ? -1 : a > b ? 1 : 0;
  return pieces.filter(piece => (kind === "all" || piece.kind === kind) && piece.name.toLowerCase().includes(text))
    .sort((a, b) => compare(order.key(a), order.key(b)) || a.index - b.index);
}

function cardOf(piece) {
  const picture = piece.preview ? element("img", { src: inFolder(piece, "preview.png"), alt: "The model of " + piece.name, loading: "lazy" }) : null;
  const figures = [];
  if (piece.verdict) figures.push(shown(piece.views) + " photographs", shown(piece.triangles) + " triangles", "voxels of " + shown(piece.voxel_size));
  if (piece.verdict !== undefined) figures.push(duration(piece.wall_seconds));
  const name = piece.page ? element("a", { href: inFolder(piece, "report.html") }, piece.name) : piece.name;
  return element("article", { className: piece.kind, id: "piece-" + piece.index },
    piece.page && picture ? element("a", { className: "picture", href: inFolder(piece, "report.html"), tabIndex: -1 }, picture)
      : element("span", { className: "picture" }, picture),
    element("div", {}, element("h2", {}, name),
      element("p", {}, element("span", { className: "level" }, titleOf(piece.kind)), figures.length ? " \u00b7 " + figures.join(" \u00b7 ") : ""),
      piece.message ? element("p", {}, piece.message) : null));
}

function fillCards() {
  const all = chosen();
  byId("pieces").replaceChildren(...all.slice(0, most).map(cardOf));
  if (!all.length) byId("pieces").append(element("p", {}, "None of the scenes is so."));
  byId("more").hidden = all.length <= most;
}

fillSummary();
fillTimeline();
fillControls();
fillCards();
