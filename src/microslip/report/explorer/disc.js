// Draws the contact at one phase: sticking cells, slipping cells, and tractions. Lines enclose the
// cells that dissipate half the energy of the period.

const STICK = "#56B4E9", SLIP = "#E69F00";
const LONGEST = 0.17; // length of an arrow, divided by a, for a traction equal to the largest bound
const CLOSEST = 0.14; // smallest distance between arrows on a ring, divided by a

// Returns the parts common to all frames: outlines of cells, and positions and lengths of arrows.
function discOf(period) {
  const { angles, cells } = period;
  const theta = sectorAngles(period);
  const inner = period.radius.slice(1).map((radius, i) => (radius + period.radius[i]) / 2);
  const rims = [0, ...inner, 1];
  const half = Math.PI / angles / 2;
  const largest = Math.max(...period.bound);
  const disc = { outlines: [], arrows: [], period, hottest: hottestCells(period, rims) };
  theta.forEach((angle, j) => {
    const turns = [angle - half, angle, angle + half];
    for (let i = 0; i < cells; i++) {
      const out = turns.map((t) => [rims[i + 1] * Math.cos(t), rims[i + 1] * Math.sin(t)]);
      const back = turns.slice().reverse().map((t) => [rims[i] * Math.cos(t), rims[i] * Math.sin(t)]);
      const ring = [...out, ...back, out[0]];
      disc.outlines.push([ring.map((p) => p[0]), ring.map((p) => p[1])]);
      const radius = period.radius[i];
      // On the inner rings every second, third, ... sector has an arrow.
      const every = Math.ceil(CLOSEST / (2 * half * radius));
      const between = i === 0 ? radius : radius - period.radius[i - 1];
      const arrow = [radius * Math.cos(angle), radius * Math.sin(angle), (LONGEST * period.bound[i]) / largest];
      disc.arrows.push(j % every || (between < CLOSEST / 2 && i % 2) ? null : arrow);
    }
  });
  return disc;
}

// Returns the indices of the smallest set of cells in half the disc that dissipates half the
// energy.
function hottestCells({ densities, cells }, rims) {
  const energy = densities.map((one, k) => one * (rims[(k % cells) + 1] ** 2 - rims[k % cells] ** 2));
  const enough = energy.reduce((all, one) => all + one, 0) / 2;
  let sum = 0;
  return densities.map((one, k) => k).sort((a, b) => densities[b] - densities[a]).filter((k) => {
    const needed = sum < enough;
    sum += energy[k];
    return needed;
  });
}

// Returns the outlines of the hottest cells in both halves of the disc, as one line with gaps.
function hottestLines({ outlines, hottest, period }) {
  const half = period.densities.length;
  const every = hottest.flatMap((k) => [outlines[k], outlines[k + half]]);
  return [0, 1].map((axis) => every.flatMap((ring) => [...ring[axis], null]));
}

// Returns the outlines of all slipping or all sticking cells, as one line with gaps.
function filled(disc, cells, slipping) {
  const x = [], y = [];
  disc.outlines.forEach(([xs, ys], k) => {
    if (cells.slips[k] !== slipping) return;
    x.push(...xs, null);
    y.push(...ys, null);
  });
  return x.length ? [x, y] : [[NaN], [NaN]]; // keeps the entry in the legend
}

// Returns the arrows as one line with gaps. An arrow has a shaft and two barbs at the tip.
function arrowLines(disc, cells) {
  const x = [], y = [];
  disc.arrows.forEach((arrow, k) => {
    if (arrow === null) return;
    const dx = arrow[2] * cells.lateral[k], dy = arrow[2] * cells.forward[k];
    const tip = [arrow[0] + dx / 2, arrow[1] + dy / 2];
    const barb = (sign) => [tip[0] - 0.3 * dx - sign * 0.18 * dy, tip[1] - 0.3 * dy + sign * 0.18 * dx];
    const [left, right] = [barb(1), barb(-1)];
    x.push(arrow[0] - dx / 2, tip[0], null, left[0], tip[0], right[0], null);
    y.push(arrow[1] - dy / 2, tip[1], null, left[1], tip[1], right[1], null);
  });
  return [x, y];
}

function drawDisc(element, disc, frame) {
  const cells = cellsOf(disc.period, frame);
  const parts = [filled(disc, cells, false), filled(disc, cells, true), arrowLines(disc, cells)];
  const area = (name, color, [x, y]) => ({
    type: "scatter", mode: "lines", fill: "toself", name, x, y, fillcolor: color,
    line: { color: "#fff", width: 0.6 }, hoverinfo: "skip",
  });
  const turns = Array.from({ length: 121 }, (_, k) => (k * Math.PI) / 60);
  const hottest = hottestLines(disc), square = { range: [-1.06, 1.06], dtick: 0.5, showgrid: false, constrain: "domain" };
  Plotly.react(element, [
    area("sticks", STICK, parts[0]),
    area("slips", SLIP, parts[1]),
    { type: "scatter", mode: "lines", name: "traction on the flat", x: parts[2][0], y: parts[2][1],
      line: { color: INK, width: 1.3 }, hoverinfo: "skip" },
    { type: "scatter", mode: "lines", name: "half of the heat", x: hottest[0], y: hottest[1],
      line: { color: VERMILLION, width: 1 }, hoverinfo: "skip" },
    { type: "scatter", mode: "lines", x: turns.map(Math.cos), y: turns.map(Math.sin),
      line: { color: INK, width: 1.2 }, hoverinfo: "skip", showlegend: false },
  ], layout({
    xaxis: axis("lateral position / <i>a</i>", square),
    yaxis: axis("forward position / <i>a</i>", { ...square, scaleanchor: "x" }),
    legend: { ...LEGEND, font: { size: 10 } },
    margin: { l: 48, r: 10, t: BAR + 22, b: 42 },
    dragmode: false,
  }), config());
}

// Draws another phase by changing three of the lines.
function moveDisc(element, disc, frame) {
  const cells = cellsOf(disc.period, frame);
  const parts = [filled(disc, cells, false), filled(disc, cells, true), arrowLines(disc, cells)];
  Plotly.restyle(element, { x: parts.map((p) => p[0]), y: parts.map((p) => p[1]) }, [0, 1, 2]);
}
