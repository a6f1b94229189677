// The page: selection, controls and texts.

const element = (id) => document.getElementById(id);
const STATE = { shown: null, map: null, row: 0, column: 0, frame: 0, period: null, disc: null,
  at: 0, hidden: new Set(), asking: false, contact: null };
const SECONDS = 4; // duration of a period while playing
let playing = 0; // id of the next animation frame, 0 while paused

// Shows a sweep at one Poisson's ratio.
function show(entry) {
  pause();
  STATE.shown = entry;
  markSweep(entry);
  const isMap = entry.kind === "map";
  element("map-view").hidden = element("hint").hidden = !isMap;
  element("lines-view").hidden = isMap;
  arrange();
  if (isMap) {
    selectMap(entry);
  } else {
    paragraph("lines-title", entry.title);
    drawLines(element("lines-chart"), entry);
    element("along").max = entry.x.values.length - 1;
    paragraph("along-label", plainText(entry.x.label));
    selectOnLine(entry.x.values.length >> 1);
  }
}

// Returns a label without HTML.
function plainText(label) {
  return label.replace(/<[^>]*>/g, "");
}

// Shows all values at a point of a line, with errors, and the limits.
function selectOnLine(at) {
  const { shown } = STATE, { x, y, series, limits, beside } = shown;
  STATE.at = at;
  element("along").value = at;
  element("along-value").value = digits(x.values[at]);
  const valueOf = ({ values, errors, converged }) => values[at] === null ? "none"
    : `${digits(values[at], 5)} ± ${errors[at] === null ? "unknown" : errors[at].toPrecision(2)}` +
      (converged === undefined || converged[at] ? "" : " (not converged)");
  const name = y.label === "mean velocity" ? y.label : "mu_macro";
  paragraph("line-value", series.length === 1 ? `${name} ${valueOf(series[0])}` : `${name}, ${series.length} lines`);
  const rows = series.length === 1 ? [] : series.map((one) => [one.label || "computed", valueOf(one)]);
  rows.push(...limits.map((given) => [given.label, digits(given.values[at], 5)]));
  for (const one of beside) {
    rows.push([one.label, valueOf(one)]);
    rows.push(...one.theory.map((given) => [given.label, digits(given.values[at], 5)]));
  }
  table("line-facts", rows);
  paragraph("line-note", `At ${plainText(x.label)} = ${digits(x.values[at])}, Poisson's ratio ${digits(shown.poisson)}.`);
  markLine(element("lines-chart"), x.values[at]);
  writeLink();
}

// Draws the selected sweep again after a change of the layout.
function redraw() {
  const { shown, map, row, column, at } = STATE;
  if (shown !== map) {
    show(shown);
    selectOnLine(at);
    return;
  }
  arrange();
  drawMap(element("map"), map, row, column, contactOn(map));
  select(row, column);
}

// Arranges the panels. An open form replaces the texts about the point.
function arrange() {
  const isMap = STATE.shown.kind === "map";
  // On a wide page with an open form or without periods, the cuts are on the right.
  const beside = isMap && !ONE_COLUMN.matches && (STATE.asking || !withPeriods(STATE.shown).length);
  const right = STATE.asking ? "contact-view" : "point-view";
  element(beside ? right : "map-view").append(element("cuts"));
  element("map").classList.toggle("tall", beside); // plotly adds its own class to this element
  element("lines-view").classList.toggle("wide", !STATE.asking);
  element("line-view").hidden = STATE.asking || isMap;
  element("contact-view").hidden = !STATE.asking;
  element("point-view").hidden = STATE.asking || !isMap;
  element("ask").setAttribute("aria-pressed", String(STATE.asking));
}

function selectMap(map) {
  STATE.map = map;
  element("amplitude").max = map.amplitude.length - 1;
  element("velocity").max = map.velocity.length - 1;
  offerLimits(map);
  // Select a point in the middle of the points with periods.
  const stored = withPeriods(map);
  const rows = [...new Set(stored.map((place) => place[0]))];
  const row = rows.length ? rows[rows.length >> 2] : map.amplitude.length >> 1;
  const columns = stored.filter((place) => place[0] === row);
  const column = columns.length ? columns[columns.length >> 1][1] : map.velocity.length >> 1;
  drawMap(element("map"), map, row, column, contactOn(map));
  select(row, column);
}

function select(row, column) {
  Object.assign(STATE, { row, column });
  const { map } = STATE;
  const sliders = { amplitude: row, velocity: column };
  for (const [name, index] of Object.entries(sliders)) {
    const shown = digits(map[name][index]);
    element(name).value = index;
    element(name).setAttribute("aria-valuetext", shown);
    element(`${name}-value`).value = shown;
  }
  drawCuts();
  // For a point without a period, the period of the nearest point is drawn, with a note.
  const place = periodAt(map, row, column) ? [row, column] : nearestPeriod(map, row, column);
  STATE.period = place && periodAt(map, ...place);
  STATE.disc = STATE.period && discOf(STATE.period);
  tell(place);
  writeLink();
  element("inside").hidden = STATE.period === null;
  if (!STATE.period || STATE.asking) {
    pause(); // a hidden panel has no size, so nothing can be drawn in it
    return;
  }
  const { mu_macro, mu_macro_error } = map.points;
  STATE.frame = Math.min(STATE.frame, STATE.period.frames);
  element("phase").max = STATE.period.frames;
  drawForces(element("history"), element("loop"), STATE.period, mu_macro[place[0]][place[1]],
    mu_macro_error[place[0]][place[1]], STATE.frame);
  drawDisc(element("disc"), STATE.disc, STATE.frame);
  tellPhase();
}

// Returns [row, column] for each point of the map with a period.
function withPeriods(map) {
  return (map.periods ?? []).flatMap((line, i) =>
    line.flatMap((stored, j) => (stored?.tractions ? [[i, j]] : [])));
}

// Returns [row, column] of the nearest point of the map with a period, or null if there are no
// periods.
function nearestPeriod(map, row, column) {
  const distance = ([i, j]) => Math.hypot(i - row, j - column);
  return withPeriods(map).sort((a, b) => distance(a) - distance(b))[0] ?? null;
}

function selectAndMark(row, column) {
  select(row, column);
  markMap(element("map"), STATE.map, row, column);
}

function drawCuts() {
  const { map, row, column, hidden } = STATE;
  drawCut(element("along-velocity"), map, "velocity", row, column, hidden);
  drawCut(element("along-amplitude"), map, "amplitude", column, row, hidden);
}

function showFrame(frame) {
  STATE.frame = frame;
  moveDisc(element("disc"), STATE.disc, frame);
  markForces(element("history"), element("loop"), STATE.period, frame);
  tellPhase();
}

function tellPhase() {
  const shown = `${inDegrees(STATE.period.phase[STATE.frame]).toFixed(0)}°`;
  element("phase").value = STATE.frame;
  element("phase").setAttribute("aria-valuetext", shown);
  element("phase-value").value = shown;
}

// Texts

function paragraph(id, text, bad = false) {
  element(id).textContent = text;
  element(id).className = bad ? "bad" : "";
}

// drawn: row and column of the drawn period, or null.
function tell(drawn) {
  const { map, row, column, period } = STATE;
  const at = (name) => map.points[name][row][column];
  paragraph("value", muText(map, row, column));
  const place = `velocity ${digits(map.velocity[column])}, amplitude ${digits(map.amplitude[row])}, ` +
    `Poisson's ratio ${digits(map.poisson)}`;
  const sources = Object.entries(NUMBERS.errors).filter(([name]) => map.points[name]);
  paragraph("certificate", !at("converged") ? `At ${place}; not converged: ${at("reason")}`
    : `At ${place}; converged.${sources.length ? " Its error by source:" : ""}`, !at("converged"));
  table("sources", sources.map(([name, source]) => [source, digits(at(name), 2)]));
  const energy = !map.points.dissipated_energy ? "" : ` In a period, friction dissipates ` +
    `${digits(at("dissipated_energy"))} ± ${digits(at("dissipated_energy_error"), 2)} μF_z u_lim.`;
  const counts = [["cells", "rings"], ["angles", "angles on half a ring"],
    ["steps_per_period", "steps in a period"]].filter(([name]) => map.points[name] && at(name) > 1);
  const model = [`Model ${at("model")}`, ...counts.map(([name, word]) => `${at(name)} ${word}`)].join(", ");
  const limits = map.limits.map((given) => `${given.label} ${digits(limitAt(given, row, column))}`);
  paragraph("spent", `${model}.${energy}`);
  paragraph("theory", limits.length ? `Theory here: ${limits.join("; ")}.` : "");
  if (!period) {
    const missing = map.periods !== null && map.amplitude[row] > 0 && map.velocity[column] > 0;
    paragraph("run", whyNone(map, row, column), missing);
    return;
  }
  if (drawn[0] !== row || drawn[1] !== column) {
    paragraph("run", `${whyNone(map, row, column)} Drawn below: the nearest point that has a period, at velocity ` +
      `${digits(map.velocity[drawn[1]])}, amplitude ${digits(map.amplitude[drawn[0]])}.`);
    return;
  }
  const run = `Drawn below: one run of the polar model, ${period.cells} rings, ${2 * period.angles} angles, ` +
    `${period.frames} steps; its mean is ${period.mu_macro.toFixed(4)}.`;
  paragraph("run", period.converged ? run : `${run} It did not converge: ${period.reason}`,
    !period.converged);
}

function table(id, rows) {
  const body = document.createElement("table");
  for (let k = 0; k < rows.length; k += 2) {
    const line = body.insertRow();
    for (const [name, value] of rows.slice(k, k + 2)) {
      const head = document.createElement("th");
      head.textContent = name;
      line.append(head);
      line.insertCell().textContent = value;
    }
  }
  element(id).replaceChildren(body);
}

function limitAt(given, row, column) {
  if (given.dims.length === 2) return given.values[row][column];
  return given.values[given.dims[0] === "amplitude" ? row : column];
}

function tellWhatMade() {
  const texts = NUMBERS.made.map((text) => Object.assign(document.createElement("pre"), { textContent: text }));
  element("made").append(...texts);
}

// Controls

function pause() {
  cancelAnimationFrame(playing);
  playing = 0;
  element("play").textContent = "Play";
  element("play").setAttribute("aria-pressed", "false");
}

function play() {
  element("play").textContent = "Pause";
  element("play").setAttribute("aria-pressed", "true");
  const start = STATE.period.phase[0];
  let phase = STATE.period.phase[STATE.frame] - start, before = performance.now();
  const next = (now) => {
    phase = (phase + ((now - before) / 1000 / SECONDS) * 2 * Math.PI) % (2 * Math.PI);
    before = now;
    // Frames are closer together near the turning points.
    const begun = STATE.period.phase.filter((at) => at - start <= phase).length;
    if (begun - 1 !== STATE.frame) showFrame(Math.max(begun - 1, 0));
    playing = requestAnimationFrame(next);
  };
  playing = requestAnimationFrame(next);
}

function connect() {
  offerSweeps(show);
  element("amplitude").addEventListener("input", (e) => selectAndMark(Number(e.target.value), STATE.column));
  element("velocity").addEventListener("input", (e) => selectAndMark(STATE.row, Number(e.target.value)));
  element("phase").addEventListener("input", (e) => {
    pause();
    showFrame(Number(e.target.value));
    writeLink();
  });
  element("along").addEventListener("input", (e) => selectOnLine(Number(e.target.value)));
  element("play").addEventListener("click", () => (playing ? pause() : play()));
}

// Makes the legend of the cuts, with a check box for each limit.
function offerLimits(map) {
  const boxes = map.limits.map((given) => {
    const label = document.createElement("label"), box = document.createElement("input");
    Object.assign(box, { type: "checkbox", checked: !STATE.hidden.has(given.label) });
    box.addEventListener("change", () => {
      STATE.hidden[box.checked ? "delete" : "add"](given.label);
      drawCuts();
      writeLink();
    });
    label.title = given.long_name;
    label.append(box, lineLike(given), given.label);
    return label;
  });
  element("limits").replaceChildren(...boxes);
}

// Returns a sample of the line of a limit.
function lineLike(given) {
  const svg = (name) => document.createElementNS("http://www.w3.org/2000/svg", name);
  const piece = svg("svg"), line = svg("line");
  const looks = { x1: 0, x2: 26, y1: 5, y2: 5, stroke: given.color, "stroke-width": 2 };
  if (given.dash !== "solid") looks["stroke-dasharray"] = given.dash.replace(/px/g, "");
  for (const [name, value] of Object.entries(looks)) line.setAttribute(name, value);
  piece.setAttribute("aria-hidden", "true");
  piece.append(line);
  return piece;
}

// Plotly adds its events to an element when it first draws there.
function connectCharts() {
  element("map").on("plotly_click", ({ points }) => {
    const cell = points.find((point) => point.data.type === "heatmap");
    if (cell) selectAndMark(cell.pointIndex[0], shownColumns(STATE.map)[cell.pointIndex[1]]);
  });
  const along = (id, choose) => element(id).on("plotly_click", ({ points }) => {
    const point = points.find((candidate) => candidate.customdata !== undefined);
    if (point) choose(point.customdata);
  });
  along("along-velocity", (column) => selectAndMark(STATE.row, column));
  along("along-amplitude", (row) => selectAndMark(row, STATE.column));
}

tellWhatMade();
connect();
offerContact();
show(SWEEPS[0].entries[0]);
connectCharts();
PHONE.addEventListener("change", redraw);
ONE_COLUMN.addEventListener("change", redraw);
readLink(location.hash);
addEventListener("hashchange", () => readLink(location.hash));
document.body.dataset.ready = "yes";
