// Run by Duktape (ECMAScript 5) before ECharts: what a browser would give it. Charts are drawn at
// once and without animation, so nothing waits for a timer.
var window = this, self = this;
function setTimeout() { return 0; }
function clearTimeout() {}

/// The SVG document of a chart; `measure(text, font)` is the host's and returns pixels.
function renderSvg(option, width, height) {
  echarts.setPlatformAPI({
    measureText: function (text, font) { return { width: measure(text, font || "") }; }
  });
  var chart = echarts.init(null, null, { renderer: "svg", ssr: true, width: width, height: height });
  chart.setOption(JSON.parse(option));
  var svg = chart.renderToSVGString();
  chart.dispose();
  return svg;
}
