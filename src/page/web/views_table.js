// How well each view agrees with the model, the worst first.

// What the verdict lets a whole result have before it is doubtful (docs/measurements/verdict.md).
const LIMITS = { missed: 0.04, excess: 0.06, disagreeing: 0.5, unexplained: 0.5 };
const LEAST_PLACES = 30, LEAST_MATCHES = 10;  // that tell something of a view
const SIGNS = [
  { id: "residual", title: "Residual", shown: value => value.toFixed(2) + " px", says: "median distance of its matches from their epipolar lines" },
  { id: "missed", title: "Left empty", shown: percent, says: "share of its silhouette that the model does not fill" },
  { id: "excess", title: "Overrun", shown: percent, says: "share of the model's picture that lies beside its silhouette" },
  { id: "disagreeing", title: "Differs", shown: percent, says: "share of its places on the surface where other views show something else" },
  { id: "unexplained", title: "Unexplained", shown: percent, says: "share of what it shows that the model does not explain" },
];

/** The signs of each view, and how far the worst of them is beyond its limit (1: at it). */
function judgeViews(report) {
  const signals = report.verdict.signals || {};
  const explained = new Map((report.verdict.photographs?.views || []).map(view => [view.name, view]));
  return (report.verdict.views || []).map((view, index) => {
    const signs = { missed: view.missed, excess: view.excess }, limits = { ...LIMITS };
    // A quarter of a percent of the diagonal, in this view's pixels.
    limits.residual = view.pixel_size > 0 ? Math.max(signals.half_percent / 2 / view.pixel_size, 1) : Infinity;
    if (view.matches >= LEAST_MATCHES) signs.residual = view.residual;
    if (view.told >= LEAST_PLACES) signs.disagreeing = view.disagreeing / view.told;
    const photograph = explained.get(view.name);
    if (photograph?.told >= LEAST_PLACES) signs.unexplained = 1 - photograph.explained;
    const ratios = Object.entries(signs).filter(([, value]) => typeof value === "number")
      .map(([id, value]) => [id, value / limits[id]]);
    return { name: view.name, index, signs, beyond: new Set(ratios.filter(([, r]) => r > 1).map(([id]) => id)),
      worst: Math.max(0, ...ratios.map(([, r]) => r)) };
  });
}

/** Photographs that the result was made without, and why. */
function leftOut(report) {
  const reasons = { missing: "the file is missing", unreadable: "the file cannot be read", shape: "its size does not fit its camera" };
  const rows = (report.photographs?.left_out || []).map(view =>
    [view.name, (reasons[view.reason] || view.reason) + (view.detail ? ": " + view.detail : "")]);
  const why = name => (report.warnings || []).find(text => text.includes(name));
  for (const name of report.left_out || [])
    rows.push([name, why(name) || "it contradicts the other views, or is strongly blurred"]);
  for (const name of report.masks?.left_out || [])
    rows.push([name, "its mask alone: " + (why(name) || "it contradicts the other views' masks")]);
  return rows;
}

function viewRow(judged, view, signs, show) {
  const name = element("td", { className: "name" });
  if (view?.jpeg) name.append(element("img", { src: pictureOf(view), alt: "", loading: "lazy" }));
  name.append(element("button", { type: "button", className: "link", onclick: () => show(judged.index) }, judged.name));
  return element("tr", {}, name, ...signs.map(sign => {
    const value = judged.signs[sign.id];
    return element("td", { className: judged.beyond.has(sign.id) ? "n beyond" : "n" }, typeof value === "number" ? sign.shown(value) : "");
  }));
}

/** `show(i)` looks through a view. */
function viewsCard(report, views, judged, show) {
  const signs = SIGNS.filter(sign => judged.some(view => typeof view.signs[sign.id] === "number"));
  const ranked = [...judged].sort((a, b) => b.worst - a.worst || a.index - b.index);
  const beyond = ranked.filter(view => view.worst > 1).length;
  const head = element("tr", {}, element("th", {}, "View"),
    ...signs.map(sign => element("th", { className: "n", title: sign.says }, sign.title)));
  const table = element("table", {}, element("thead", {}, head),
    element("tbody", {}, ...ranked.map(view => viewRow(view, views[view.index], signs, show))));
  const parts = [element("p", { className: "hint" }, !ranked.length ? "Nothing is known of single views." : beyond === 0 ? "None stands out. The first agrees least." :
    beyond + " of " + ranked.length + " are worse, in what is marked, than a good result may be as a whole. The first agrees least.")];
  if (ranked.length) parts.push(element("div", { className: "scroll rank", tabIndex: 0, role: "region", "aria-label": "Views by agreement" }, table));
  const notes = element("details", { className: "hint" }, element("summary", {}, "What the columns say"),
    facts(signs.map(sign => [sign.title, sign.says])));
  if (signs.length) parts.push(notes);
  const out = leftOut(report);
  if (out.length) parts.push(element("h2", { style: "margin-top: 14px" }, "Left out"), facts(out));
  return card("Views", ...parts);
}
