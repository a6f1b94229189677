// A real contact in SI units: converts the texts of the form to a point on the map, and returns its
// friction.
//
// The answers equal those of microslip.predict (si/bodies.py, dimensionless.py, validity.py). `si` has
// the materials, units, rules and messages that si_form.py packs.

// Parses a text as one number. Throws a Refusal for other texts.
function numberIn(label, text, example) {
  const given = text.trim();
  const allowed = `allowed is one number, such as ${example}`;
  const read = /^[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?/.exec(given);
  if (!given) refuse(label, "nothing", allowed);
  if (/[−–]/.test(given)) refuse(label, `'${given}'`, `its minus is no plain one (-); ${allowed}`);
  if (read === null) refuse(label, `'${given}'`, `stopped at its beginning; ${allowed}`);
  const rest = given.slice(read[0].length);
  if (rest) {
    const hint = rest.includes(",") ? ", since decimals follow a point and thousands have no separator" : "";
    refuse(label, `'${given}'`, `read ${read[0]} and stopped at '${rest.trim()}'${hint}; ${allowed}`);
  }
  return read[0];
}

// The value in its SI unit. Powers of ten are rounded once, as in Python.
function siValue(field, text, unitName) {
  const digits = numberIn(field.label, text, field.example);
  const unit = field.units.find((one) => one.name === unitName);
  const [mantissa, power] = digits.toLowerCase().split("e");
  const value = unit.power === null ? Number(digits) * unit.factor
    : Number(`${mantissa}e${Number(power ?? 0) + unit.power}`);
  const beyond = field.low_open ? value <= field.low : value < field.low;
  const zero = /^[+-]?[0.]*$/.test(mantissa);
  if (!Number.isFinite(value) || beyond || (field.high !== null && value > field.high) || (value === 0 && !zero)) {
    const low = `${field.low_open ? "above" : "at least"} ${general(field.low)}`;
    const high = field.high === null ? "" : ` and at most ${general(field.high)}`;
    refuse(field.label, `${digits} ${unitName}`.trim(), `allowed is a finite value ${low}${high}`);
  }
  return value;
}

// A body by its name, or by Young's modulus and Poisson's ratio. A rigid body has an infinite modulus.
function bodyOf(si, side, texts) {
  const name = texts[side];
  if (name in si.materials) return { ...si.materials[name], young: si.materials[name].young ?? Infinity };
  const value = (key) => siValue(si.fields[key], texts[key], texts[`${key}_unit`]);
  const [young, nu] = si.sides[side];
  return { young: value(young), poisson: value(nu), density: null, hardness: null };
}

// The request in SI units, from the texts of the form.
function questionOf(si, texts) {
  const value = (key) => siValue(si.fields[key], texts[key], texts[`${key}_unit`]);
  const bodies = Object.keys(si.sides).map((side) => bodyOf(si, side, texts));
  if (bodies.every((body) => body.young === Infinity)) {
    refuse("the counterbody", "rigid", "allowed is an elastic one for a rigid body");
  }
  const motion = texts.motion;
  return {
    motion,
    bodies,
    radius: value("radius"),
    load: value("load"),
    mu: value("mu"),
    speed: value("speed"),
    amplitude: value(si.amplitude_of[motion]),
    frequency: value("frequency"),
  };
}

// The Hertzian contact of a sphere and a flat, and its sliding force and displacement.
function contactOf(si, { bodies, radius, load, mu }) {
  const sum = (values) => values.reduce((all, one) => all + one, 0);
  const shear = bodies.map((body) => body.young / (2 * (1 + body.poisson)));
  const compliances = shear.map((modulus) => 1 / modulus);
  const poisson = sum(bodies.map((body, k) => body.poisson * (compliances[k] / sum(compliances))));
  const stiffness = 1 / sum(bodies.map((body) => (1 - body.poisson ** 2) / body.young));
  const tangential = ((4 / sum(compliances)) / (2 - poisson));
  const a = ((0.75 * load * radius) / stiffness) ** (1 / 3);
  const indentation = (a * a) / radius;
  if (a >= si.senseless * radius) {
    refuse("the radius of the sphere", `${general(radius)} m`, "by Hertz's theory, which is for contacts much " +
      `smaller than either body, the contact radius would be ${general(a, 3)} m, ` +
      `${general(a / radius, 2)} of it; allowed is less than ${general(si.senseless)}`);
  }
  const unlike = sum(bodies.map((body, k) => ((k ? -1 : 1) * (1 - 2 * body.poisson)) / shear[k]));
  const found = {
    bodies,
    shear,
    poisson,
    stiffness,
    radius,
    load,
    mu,
    a,
    indentation,
    pressure: (1.5 * load) / (Math.PI * a * a),
    u_lim: (mu * indentation * stiffness) / tangential,
    mismatch: (0.5 * unlike) / sum(bodies.map((body, k) => (1 - body.poisson) / shear[k])),
  };
  const sizes = [a, indentation, found.u_lim, found.pressure];
  if (!sizes.every((size) => size > 0 && size < Infinity)) {
    refuse("the load", `${general(load)} N`, "with these bodies, no contact that floating-point numbers can describe");
  }
  return found;
}

// The forward speed at the dimensionless velocity 1, in m/s; 0 for a bore without an amplitude.
function speedUnitOf({ motion, amplitude, frequency }, contact) {
  return 2 * Math.PI * frequency * (motion === "bore" ? amplitude * contact.a : contact.u_lim);
}

// Dimensionless velocity and amplitude of the motion: [velocity, amplitude].
function groupsOf(si, { motion, speed, amplitude, frequency }, contact) {
  const omega = 2 * Math.PI * frequency;
  const over = (unit) => (speed === 0 ? 0 : unit > 0 ? speed / unit : Infinity);
  if (motion !== "bore") return [over(omega * contact.u_lim), amplitude / contact.u_lim];
  if (amplitude === 0) return [0, 0];
  const twist = (4 / (Math.PI * (2 - contact.poisson))) * si.half_stuck;
  return [over(omega * amplitude * contact.a), (amplitude * contact.a) / contact.u_lim / twist];
}

// Quantities of the rules by name; null if a quantity is unknown or not defined.
function measuresOf(si, question, contact) {
  const { bodies, shear, a, pressure, radius, load, mu, u_lim } = contact;
  const hard = bodies.map((body) => body.hardness).filter((hardness) => hardness !== null);
  const tabor = ((si.adhesion ** 2 * radius) / (contact.stiffness ** 2 * si.range ** 3)) ** (1 / 3);
  const pull = (tabor > si.short ? 1.5 : 2) * Math.PI * si.adhesion * radius;
  const turns = question.motion === "bore";
  const along = turns ? 0 : question.amplitude, angle = turns ? question.amplitude : 0;
  const found = {
    largest_pressure: pressure,
    hardness: hard.length ? Math.min(...hard) : null,
    contact_radius: a,
    radius,
    smallest_radius: radius,
    over_radius: a / radius,
    over_smallest_radius: a / radius,
    mismatch: Math.abs(contact.mismatch),
    load,
    u_lim,
    mu,
    rubbers: bodies.filter((body) => body.poisson >= si.rubbery && body.young !== Infinity).length,
    tabor,
    maugis: 1.157 * tabor,
    pull_off: pull,
    pull_off_share: pull / load,
    amplitude: along,
    stroke: along / a,
    crossing: null,
    slip_speed: null,
  };
  bodies.forEach((body, k) => {
    const side = ["first", "second"][k];
    const known = body.hardness !== null || body.young === Infinity || body.poisson >= si.rubbery;
    found[`${side}_young`] = known ? null : body.young;
    found[`${side}_pressure`] = known ? null : pressure / body.young;
  });
  const waves = bodies.flatMap((body, k) =>
    body.density === null || body.young === Infinity ? [] : [Math.sqrt(shear[k] / body.density)]);
  if (waves.length) {
    const wave = Math.min(...waves), omega = 2 * Math.PI * question.frequency;
    found.crossing = (omega * a) / wave;
    found.slip_speed = (question.speed + omega * (along + a * angle)) / wave;
  }
  return found;
}

// Warnings: for each list of rules the first rule that applies.
function warningsOf(si, measures) {
  const value = (side) => (typeof side === "string" ? measures[side] : side);
  const holds = (rule) => rule.where.every(([left, factor, right]) =>
    value(left) !== null && value(right) !== null && value(left) > factor * value(right));
  return si.checks.map((rules) => rules.find(holds)).filter((rule) => rule !== undefined)
    .map((rule) => rule.text.replace(/\{(\w+):\.(\d+)g\}(?: (Pa|N|m)\b)?/g, (_, name, count, unit) =>
      unit ? withPrefix(si, measures[name], Number(count), unit) : general(measures[name], Number(count))));
}

// The largest unit prefix for which a value is at least 1, and its size. For 0, there is no prefix.
function prefixOf(si, value) {
  return si.prefixes.find(([, size]) => (Math.abs(value) || 1) >= size) ?? si.prefixes.at(-1);
}

function withPrefix(si, value, count, unit) {
  const [prefix, size] = prefixOf(si, value);
  return `${Number(general(value / size, count))} ${prefix}${unit}`;
}

function uncheckedOf(si, { bodies }) {
  return Object.entries(si.properties).flatMap(([name, what]) => {
    const whose = si.whose.filter((_, k) =>
      bodies[k][name] === null && bodies[k].young !== Infinity).join(" and ");
    const said = si.not_given.replace("{what}", what).replace("{name}", name);
    return whose ? [said.replace("{whose}", whose)] : [];
  });
}

// Returns the friction of a contact. `maps`: certified maps. Throws a Refusal if the contact is
// impossible. If no map contains the contact, `refused` is the reason, and `near` is the friction at
// the nearest Poisson's ratio.
function answerOf(si, maps, question) {
  const contact = contactOf(si, question);
  const [velocity, amplitude] = groupsOf(si, question, contact);
  if (!Number.isFinite(velocity)) {
    refuse(si.fields.speed.label, `${general(question.speed)} m/s`,
      "over that of the vibration, it is beyond the range of floating-point numbers");
  }
  if (!(amplitude <= si.largest_amplitude)) {
    refuse(si.fields[si.amplitude_of[question.motion]].label, general(question.amplitude),
      `${general(amplitude, 3)} in the unit of the map; allowed is at most ${general(si.largest_amplitude)}`);
  }
  const said = {
    motion: question.motion,
    velocity,
    amplitude,
    poisson: contact.poisson,
    contact_radius: contact.a,
    indentation: contact.indentation,
    largest_pressure: contact.pressure,
    u_lim: contact.u_lim,
    mu: question.mu,
    still: question.mu * question.load,
    warnings: warningsOf(si, measuresOf(si, question, contact)),
    not_checked: uncheckedOf(si, contact),
    friction: null,
    static_friction: null,
    refused: null,
    near: null,
    slowest: null,
  };
  // The static limit does not need a map.
  const still = staticLimit(si.rule, LIMITS[question.motion], amplitude, contact.poisson);
  said.static_friction = amplitude === 0 ? { value: 1, error: ROUNDING } : still;
  const map = mapFor(maps, question.motion, contact.poisson);
  if (map === undefined) {
    return { ...said, refused: `this page holds no certified map of ${question.motion}` };
  }
  const fast = Math.min(velocity, si.largest_velocity);
  try {
    said.friction = frictionAt(map, fast, amplitude, contact.poisson);
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    said.refused = error.message;
    said.near = unlessRefused(() => {
      const poisson = clipped(contact.poisson, ...map.poisson);
      return poisson === contact.poisson ? null : { poisson, ...frictionAt(map, fast, amplitude, poisson) };
    });
  }
  said.slowest = {
    speed: map.velocity[0] * speedUnitOf(question, contact),
    friction: unlessRefused(() => frictionAt(map, map.velocity[0], amplitude, contact.poisson)),
    map_error: map.error,
  };
  return said;
}

// The most accurate map of a motion whose range contains a Poisson's ratio.
function mapFor(maps, motion, poisson) {
  const far = ({ poisson: [low, high] }) => Math.abs(poisson - clipped(poisson, low - SAME_POISSON, high + SAME_POISSON));
  return maps.filter((one) => one.motion === motion && one.pressure === "hertz")
    .sort((a, b) => far(a) - far(b) || a.error - b.error)[0];
}

function unlessRefused(answer) {
  try {
    return answer();
  } catch (error) {
    if (error instanceof Refusal) return null;
    throw error;
  }
}
