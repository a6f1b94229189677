// Converts the entries of the form for a real contact to a point on the map and to friction in SI
// units.
//
// `SI` has the fields, units, materials, rules and texts that contact_form.py packs.

const SI = NUMBERS.si;

// Error for invalid input, with a one-line message.
class Refusal extends Error {}

function refuse(name, value, allowed) {
  throw new Refusal(`${name} = ${value}: ${allowed}`);
}

function sum(values) {
  return values.reduce((all, one) => all + one, 0);
}

// Returns the value of a field in its SI unit.
function siValue(id, texts) {
  const field = SI.fields[id], text = texts[id].trim(), unit = texts[`${id}_unit`];
  const value = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) * SI.units[unit] : NaN;
  if (!(value > field.low || (field.zero && value === field.low)) || value > (field.high ?? Number.MAX_VALUE)) {
    const high = field.high === null ? "" : ` and at most ${field.high}`;
    refuse(field.label, `'${text} ${unit}'`.replace(" '", "'"), `allowed is one number, such as ` +
      `${field.example}, ${field.zero ? "at least" : "above"} ${field.low}${high}`);
  }
  return value;
}

// Returns a body by name, or by Young's modulus (infinite for a rigid body) and Poisson's ratio.
function bodyOf(side, texts) {
  const known = SI.materials[texts[side]];
  if (known) return { ...known, young: known.young ?? Infinity };
  const [young, poisson] = SI.sides[side].map((id) => siValue(id, texts));
  return { young, poisson, density: null, hardness: null };
}

// Returns the Hertzian contact of a sphere and a flat, with its point on the map (see
// si/contact.py).
function contactOf(texts) {
  const { motion } = texts, turns = motion === "bore", bodies = Object.keys(SI.sides).map((side) => bodyOf(side, texts));
  const [radius, load, mu, speed, frequency] =
    ["radius", "load", "mu", "speed", "frequency"].map((id) => siValue(id, texts));
  const swing = siValue(SI.amplitude_of[motion], texts), omega = 2 * Math.PI * frequency;
  if (bodies.every((body) => body.young === Infinity)) {
    refuse("the flat", "rigid", "allowed is an elastic one for a rigid sphere");
  }
  const shear = bodies.map((body) => body.young / (2 * (1 + body.poisson)));
  const compliances = shear.map((one) => 1 / one);
  const poisson = sum(bodies.map((body, k) => (body.poisson * compliances[k]) / sum(compliances)));
  const stiffness = 1 / sum(bodies.map((body) => (1 - body.poisson ** 2) / body.young));
  const a = ((0.75 * load * radius) / stiffness) ** (1 / 3), indentation = (a * a) / radius;
  const u_lim = (mu * indentation * stiffness * (2 - poisson) * sum(compliances)) / 4;
  if (!(a < SI.largest_share * radius && u_lim > 0)) {
    refuse(SI.fields.radius.label, `${digits(radius)} m`, `the contact radius would be ${digits(a / radius, 2)} of it; ` +
      `allowed is less than ${SI.largest_share}`);
  }
  const unlike = sum(bodies.map((body, k) => ((k ? -1 : 1) * (1 - 2 * body.poisson)) / shear[k]));
  const twist = ((4 / Math.PI) * SI.half_stuck) / (2 - poisson);
  const reach = turns ? swing * a : swing; // amplitude at the edge of the contact
  return {
    motion, bodies, shear, poisson, stiffness, radius, load, mu, speed, omega, swing, a, indentation, u_lim, reach,
    velocity: speed === 0 ? 0 : speed / (omega * (turns ? reach : u_lim)),
    amplitude: reach / u_lim / (turns ? twist : 1),
    pressure: (1.5 * load) / (Math.PI * a * a),
    mismatch: Math.abs((0.5 * unlike) / sum(bodies.map((body, k) => (1 - body.poisson) / shear[k]))),
  };
}

// Returns the quantities that the rules use, by name (see si/warnings.py). Unknown quantities are
// omitted.
function measuresOf(contact) {
  const { motion, bodies, shear, a, pressure, radius, load, mu, u_lim, stiffness, speed, omega, swing, reach } = contact;
  const { adhesion, range, short, rubbery } = SI.adhesion;
  const tabor = ((adhesion ** 2 * radius) / (stiffness ** 2 * range ** 3)) ** (1 / 3);
  const pull = (tabor > short ? 1.5 : 2) * Math.PI * adhesion * radius;
  const along = motion === "bore" ? 0 : swing, hard = bodies.map((body) => body.hardness).filter((one) => one !== null);
  const values = {
    largest_pressure: pressure, hardness: Math.min(...hard), over_radius: a / radius, over_smallest_radius: a / radius, mismatch: contact.mismatch, load, u_lim, mu, tabor,
    rubbers: bodies.filter((body) => body.poisson >= rubbery && body.young !== Infinity).length,
    maugis: 1.157 * tabor, pull_off: pull, pull_off_share: pull / load, amplitude: along, stroke: along / a,
  };
  const soft = bodies.filter((body) => body.hardness === null && body.young !== Infinity && body.poisson < rubbery);
  if (soft.length) values.soft_pressure = pressure / Math.min(...soft.map((body) => body.young));
  const waves = bodies.flatMap(({ density, young }, k) =>
    density === null || young === Infinity ? [] : [Math.sqrt(shear[k] / density)]);
  if (!waves.length) return values;
  const wave = Math.min(...waves);
  return { ...values, crossing: (omega * a) / wave, slip_speed: (speed + omega * reach) / wave };
}

// Returns the warnings and the checks that are not possible. In each group of rules, only the first
// rule that applies gives a warning.
function warningsOf(contact) {
  const measures = measuresOf(contact), value = (side) => (typeof side === "string" ? measures[side] : side);
  const applies = (rule) => rule.where.every(([left, factor, right]) => value(left) > factor * value(right));
  const number = (_, name, count, unit) =>
    unit ? inUnit(measures[name], unit, Number(count)) : digits(measures[name], Number(count));
  const warnings = SI.checks.flatMap((rules) => rules.find(applies) ?? [])
    .map(({ text }) => `Warning: ${text.replace(/\{(\w+):\.(\d+)g\}(?: (Pa|N|m)\b)?/g, number)}`);
  const unchecked = Object.entries(SI.properties).flatMap(([name, what]) => {
    const whose = SI.whose.filter((_, k) => contact.bodies[k][name] === null && contact.bodies[k].young !== Infinity);
    const text = SI.missing.replace("{what}", what).replace("{name}", name).replace("{whose}", whose.join(" and "));
    return whose.length ? [`Not checked: ${text}`] : [];
  });
  return [...warnings, ...unchecked];
}

// Interpolates friction and its error bound in a table linearly along each axis. Returns null
// outside the table.
function lookUp(table, velocity, amplitude, poisson) {
  const ends = [table.velocity.map(Math.log), table.amplitude, table.poisson];
  const place = [Math.log(velocity), amplitude, poisson].map((at, d) => {
    const [low, high] = ends[d], share = high > low ? (at - low) / (high - low) : Math.abs(at - low) < 1e-9 ? 0 : NaN;
    return share > 1 && share < 1 + 1e-9 ? table.counts[d] - 1 : share * (table.counts[d] - 1);
  });
  if (!place.every((at, d) => at >= 0 && at <= table.counts[d] - 1)) return null;
  const [columns, rows, sheets] = table.counts;
  const cell = place.map((at, d) => Math.min(Math.floor(at), Math.max(table.counts[d] - 2, 0)));
  table.decoded ??= [table.values, table.errors].map((text) => new Uint16Array(bytesOf(text).buffer));
  let value = 0;
  for (let corner = 0; corner < 8; corner++) {
    const [i, j, k] = cell.map((at, d) => at + ((corner >> d) & 1));
    const weight = place.reduce((all, at, d) => all * ((corner >> d) & 1 ? at - cell[d] : 1 - at + cell[d]), 1);
    if (weight > 0) value += weight * table.decoded[0][(k * rows + j) * columns + i];
  }
  const [i, j, k] = cell, error = table.decoded[1][(k * (rows - 1) + j) * (columns - 1) + i];
  return error === 65535 ? null : { value: value / 65535, error: error * table.error_step };
}

// Returns the command that computes a contact. The command also works outside the range of the
// maps.
function commandOf(texts) {
  const quoted = (id) => {
    const text = `${texts[id].trim()} ${texts[`${id}_unit`]}`.trim();
    return text.includes(" ") ? `"${text}"` : text;
  };
  const words = ["microslip predict", texts.motion, "--radius", quoted("radius"), "--load", quoted("load")];
  const [young, nu] = SI.sides.material, [counter, counter_nu] = SI.sides.counterbody;
  words.push(...(SI.materials[texts.material] ? ["--material", texts.material]
    : ["--young", quoted(young), "--nu", quoted(nu)]));
  words.push("--counterbody", SI.materials[texts.counterbody] ? texts.counterbody
    : `"${quoted(counter).replaceAll('"', "")}, ${quoted(counter_nu)}"`);
  for (const id of ["mu", "speed", "frequency"]) words.push(`--${id}`, quoted(id));
  return [...words, "--amplitude", quoted(SI.amplitude_of[texts.motion])].join(" ");
}

// Returns the largest unit prefix with which a value is at least 1, and the size of the prefix.
function prefixOf(value) {
  return SI.prefixes.find(([, size]) => (Math.abs(value) || 1) >= size) ?? SI.prefixes.at(-1);
}

function inUnit(value, unit, count = 4) {
  const [prefix, size] = prefixOf(value);
  return `${digits(value / size, count)} ${prefix}${unit}`;
}
