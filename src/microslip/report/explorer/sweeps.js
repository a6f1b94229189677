// Selection of a sweep and a Poisson's ratio, and the chart of a sweep without a map.

const COLOURS = [BLUE, VERMILLION, "#009E73", "#CC79A7", "#E69F00", "#56B4E9", GREY, INK];

// Sweeps in the order of the page, each with its maps or lines in ascending order of Poisson's
// ratio.
const SWEEPS = [...new Set(NUMBERS.sweeps.map((one) => one.name))].map((name) => {
  const entries = NUMBERS.sweeps.filter((one) => one.name === name).sort((a, b) => a.poisson - b.poisson);
  return { ...entries[0], entries };
});

function sweepOf(entry) {
  return SWEEPS.find((one) => one.name === entry.name);
}

function optionOf(value, text) {
  const option = document.createElement("option");
  Object.assign(option, { value, textContent: text });
  return option;
}

function offerSweeps(choose) {
  element("sweeps").append(...SWEEPS.map((one) => optionOf(one.name, one.title)));
  element("sweeps").addEventListener("change", (e) => choose(sweepOf({ name: e.target.value }).entries[0]));
  element("poisson").addEventListener("change", (e) => choose(sweepOf(STATE.shown).entries[Number(e.target.value)]));
}

// Marks the selected sweep and Poisson's ratio.
function markSweep(entry) {
  const { entries } = sweepOf(entry);
  element("sweeps").value = entry.name;
  element("poisson").replaceChildren(
    ...entries.map((one, k) => optionOf(String(k), `Poisson's ratio ${digits(one.poisson)}`)));
  element("poisson").value = String(entries.indexOf(entry));
  element("poisson").hidden = entries.length < 2;
}

function drawLines(element, { x, y, limits, series }) {
  const forms = limits.map((given) => ({
    type: "scatter", mode: "lines", name: given.label, x: given.curve?.[0] ?? x.values, y: given.curve?.[1] ?? given.values,
    line: { color: given.color, dash: given.dash, width: 1.6 }, hovertemplate: `${given.long_name}: %{y:.4f}<extra></extra>`,
  }));
  const computed = series.map((one, k) => ({
    type: "scatter", mode: "lines+markers", name: one.label || "computed", x: x.values, y: one.values,
    error_y: { type: "data", array: one.errors, thickness: 1, width: 2 },
    line: { color: COLOURS[k % COLOURS.length], width: 1 },
    marker: { size: 6, symbol: one.converged.map((yes) => (yes ? "circle" : "x-thin-open")) },
    text: one.errors.map((error) => (error === null ? "unknown" : error.toPrecision(2))),
    hovertemplate: "%{x:.4g}: %{y:.5g} ± %{text}<extra></extra>",
  }));
  Plotly.react(element, [...forms, ...computed], layout({
    xaxis: axis(x.label, x.log ? RATIOS : {}),
    yaxis: axis(y.label, y.log ? RATIOS : {}),
    shapes: [],
    showlegend: forms.length + computed.length > 1,
    legend: { ...LEGEND, font: { size: 10 } },
    margin: { l: 56, r: 10, t: BAR + 24, b: 42 },
  }), config());
}

// Draws a dotted line at the selected point.
function markLine(element, at) {
  const line = { color: VERMILLION, width: 1.2, dash: "dot" };
  const up = { type: "line", yref: "paper", y0: 0, y1: 1, x0: at, x1: at, line };
  Plotly.relayout(element, { shapes: element.layout.xaxis.type === "log" && !(at > 0) ? [] : [up] });
}
