// From the page's data to the page.

const data = JSON.parse(byId("data").textContent);
const report = data.report;
const judged = judgeViews(report);
let viewer = null;

const actions = {
  through: i => {
    viewer?.lookThrough(i);
    byId("viewport").scrollIntoView({ block: "nearest" });
  },
  hasLayer: id => data.model.streams.some(stream => stream.name === id),
  layer: id => {
    byId("layer-" + id)?.click();
    byId("viewport").scrollIntoView({ block: "nearest" });
  },
};

function fillReport() {
  const name = report.scene.path.split("/").filter(part => part && part !== ".").pop() || report.scene.path;
  document.title = name + ": photohull report";
  byId("scene").textContent = name;
  const summary = [report.scene.views + " photographs", "method " + report.options.method,
    shown(report.mesh.triangles) + " triangles", duration(report.wall_seconds)];
  byId("summary").append(...summary.flatMap((text, i) => [i ? " \u00b7 " : "", element("span", {}, text)]));
  document.body.classList.add(report.verdict.level);
  byId("light").setAttribute("aria-label", "Verdict: " + report.verdict.level);
  byId("light").lastElementChild.textContent = report.verdict.level;
  byId("made").textContent = "Made by photohull " + report.photohull + ". report.json beside this page has every figure.";
  byId("details").append(...[verdictCard(report, data.views, actions), warningsCard(report, data.views, actions),
    viewsCard(report, data.views, judged, actions.through), resolutionCard(report), stagesCard(report),
    commandCard(report, data.command), resultCard(report, data.model), filesCard(report)].filter(part => part));
}

function fillLayers(numbers) {
  const layers = LAYERS.filter(layer => numbers[layer.stream]);
  for (const layer of layers) {
    const input = element("input", { type: "radio", name: "layer", id: "layer-" + layer.id, checked: layer === layers[0] });
    input.addEventListener("change", () => showLayer(layer, numbers));
    byId("layers").append(element("label", {}, input, element("span", {}, layer.title)));
  }
  showLayer(layers[0], numbers);
}

function showLayer(layer, numbers) {
  viewer.show(layer);
  const stream = data.model.streams.find(each => each.name === layer.stream);
  byId("legend").replaceChildren(...layer.legend(numbers, stream.step));
}

function fillCameras() {
  byId("camera").add(new Option("Free view", "-1"));
  data.views.forEach((view, i) => {
    byId("camera").add(new Option(view.name, String(i)));
    if (!view.jpeg) return;
    const width = Math.round(56 * view.size[0] / view.size[1]);
    const picture = element("img", { src: pictureOf(view), alt: "", loading: "lazy", style: "width: " + width + "px" });
    const button = element("button", { type: "button", title: view.name, "aria-label": "Look through " + view.name, "aria-pressed": "false",
      onclick: () => viewer.lookThrough(viewer.through === i ? -1 : i) }, picture);
    button.dataset.view = i;
    byId("strip").append(button);
  });
}

function step(by) {
  const count = data.views.length;
  viewer.lookThrough(((viewer.through < 0 && by < 0 ? 0 : viewer.through) + by + count) % count);
}

/** The controls follow what is looked through. */
function followThrough(i) {
  byId("camera").value = String(i);
  byId("blend").hidden = i < 0 || !data.views[i].jpeg;
  for (const button of byId("strip").children) {
    const chosen = Number(button.dataset.view) === i;
    button.setAttribute("aria-pressed", String(chosen));
    const strip = byId("strip");
    if (chosen) strip.scrollLeft = button.offsetLeft - (strip.clientWidth - button.clientWidth) / 2 - strip.offsetLeft;
  }
}

function connect() {
  viewer.onThrough = followThrough;
  const reset = () => {
    viewer.reset();
    viewer.draw();
  };
  byId("cameras").addEventListener("change", event => viewer.showCameras(event.target.checked));
  byId("reset").addEventListener("click", reset);
  byId("camera").addEventListener("change", event => viewer.lookThrough(Number(event.target.value)));
  byId("previous").addEventListener("click", () => step(-1));
  byId("next").addEventListener("click", () => step(1));
  byId("opacity").addEventListener("input", () => viewer.blend());
  const keys = { PageDown: () => step(1), PageUp: () => step(-1), Home: reset, Escape: () => viewer.lookThrough(-1) };
  byId("canvas").addEventListener("keydown", event => {
    if (keys[event.key]) keys[event.key]();
    else if (!viewer.orbit.key(event)) return;
    event.preventDefault();
  });
}

async function start() {
  const [THREE, bytes, texture] = await Promise.all([unpackModule("packed-three"), unpackBytes("packed-model"), unpackImage("texture")]);
  const numbers = readModel(bytes, data.model);
  const marked = new Set(judged.filter(view => view.worst > 1).map(view => view.index));
  viewer = new Viewer(THREE, data, numbers, texture, i => marked.has(i) ? "#e8590c" : "#3b82c4");
  fillLayers(numbers);
  fillCameras();
  connect();
  viewer.showCameras(byId("cameras").checked);
  await viewer.drawn();
  byId("message").textContent = "";
}

fillReport();
try {
  await start();
} catch (error) {
  byId("model").classList.add("undrawn");
  byId("message").textContent = "The model cannot be drawn: " + error.message.replace(/\.+$/, "") +
    ". It needs WebGL 2 and a browser of 2023 or later; preview.png beside this page shows the model, too.";
}
byId("viewport").setAttribute("aria-busy", "false");
viewer?.photographs.load(() => viewer.draw());
