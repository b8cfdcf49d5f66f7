// What the model's colours can show, and the legend of each. A layer has `colours(model)`, linear RGB of
// each vertex in steps of 1 / 65535, or nothing for plain clay or the texture, and `legend(model)`, elements or nothing.

const NOT_KNOWN = 255, UNSEEN_COLOUR = [150, 150, 155], UNKNOWN_COLOUR = [205, 205, 210];
// Perceptually even ramps, which those who see no red or green can read too: viridis and inferno.
const VIRIDIS = [[68, 1, 84], [65, 68, 135], [42, 120, 142], [34, 168, 132], [122, 209, 81], [253, 231, 37]];
const INFERNO = [[40, 11, 84], [101, 21, 110], [159, 42, 99], [212, 72, 66], [245, 125, 21], [250, 193, 39]];

/** Of a share in [0, 1]; sRGB bytes. */
function rampColour(ramp, share) {
  const place = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const i = Math.min(Math.floor(place), ramp.length - 2);
  return ramp[i].map((low, c) => Math.round(low + (place - i) * (ramp[i + 1][c] - low)));
}

const LINEAR = Uint16Array.from({ length: 256 }, (_, i) => {
  const v = i / 255;
  return Math.round(65535 * (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
});

const css = colour => "rgb(" + colour.join(",") + ")";
const viewsColour = (count, most) => count === 0 ? UNSEEN_COLOUR : rampColour(VIRIDIS, (count - 1) / Math.max(most - 1, 1));

function linearOf(bytes) {
  const colours = new Uint16Array(bytes.length);
  for (let i = 0; i < bytes.length; ++i) colours[i] = LINEAR[bytes[i]];
  return colours;
}

/** Colours of the vertices by a table of the 256 codes of a layer. */
function coloursOfCodes(codes, colourOf) {
  const table = Uint16Array.from(Array.from({ length: 256 }, (_, code) => colourOf(code)).flat(), byte => LINEAR[byte]);
  const colours = new Uint16Array(3 * codes.length);
  for (let i = 0, at = 0; i < codes.length; ++i)
    for (let c = 0; c < 3; ++c) colours[at++] = table[3 * codes[i] + c];
  return colours;
}

function rampLegend(title, ramp, low, high, others) {
  const stops = ramp.map(css).join(", ");
  return [element("b", {}, title),
    element("div", { className: "ramp", style: "background: linear-gradient(to right, " + stops + ")" }),
    element("div", { className: "ends" }, element("span", {}, low), element("span", {}, high)),
    swatches(others)];
}

function swatches(entries) {
  return element("div", { className: "swatches" }, ...entries.map(([colour, text]) =>
    element("span", {}, element("s", { style: "background: " + css(colour) }), text)));
}

const unknownEntries = codes => codes.includes(NOT_KNOWN) ? [[UNKNOWN_COLOUR, "not known"]] : [];

/** The code below which 98 of 100 known ones are. */
function highestUsual(codes) {
  const counts = new Uint32Array(256);
  for (const code of codes) ++counts[code];
  counts[NOT_KNOWN] = 0;
  let left = 0.98 * counts.reduce((sum, count) => sum + count, 0), code = 0;
  while (code < NOT_KNOWN - 1 && (left -= counts[code]) > 0) ++code;
  return Math.max(1, code);
}

const LAYERS = [
  {
    id: "texture", title: "Colour", shaded: false, stream: "place", textured: true, colours: () => null, legend: () => [],
  },
  {
    id: "colour", title: "Colour", shaded: false, stream: "colour", colours: model => linearOf(model.colour), legend: () => [],
  },
  { id: "clay", title: "Clay", shaded: true, stream: "position", colours: () => null, legend: () => [] },
  {
    id: "confidence", title: "Confidence", shaded: true, stream: "confidence",
    colours: model => coloursOfCodes(model.confidence, code =>
      code === NOT_KNOWN ? UNKNOWN_COLOUR : code === 0 ? UNSEEN_COLOUR : rampColour(VIRIDIS, code / 254)),
    legend: model => rampLegend("Chance to lie within a voxel of the true surface", VIRIDIS, "0 %", "100 %",
      [[UNSEEN_COLOUR, "no camera sees it"], ...unknownEntries(model.confidence)]),
  },
  {
    id: "views", title: "Views", shaded: true, stream: "views",
    colours: model => {
      const most = highestUsual(model.views);
      return coloursOfCodes(model.views, code => code === NOT_KNOWN ? UNKNOWN_COLOUR : viewsColour(code, most));
    },
    legend: model => {
      const most = highestUsual(model.views);
      return rampLegend("Views that see the surface", VIRIDIS, "1", most + " or more",
        [[UNSEEN_COLOUR, "none"], ...unknownEntries(model.views)]);
    },
  },
  {
    id: "disagreement", title: "Disagreement", shaded: true, stream: "disagreement",
    colours: model => {
      const most = highestUsual(model.disagreement);
      return coloursOfCodes(model.disagreement, code =>
        code === NOT_KNOWN ? UNSEEN_COLOUR : rampColour(INFERNO, code / most));
    },
    legend: (model, step) => rampLegend("How much the views' colours differ, of full scale", INFERNO, "0 %",
      percent(step * highestUsual(model.disagreement)) + " or more", [[UNSEEN_COLOUR, "no camera sees it, or not known"]]),
  },
];
