// Draws a sweep without a map: lines against one axis, and the limits from theory.

const COLOURS = [BLUE, VERMILLION, "#009E73", "#CC79A7", "#E69F00", "#56B4E9", GREY, INK];

function drawLines(element, lines) {
  const { x, y } = lines;
  const limits = lines.limits.map((given) => ({
    type: "scatter",
    mode: "lines",
    name: given.label,
    x: given.curve ? given.curve[0] : x.values,
    y: given.curve ? given.curve[1] : given.values,
    line: { color: given.color, dash: given.dash, width: 1.6 },
    hovertemplate: `${given.long_name}: %{y:.4f}<extra></extra>`,
  }));
  const series = lines.series.map((one, k) => ({
    type: "scatter",
    mode: "lines+markers",
    name: one.label || "computed",
    x: x.values,
    y: one.values,
    error_y: { type: "data", array: one.errors, thickness: 1, width: 2 },
    line: { color: COLOURS[k % COLOURS.length], width: 1 },
    marker: { size: 6, symbol: one.converged.map((yes) => (yes ? "circle" : "x-thin-open")) },
    text: one.errors.map((error) => (error === null ? "unknown" : error.toPrecision(2))),
    hovertemplate: "%{x:.4g}: %{y:.5g} ± %{text}<extra></extra>",
  }));
  const ratios = { type: "log", dtick: 1, exponentformat: "power" };
  Plotly.react(element, [...limits, ...series], layout({
    xaxis: axis(x.label, x.log ? ratios : {}),
    yaxis: axis(y.label, y.log ? ratios : {}),
    shapes: [],
    showlegend: limits.length + series.length > 1,
    legend: { orientation: "h", x: 0, y: 1.01, yanchor: "bottom", font: { size: 10 } },
    margin: { l: 56, r: 10, t: BAR + 24, b: 42 },
  }), config());
}

// Draws a dotted line at the selected point.
function markLine(element, at) {
  const line = { color: VERMILLION, width: 1.2, dash: "dot" };
  const up = { type: "line", yref: "paper", y0: 0, y1: 1, x0: at, x1: at, line };
  Plotly.relayout(element, { shapes: element.layout.xaxis.type === "log" && !(at > 0) ? [] : [up] });
}
