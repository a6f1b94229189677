// The static charts: map, cuts and forces.

const INK = "#000000", BLUE = "#0072B2", VERMILLION = "#D55E00", GREY = "#6E6E6E";
const FONT = { family: "DejaVu Sans, Verdana, Arial, sans-serif", size: 11, color: INK };
const MU = "<i>μ̃</i><sub>macro</sub>";
const FORWARD = "forward force / (<i>μF<sub>z</sub></i>)";
const PHONE = matchMedia("(max-width: 700px)"); // as in style.css
const RATIOS = { type: "log", dtick: 1, exponentformat: "power" }; // settings of a logarithmic axis
const LEGEND = { orientation: "h", x: 0, xanchor: "left", y: 1.01, yanchor: "bottom" };
const BAR = 32; // height of the margin above a chart, so that the buttons hide no data

// On a phone, a finger scrolls the page, so charts have no zoom and no buttons.
function config() {
  const bar = { displayModeBar: PHONE.matches ? false : "hover", modeBarButtons: [["toImage", "resetScale2d"]] };
  return { responsive: true, displaylogo: false, ...bar };
}

function axis(title, more) {
  const lines = { showline: true, mirror: true, ticks: "outside", ticklen: 3, zeroline: false, gridcolor: "#ececec" };
  return { title: { text: title, standoff: 6 }, ...lines, fixedrange: PHONE.matches, ...more };
}

function layout(more) {
  return {
    font: FONT,
    margin: { l: 48, r: 10, t: BAR, b: 42 },
    hovermode: "closest",
    dragmode: PHONE.matches ? false : "zoom",
    ...more,
  };
}

// Returns the edges of cells around points, half-way between neighbours. The first and the last
// point are in the middle of their cells.
function edges(points) {
  const inner = points.slice(1).map((value, k) => (value + points[k]) / 2);
  const last = points.length - 1;
  const first = inner.length ? 2 * points[0] - inner[0] : points[0] - 0.5;
  return [first, ...inner, inner.length ? 2 * points[last] - inner[last - 1] : points[0] + 0.5];
}

// Returns the indices of the map's columns with a velocity above 0.
function shownColumns(map) {
  return map.velocity.map((_, j) => j).filter((j) => map.velocity[j] > 0);
}

// Returns the edges of the map's cells. Edges between velocities are geometric means.
function cellEdges(map) {
  const exponents = shownColumns(map).map((j) => Math.log10(map.velocity[j]));
  return { x: edges(exponents).map((exponent) => 10 ** exponent), y: edges(map.amplitude) };
}

// Draws the map. contact: position [velocity, amplitude] of the contact in the form, or null.
function drawMap(element, map, row, column, contact) {
  const columns = shownColumns(map);
  const pick = (table) => table.map((row) => columns.map((j) => row[j]));
  const velocity = columns.map((j) => map.velocity[j]);
  const mu = pick(map.points.mu_macro);
  const bounds = cellEdges(map);
  const text = map.amplitude.map((amplitude, i) =>
    columns.map((j) => {
      const at = `velocity ${digits(map.velocity[j])}, amplitude ${digits(amplitude)}`;
      const known = map.points.converged[i][j] ? "" : "<br>not converged";
      return `${at}<br>${muText(map, i, j)}${known}`;
    })
  );
  const bad = map.amplitude.flatMap((amplitude, i) =>
    columns.filter((j) => !map.points.converged[i][j]).map((j) => [map.velocity[j], amplitude])
  );
  // Lines are white on dark colours and black on pale ones.
  const levels = (start, end, color) => ({
    type: "contour", x: velocity, y: map.amplitude, z: mu, line: { color, width: 1 },
    contours: { coloring: "none", start, end, size: 0.1, showlabels: true, labelfont: { size: 10, color } },
    showscale: false, showlegend: false, hoverinfo: "skip",
  });
  const traces = [
    {
      type: "heatmap", name: "map", ...bounds, z: mu, text, hovertemplate: "%{text}<extra></extra>",
      colorscale: "Cividis", zmin: 0, zmax: 1,
      colorbar: { title: { text: MU, side: "right" }, thickness: 12, outlinewidth: 0.5, len: 1, y: 0.5 },
    },
    levels(0.1, 0.5, "#fff"),
    levels(0.6, 0.9, INK),
    {
      type: "scatter", name: `not converged (${bad.length} of ${velocity.length * map.amplitude.length})`,
      mode: "markers", x: bad.map((place) => place[0]), y: bad.map((place) => place[1]), hoverinfo: "skip",
      marker: { symbol: "x-thin", size: 8, line: { width: 2, color: VERMILLION } }, showlegend: bad.length > 0,
    },
    {
      type: "scatter", name: "your contact", mode: "markers", x: contact ? [contact[0]] : [], y: contact ? [contact[1]] : [],
      marker: { symbol: "star", size: 16, color: VERMILLION, line: { width: 1.5, color: "#fff" } },
      hovertemplate: "your contact: velocity %{x:.4g}, amplitude %{y:.4g}<extra></extra>", showlegend: contact !== null,
    },
  ];
  const ends = (list) => [list[0], list[list.length - 1]];
  Plotly.react(element, traces, layout({
    xaxis: axis(map.labels[0], { ...RATIOS, range: ends(bounds.x).map(Math.log10), showgrid: false }),
    yaxis: axis(map.labels[1], { range: ends(bounds.y), showgrid: false }),
    dragmode: false,
    shapes: cross(map, row, column),
    legend: LEGEND,
  }), config());
  Plotly.Plots?.resize(element); // the height of the chart depends on the panel beside it
}

// Marks the selected cell of the map and the two cuts through it.
function cross(map, row, column) {
  const velocity = map.velocity[column], amplitude = map.amplitude[row];
  const line = { color: VERMILLION, width: 1.2, dash: "dot" };
  const across = { type: "line", xref: "paper", x0: 0, x1: 1, y0: amplitude, y1: amplitude, line };
  if (velocity === 0) return [across]; // 0 is not on the logarithmic axis
  const up = { type: "line", yref: "paper", y0: 0, y1: 1, x0: velocity, x1: velocity, line };
  const { x, y } = cellEdges(map);
  const j = column - map.velocity.length + x.length - 1; // the first velocity may be 0
  const cell = { type: "rect", x0: x[j], x1: x[j + 1], y0: y[row], y1: y[row + 1],
    line: { color: VERMILLION, width: 3 } };
  return [across, up, cell];
}

function markMap(element, map, row, column) {
  Plotly.relayout(element, { shapes: cross(map, row, column) });
}

function muText(map, row, column) {
  const { mu_macro, mu_macro_error } = map.points;
  const mu = mu_macro[row][column], error = mu_macro_error[row][column];
  if (mu === null) return "mu_macro: none";
  return `mu_macro ${mu.toFixed(5)} ± ${error === null ? "unknown" : error.toPrecision(2)}`;
}

// Returns a limit along a cut: the fine curve, the values at the points, or a constant.
function limitAlong(map, given, along, fixed) {
  const points = map[along];
  const other = along === "velocity" ? "amplitude" : "velocity";
  if (given.dims.length === 1 && given.dims[0] === along) return given.curve;
  if (given.dims.length === 1 && given.dims[0] === other) {
    const shown = along === "velocity" ? points.filter((velocity) => velocity > 0) : points;
    return [[shown[0], shown[shown.length - 1]], Array(2).fill(given.values[fixed])];
  }
  return [points, along === "velocity" ? given.values[fixed] : given.values.map((row) => row[fixed])];
}

// Draws a cut through the map. along: axis of the cut. fixed: index along the other axis. hidden:
// labels of limits that are switched off.
function drawCut(element, map, along, fixed, selected, hidden) {
  const inVelocity = along === "velocity";
  const indices = inVelocity ? shownColumns(map) : map.amplitude.map((_, i) => i);
  const value = (name) => (k) => inVelocity ? map.points[name][fixed][k] : map.points[name][k][fixed];
  const x = indices.map((k) => map[along][k]);
  const good = indices.map(value("converged"));
  const traces = map.limits.map((given) => {
    const [at, limit] = limitAlong(map, given, along, fixed);
    const kept = at.map((_, k) => k).filter((k) => !inVelocity || at[k] > 0);
    return {
      type: "scatter", mode: "lines", name: given.label, visible: !hidden.has(given.label),
      x: kept.map((k) => at[k]), y: kept.map((k) => limit[k]), line: { color: given.color, dash: given.dash, width: 1.8 },
      hovertemplate: `${given.long_name}: %{y:.4f}<extra></extra>`, hoverlabel: { namelength: 0 },
    };
  });
  traces.push({
    type: "scatter", mode: "markers", name: "computed", x, y: indices.map(value("mu_macro")), customdata: indices,
    error_y: { type: "data", array: indices.map(value("mu_macro_error")), color: INK, thickness: 1, width: 2 },
    marker: {
      color: good.map((yes) => (yes ? INK : "#fff")),
      size: indices.map((k) => (k === selected ? 10 : 5)),
      line: { color: indices.map((k) => (k === selected ? VERMILLION : INK)),
        width: indices.map((k) => (k === selected ? 2.5 : 1)) },
    },
    hovertemplate: `${along} %{x:.4g}<br>mu_macro %{y:.5f}<extra></extra>`,
  });
  Plotly.react(element, traces, layout({
    xaxis: axis(map.labels[inVelocity ? 0 : 1], inVelocity ? RATIOS : {}),
    yaxis: axis(MU, { range: [-0.04, 1.06], dtick: 0.2 }),
    showlegend: false,
  }), config());
}

function inDegrees(phase) {
  return (phase * 180) / Math.PI;
}

// Draws two charts of the forward force: one against time, with the mean force from the dataset,
// and one against the other component of the force. A dot marks the frame.
function drawForces(history, loop, period, mu, error, frame) {
  const degrees = period.phase.map(inDegrees);
  const [first, last] = [degrees[0], degrees[0] + 360];
  const spread = error === null ? 0 : error;
  const here = { type: "scatter", mode: "markers", y: [period.forward[frame]], hoverinfo: "skip", showlegend: false,
    marker: { color: VERMILLION, size: 9, line: { color: "#fff", width: 1 } } };
  const low = Math.min(-0.05, ...period.forward.map((force) => force - 0.05));
  const y = axis(FORWARD, { range: [low, 1.06], dtick: 0.2 });
  const mean = mu === null ? [] : [
    { type: "scatter", mode: "lines", name: "its error", x: [first, last, last, first], fill: "toself",
      y: [mu - spread, mu - spread, mu + spread, mu + spread], line: { width: 0 },
      fillcolor: "rgba(213,94,0,0.35)", hoverinfo: "skip" },
    { type: "scatter", mode: "lines", name: "mean", x: [first, last], y: [mu, mu],
      line: { color: VERMILLION, width: 1.6, dash: "6px,3px" }, hovertemplate: "mean %{y:.5f}<extra></extra>" },
  ];
  const force = { type: "scatter", mode: "lines", line: { color: BLUE, width: 1.8 } };
  Plotly.react(history, [
    { ...here, x: [degrees[frame]] },
    ...mean,
    { ...force, x: degrees, y: period.forward, showlegend: false,
      hovertemplate: "%{x:.0f}°: %{y:.4f}<extra></extra>" },
  ], layout({
    xaxis: axis("phase  <i>ωt</i> (degrees)", { range: [first, last], dtick: 90 }),
    yaxis: y,
    legend: { ...LEGEND, font: { size: 10 }, entrywidth: 55 },
  }), config());
  Plotly.react(loop, [
    { ...here, x: [period.other[frame]] },
    { ...force, x: period.other, y: period.forward, showlegend: false,
      hovertemplate: "%{x:.4f}, %{y:.4f}<extra></extra>" },
  ], layout({
    xaxis: axis(period.map.other_force, { range: [-1.06, 1.06], dtick: 0.5 }),
    yaxis: y,
  }), config());
}

function markForces(history, loop, period, frame) {
  const y = [[period.forward[frame]]];
  Plotly.restyle(history, { x: [[inDegrees(period.phase[frame])]], y }, [0]);
  Plotly.restyle(loop, { x: [[period.other[frame]]], y }, [0]);
}
