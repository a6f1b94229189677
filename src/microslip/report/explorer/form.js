// The form for a real contact: the fields, and the text of the answer.

const SI = NUMBERS.si;
const TEXTS = {}; // contents of the form, by field name
const ONE_COLUMN = matchMedia("(max-width: 1199px)"); // as in style.css

// Sets a field of the form. Unknown fields and choices are ignored.
function fillField(id, text) {
  if (!(id in TEXTS)) return;
  const control = element(`si-${id}`), before = control.value;
  control.value = text;
  if (control.value === text) TEXTS[id] = text;
  else control.value = before;
}

// Position of the form's contact on a map: [velocity, amplitude], or null for another motion.
function contactOn(map) {
  const { contact } = STATE;
  const same = contact && contact.motion === map.motion && map.pressure === "hertz";
  return same && contact.velocity > 0 ? [contact.velocity, contact.amplitude] : null;
}

function inUnit(value, unit) {
  const [prefix, size] = prefixOf(SI, value);
  return `${digits(value / size)} ${prefix}${unit}`;
}

// A value with its significant digits.
function withError(value, error) {
  if (!Number.isFinite(error)) return "not known";
  const places = clipped(1 - Math.floor(Math.log10(error)), 0, 8);
  return error < 1e-8 ? digits(value, 6) : `${value.toFixed(places)} ± ${error.toPrecision(2)}`;
}

function labelled(label, ...controls) {
  const row = document.createElement("div"), name = document.createElement("label");
  row.className = "field";
  name.textContent = label;
  name.htmlFor = controls[0].id;
  row.append(name, ...controls);
  return row;
}

function choice(id, label, options) {
  const select = document.createElement("select");
  select.id = `si-${id}`;
  select.setAttribute("aria-label", label);
  select.append(...options.map(([value, text]) => optionOf(value, text)));
  select.addEventListener("change", () => {
    TEXTS[id] = select.value;
    answerForm();
  });
  return select;
}

// An input for a number, with a list of units.
function quantity(id) {
  const field = SI.fields[id], input = document.createElement("input");
  Object.assign(input, { id: `si-${id}`, type: "text", value: field.example });
  input.setAttribute("inputmode", "decimal");
  input.setAttribute("autocomplete", "off");
  Object.assign(TEXTS, { [id]: field.example, [`${id}_unit`]: field.units[0].name });
  input.addEventListener("input", () => {
    TEXTS[id] = input.value;
    answerForm();
  });
  const units = choice(`${id}_unit`, `unit: ${field.label}`, field.units.map(({ name }) => [name, name]));
  units.hidden = field.units.length < 2;
  return labelled(field.label, input, units);
}

function offerContact() {
  const rows = {};
  const bodies = [...Object.keys(SI.materials), SI.of_numbers];
  const chosen = (id, label, options) => {
    const control = choice(id, label, options);
    control.value = TEXTS[id] = SI.chosen[id];
    return labelled(label, control);
  };
  rows.motion = chosen("motion", "motion", Object.entries(SI.motions));
  rows.material = chosen("material", "sphere", bodies.map((name) => [name, name]));
  rows.counterbody = chosen("counterbody", "flat", bodies.map((name) => [name, name]));
  for (const id of Object.keys(SI.fields)) rows[id] = quantity(id);
  const bodiesFirst = ["motion"];
  for (const [side, fields] of Object.entries(SI.sides)) bodiesFirst.push(side, ...fields);
  const others = Object.keys(SI.fields).filter((id) => !bodiesFirst.includes(id));
  element("contact-form").append(...[...bodiesFirst, ...others].map((id) => rows[id]));
  element("contact-form").addEventListener("submit", (e) => e.preventDefault());
  offerContact.rows = rows;
  element("ask").addEventListener("click", () => {
    STATE.asking = !STATE.asking;
    arrange();
    if (STATE.asking) {
      answerForm();
      redraw();
      // In one column the page scrolls to the form.
      if (ONE_COLUMN.matches) element("contact-view").scrollIntoView?.({ block: "start" });
    } else {
      STATE.contact = null;
      redraw();
    }
    writeLink();
  });
}

// Hides the fields that are not necessary.
function showFields() {
  const { rows } = offerContact;
  for (const [side, fields] of Object.entries(SI.sides)) {
    for (const id of fields) rows[id].hidden = TEXTS[side] !== SI.of_numbers;
  }
  for (const [motion, id] of Object.entries(SI.amplitude_of)) rows[id].hidden = motion !== TEXTS.motion;
}

function answerForm() {
  showFields();
  writeLink();
  STATE.contact = null;
  try {
    STATE.contact = answerOf(SI, NUMBERS.certified, questionOf(SI, TEXTS));
    tellContact(STATE.contact);
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    paragraph("contact-value", error.message, true);
    paragraph("contact-note", "");
    paragraph("contact-still", "");
    table("contact-facts", []);
    element("contact-warnings").replaceChildren();
  }
  const own = SWEEPS.find((one) => one.kind === "map" && one.motion === TEXTS.motion && one.pressure === "hertz");
  const shown = STATE.map === STATE.shown && STATE.map.motion === TEXTS.motion && STATE.map.pressure === "hertz";
  if (own && !shown) {
    show(own.entries[0]);
  } else if (own) {
    drawMap(element("map"), STATE.map, STATE.row, STATE.column, contactOn(STATE.map));
  }
}

function tellContact(said) {
  const { friction, static_friction, near } = said;
  if (friction) {
    const times = (factor) => withError(factor * friction.value, factor * friction.error);
    const [prefix, size] = prefixOf(SI, said.still);
    paragraph("contact-value", `Coefficient of friction ${times(said.mu)} with vibration, instead of ` +
      `${digits(said.mu)}: a force of ${times(said.still / size)} ${prefix}N, instead of ${inUnit(said.still, "N")}`);
    paragraph("contact-note", `Ratio of both (mu_macro): ${withError(friction.value, friction.error)}; ` +
      `source: ${friction.source}.${approach(said)}${outside(said)}`);
  } else {
    const at = near ? ` At Poisson's ratio ${digits(near.poisson)} the ratio mu_macro would be ` +
      `${withError(near.value, near.error)}; what Poisson's ratio changes is not in that error.` : "";
    paragraph("contact-value", `No certified friction: ${said.refused}.`, true);
    paragraph("contact-note", at.trim() + outside(said));
  }
  paragraph("contact-still", static_friction ? `Coefficient at vanishing speed: ` +
    `${withError(said.mu * static_friction.value, said.mu * static_friction.error)}.` : "");
  table("contact-facts", [
    ["velocity (dimensionless)", digits(said.velocity)],
    ["amplitude (dimensionless)", digits(said.amplitude)],
    ["Poisson's ratio of both bodies as one", digits(said.poisson)],
    ["slides all over at u_lim", inUnit(said.u_lim, "m")],
    ["contact radius", inUnit(said.contact_radius, "m")],
    ["indentation", inUnit(said.indentation, "m")],
    ["largest pressure", inUnit(said.largest_pressure, "Pa")],
  ]);
  const lines = [...said.warnings.map((text) => `Warning: ${text}`),
    ...said.not_checked.map((text) => `Not checked: ${text}`)];
  element("contact-warnings").replaceChildren(...lines.map((text) => {
    const item = document.createElement("li");
    item.textContent = text;
    return item;
  }));
}

// A speed in the unit of the form.
function inSpeedUnit(speed) {
  const { units } = SI.fields.speed, unit = units.find(({ name }) => name === TEXTS.speed_unit) ?? units[0];
  return `${digits(speed / unit.factor)} ${unit.name}`;
}

// For a contact slower than its map: both coefficients of the interpolation, and their speeds.
function approach({ friction, slowest, static_friction, mu }) {
  const remedy = friction.error > slowest.map_error && OUTSIDE_MAP.test(friction.source)
    ? " Outside the certified range: microslip predict computes it to any tolerance." : "";
  if (!["between static limit and map", "static limit"].includes(friction.source) || !slowest.friction) return remedy;
  const coefficient = ({ value, error }) => withError(mu * value, mu * error);
  return ` The map begins at a forward speed of ${inSpeedUnit(slowest.speed)} for this contact, where the coefficient is ` +
    `${coefficient(slowest.friction)}; towards speed 0 it falls to ${coefficient(static_friction)}.${remedy}`;
}

const OUTSIDE_MAP = /^between /;

// Returns a sentence that states where the star of the contact is on the map, or that it is outside.
function outside({ motion, velocity, amplitude, poisson }) {
  const map = NUMBERS.maps.find((one) => one.motion === motion && one.pressure === "hertz");
  if (map === undefined) return "";
  const fast = map.velocity[map.velocity.length - 1], wide = map.amplitude[map.amplitude.length - 1];
  const slow = map.velocity.find((one) => one > 0);
  const off = velocity < slow || velocity > fast || amplitude > wide || amplitude < map.amplitude[0];
  if (off) return " The point lies outside of the map that is drawn.";
  const other = map.poisson === poisson ? "" : `, which is drawn for Poisson's ratio ${digits(map.poisson)}`;
  return ` A star marks the point on the map${other}.`;
}
