// The cards beside the model: what report.json tells (docs/reference/report.md).

const LEVELS = {
  good: "The photographs confirm the model.",
  doubtful: "Something speaks against the model, or too little for it.",
  failed: "The result failed its own checks; the files are there to look at.",
};
// Words of reasons that a layer of the model shows the place of.
const SHOWN_BY = [["no view sees", "views"], ["fewer than three views", "views"], ["confidence", "confidence"]];

/** Text with the names of views in it as buttons that look through them, and options in one piece. */
function withViews(text, views, show) {
  const names = views.map((view, i) => [view.name, i]).filter(([name]) => name && text.includes(name))
    .sort((a, b) => b[0].length - a[0].length);
  let parts = [text];
  for (const [name, i] of names)
    parts = parts.flatMap(part => typeof part !== "string" ? [part] : part.split(name).flatMap((piece, k) =>
      k === 0 ? [piece] : [element("button", { type: "button", className: "link", onclick: () => show(i) }, name), piece]));
  return parts.flatMap(part => typeof part !== "string" ? [part] : part.split(/(--[a-z][a-z-]*)/).map((piece, k) =>
    k % 2 ? element("code", {}, piece) : piece));
}

/** What is wrong in bold, and what to do. */
function reasonItem(reason, views, actions) {
  const cut = reason.indexOf(": ");
  const item = element("li", {}, element("b", {}, ...withViews(cut < 0 ? reason : reason.slice(0, cut + 1), views, actions.through)));
  if (cut >= 0) item.append(" ", ...withViews(reason.slice(cut + 2), views, actions.through));
  const shows = SHOWN_BY.find(([words, layer]) => reason.includes(words) && actions.hasLayer(layer));
  if (shows)
    item.append(" ", element("button", { type: "button", className: "link", onclick: () => actions.layer(shows[1]) }, "Show where"));
  return item;
}

function verdictCard(report, views, actions) {
  const { level, reasons = [], notes = [], coverage } = report.verdict;
  const list = items => items.length ? element("ul", { className: "reasons" }, ...items) : null;
  return card("Verdict", element("p", {}, element("b", { className: "level" }, level), ". ", LEVELS[level] || ""),
    list(reasons.map(reason => reasonItem(reason, views, actions))),
    list(notes.map(note => element("li", {}, ...withViews(note, views, actions.through)))),
    coverage ? element("p", {}, "Coverage: " + coverage + ".") : null);
}

function warningsCard(report, views, actions) {
  if (!report.warnings?.length) return null;
  return card("Warnings", element("ul", { className: "reasons" },
    ...report.warnings.map(text => element("li", {}, ...withViews(text, views, actions.through)))));
}

function resolutionCard(report) {
  const voxel = report.grid.voxel_size, pixel = report.verdict.signals?.pixel_size;
  const { smallest, largest } = report.image_scale || {};
  return card("Resolution", facts([
    ["Voxel", shown(voxel) + " scene units"],
    ["Pixel at the object", pixel > 0 ? shown(pixel) + " scene units" : ""],
    ["Pixels a voxel", pixel > 0 ? shown(voxel / pixel) : ""],
    ["Lattice", report.grid.voxels.join(" \u00d7 ") + " voxels"],
    ["Photographs read at", smallest < 1 ? (smallest === largest ? shown(smallest) : shown(smallest) + " to " + shown(largest)) + " of their size" : ""],
  ]));
}

function stagesCard(report) {
  const longest = Math.max(...report.stages.map(stage => stage.wall_seconds), 1e-9);
  const row = stage => element("tr", {}, element("td", {}, stage.name),
    element("td", { className: "track" }, element("div", { style: "width: " + 100 * stage.wall_seconds / longest + "%" })),
    element("td", { className: "n" }, stage.wall_seconds.toFixed(2)), element("td", { className: "n" }, stage.cpu_seconds.toFixed(2)),
    element("td", { className: "n" }, mebibytes(stage.peak_memory_bytes)));
  const head = ["Stage", "", "Time, s", "CPU, s", "Memory by then"];
  const table = element("table", {},
    element("thead", {}, element("tr", {}, ...head.map((text, i) => element("th", { className: i > 1 ? "n" : "" }, text)))),
    element("tbody", {}, ...report.stages.map(row)),
    element("tfoot", {}, element("tr", {}, element("td", { colSpan: 2 }, "All"), element("td", { className: "n" }, report.wall_seconds.toFixed(2)),
      element("td", { className: "n" }, report.cpu_seconds.toFixed(2)), element("td", { className: "n" }, mebibytes(report.peak_memory_bytes)))));
  return card("Time and memory", element("div", { className: "scroll" }, table));
}

/** Puts text on the clipboard, or selects it where the browser keeps that from pages of files. */
async function copyText(text, from, button) {
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    getSelection().selectAllChildren(from);
    button.textContent = "Selected";
  }
  setTimeout(() => { button.textContent = "Copy"; }, 2000);
}

function commandCard(report, command) {
  const options = element("details", {}, element("summary", {}, "All options as they took effect"),
    facts(Object.entries(report.options || {}).map(([name, value]) => [name, value])));
  if (!command) return card("Options", options);
  const code = element("code", {}, command);
  const button = element("button", { type: "button" }, "Copy");
  button.onclick = () => copyText(command, code, button);
  return card("Command", element("pre", {}, code), element("p", {}, button), options);
}

function resultCard(report, model) {
  const box = corner => corner.map(value => String(Number(value.toPrecision(6)))).join(", ");
  const { vertices, triangles, unseen_share } = report.mesh;
  return card("Result", facts([
    ["Scene", report.scene.path], ["Format", report.scene.format],
    ["Photographs", report.scene.views + " of " + report.photographs.listed],
    ["Masks", report.masks.source + (report.masks.confidence > 0 && report.masks.confidence < 1 ? ", least confidence " + shown(report.masks.confidence) : "")],
    ["Box", box(report.box.min) + " to " + box(report.box.max)], ["Box from", report.box.source],
    ["mesh.ply", shown(vertices) + " vertices, " + shown(triangles) + " triangles" +
      (model.triangles < triangles ? "; shown here with " + shown(model.triangles) : "")],
    ["Seen by no camera", percent(unseen_share) + " of the vertices"],
    ["Device", report.device],
  ]));
}

/** Files lie beside the page. */
function filesCard(report) {
  return card("Files", element("ul", { className: "reasons" }, ...(report.files || []).map(name =>
    element("li", {}, element("a", { href: encodeURIComponent(name) }, name)))));
}
