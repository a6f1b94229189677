// The form for a real contact: the fields, and the text of the result.

const TEXTS = {}; // contents of the form, by field name
const ROWS = {}; // elements of the fields
const ONE_COLUMN = matchMedia("(max-width: 1199px)"); // as in style.css

// Sets a field of the form. Unknown fields and choices are ignored.
function fillField(id, text) {
  if (!(id in TEXTS)) return;
  const control = element(`si-${id}`), before = control.value;
  control.value = text;
  if (control.value === text) TEXTS[id] = text;
  else control.value = before;
}

// Returns the position [velocity, amplitude] of the form's contact on a map, or null if the map is
// of another motion.
function contactOn(map) {
  const { contact } = STATE;
  const same = contact && contact.motion === map.motion && map.pressure === "hertz";
  return same && contact.velocity > 0 ? [contact.velocity, contact.amplitude] : null;
}

// Formats the significant digits of a value, followed by the error.
function withError(value, error) {
  const places = Math.min(Math.max(1 - Math.floor(Math.log10(error)), 0), 8);
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

// Returns an input for a number, with a list of units.
function quantity(id) {
  const field = SI.fields[id], input = document.createElement("input");
  Object.assign(input, { id: `si-${id}`, type: "text", value: field.example });
  input.setAttribute("inputmode", "decimal");
  input.setAttribute("autocomplete", "off");
  Object.assign(TEXTS, { [id]: field.example, [`${id}_unit`]: field.units[0] });
  input.addEventListener("input", () => {
    TEXTS[id] = input.value;
    answerForm();
  });
  const units = choice(`${id}_unit`, `unit: ${field.label}`, field.units.map((name) => [name, name]));
  units.hidden = field.units.length < 2;
  return labelled(field.label, input, units);
}

function offerContact() {
  const bodies = [...Object.keys(SI.materials), SI.of_numbers].map((name) => [name, name]);
  const lists = { motion: ["motion", Object.entries(SI.motions)], material: ["sphere", bodies], counterbody: ["flat", bodies] };
  for (const [id, [label, options]] of Object.entries(lists)) {
    const control = choice(id, label, options);
    control.value = TEXTS[id] = SI.chosen[id];
    ROWS[id] = labelled(label, control);
  }
  for (const id of Object.keys(SI.fields)) ROWS[id] = quantity(id);
  const first = ["motion", ...Object.entries(SI.sides).flat(2)];
  const order = [...first, ...Object.keys(SI.fields).filter((id) => !first.includes(id))];
  element("contact-form").append(...order.map((id) => ROWS[id]));
  element("contact-form").addEventListener("submit", (e) => e.preventDefault());
  element("ask").addEventListener("click", () => {
    STATE.asking = !STATE.asking;
    STATE.contact = null;
    arrange();
    if (STATE.asking) answerForm();
    redraw();
    // In the layout with one column, the page scrolls to the form.
    if (STATE.asking && ONE_COLUMN.matches) element("contact-view").scrollIntoView?.({ block: "start" });
    writeLink();
  });
}

// Shows the result for the form, and marks the contact on the map of the motion.
function answerForm() {
  for (const [side, fields] of Object.entries(SI.sides)) {
    for (const id of fields) ROWS[id].hidden = TEXTS[side] !== SI.of_numbers;
  }
  for (const [motion, id] of Object.entries(SI.amplitude_of)) ROWS[id].hidden = motion !== TEXTS.motion;
  writeLink();
  STATE.contact = null;
  try {
    STATE.contact = contactOf(TEXTS);
    tellContact(STATE.contact);
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    paragraph("contact-value", error.message, true);
    for (const id of ["contact-note", "contact-command"]) paragraph(id, "");
    table("contact-facts", []);
    element("contact-warnings").replaceChildren();
  }
  const fits = (map) => map.motion === TEXTS.motion && map.pressure === "hertz";
  const own = SWEEPS.find((one) => one.kind === "map" && fits(one));
  if (own && !(STATE.map === STATE.shown && fits(STATE.map))) show(own.entries[0]);
  else if (own) drawMap(element("map"), STATE.map, STATE.row, STATE.column, contactOn(STATE.map));
}

function tellContact(contact) {
  const { motion, velocity, amplitude, poisson, mu, load } = contact, still = mu * load;
  const fits = NUMBERS.certified.filter((one) => one.motion === motion);
  const answers = fits.map((one) => lookUp(one, velocity, amplitude, poisson)).filter((one) => one !== null);
  const friction = amplitude === 0 ? { value: 1, error: 0 } : answers.sort((a, b) => a.error - b.error)[0];
  if (friction) {
    const times = (factor) => withError(factor * friction.value, factor * friction.error);
    const [prefix, size] = prefixOf(still);
    paragraph("contact-value", `Coefficient of friction ${times(mu)} with vibration, instead of ${digits(mu)}: ` +
      `a force of ${times(still / size)} ${prefix}N, instead of ${inUnit(still, "N")}`);
    paragraph("contact-note", `Ratio of both (mu_macro): ${withError(friction.value, friction.error)}, from a certified map.`);
  } else {
    const ranges = fits.map((one) => ["velocity", "amplitude", "poisson"].map((name) =>
      `${name} ${one[name].map((end) => digits(end)).join(" to ")}`).join(", "));
    paragraph("contact-value", ranges.length ? "This contact is outside the certified map of the page." :
      `The page has no certified map of ${motion}.`, true);
    paragraph("contact-note", ranges.length ? `The map: ${ranges.join("; or ")}.` : "");
  }
  paragraph("contact-command", commandOf(TEXTS));
  table("contact-facts", [
    ["velocity (dimensionless)", digits(velocity)],
    ["amplitude (dimensionless)", digits(amplitude)],
    ["Poisson's ratio of both bodies as one", digits(poisson)],
    ["slides all over at u_lim", inUnit(contact.u_lim, "m")],
    ["contact radius", inUnit(contact.a, "m")],
    ["indentation", inUnit(contact.indentation, "m")],
    ["largest pressure", inUnit(contact.pressure, "Pa")],
  ]);
  element("contact-warnings").replaceChildren(...warningsOf(contact).map((text) => {
    const item = document.createElement("li");
    item.textContent = text;
    return item;
  }));
}
