// Friction at any velocity and amplitude: a certified map, and the proved limits where it ends.
//
// It says what friction.at says in Python; datasets/query/beyond.py tells why. Of the bore two limits
// are no elementary functions: questions that need them are refused.

const ROUNDING = 1e-12;
const SLOW_EXPONENT = 2 / 3; // of the velocity with which friction comes close to its static limit
const LOWEST = 2 ** -1022; // the smallest normal number

// K at the complementary modulus q, 0 < q <= 1, by the arithmetic-geometric mean.
function completeK(q) {
  let a = 1, b = q;
  for (let k = 0; k < 60 && Math.abs(a - b) > 1e-16 * a; k++) [a, b] = [(a + b) / 2, Math.sqrt(a * b)];
  return Math.PI / (a + b);
}

// A rigid slider: what friction tends to at large amplitudes (Eq 6).
function largeTransverse(velocity, amplitude) {
  const total = Math.hypot(velocity, amplitude);
  const q = amplitude > 0 ? velocity / total : 1;
  const elliptic = q < 1e-9 ? Math.log(4) - Math.log(Math.max(q, LOWEST)) : completeK(q);
  return (2 / Math.PI) * q * elliptic;
}

// Static friction for Poisson's ratio 0: an integral over the stick zone by the nodes of `rule`.
function staticTransverse(amplitude, rule) {
  const a = Math.min(amplitude, 1);
  const complement = Math.max(Math.sqrt(a), 1e-8);
  const end = Math.asinh(Math.sqrt(1 - a) / complement);
  let sum = 0;
  rule.nodes.forEach((node, k) => {
    const eta = end * Math.sin((Math.PI / 2) * node) ** 2;
    const step = end * (Math.PI / 2) * Math.sin(Math.PI * node) * rule.weights[k];
    const bound = complement * Math.cosh(eta), inner = complement * Math.sinh(eta);
    sum += step * inner * bound * Math.sqrt(inner * (2 * bound - inner));
  });
  return Math.min(3 * sum, 1);
}

const LIMITS = {
  transverse: {
    still: staticTransverse,
    stillNeedsPoisson0: true,
    large: largeTransverse,
    sameLimit: (velocity, amplitude, other) => (velocity * other) / amplitude,
    drop: (velocity, amplitude) => (amplitude === 0 ? 0 : 1 / ((velocity / amplitude) ** 2 + 0.5)),
  },
  bore: {
    still: null,
    stillNeedsPoisson0: false,
    large: null,
    sameLimit: (velocity) => velocity,
    drop: (velocity, amplitude) => {
      if (amplitude === 0) return 0;
      return velocity <= 1 ? 1 : Math.min(1, 0.2 / (velocity - 1) ** 2);
    },
  },
};

// A guess brought into its bracket, and how far the bracket reaches from there.
function bracketed(low, high, guess) {
  const value = clipped(guess, low, high);
  return [value, Math.max(high - value, value - low) + ROUNDING];
}

function largestKnown(a, b) {
  if (Number.isNaN(a)) return b;
  return Number.isNaN(b) ? a : Math.max(a, b);
}

// Largest distance from the limit for large amplitudes that the upper edge of the map shows within a
// decade of a velocity.
function distanceAt(map, limits, velocity, poisson) {
  const [slow, fast] = map.velocity, widest = map.amplitude[1];
  const away = map.edge.map((at) => Math.abs(Math.log10(clipped(velocity, slow, fast) / at)));
  const nearest = Math.min(...away);
  let most = 0;
  map.edge.forEach((at, k) => {
    if (away[k] > 1 && away[k] !== nearest) return;
    const [value, error] = inside(map, at, widest, poisson);
    const off = Math.abs(value - limits.large(at, widest)) + error;
    most = Number.isNaN(off) ? NaN : Math.max(most, off);
  });
  return most;
}

// Friction, the bound of its error, and where the answer comes from: { value, error, source }. Raises
// Refusal for what is no question, and for what no limit is known of.
function frictionAt(map, velocity, amplitude, poisson) {
  for (const [name, value] of Object.entries({ velocity, amplitude })) {
    if (!(Number.isFinite(value) && value >= 0)) refuse(name, value, "allowed is a finite number >= 0");
  }
  const nu = poissonWithin(map, poisson);
  const limits = map.has_limits ? LIMITS[map.scene] : undefined;
  if (limits === undefined) return mapAlone(map, velocity, amplitude, nu);
  const [slowest, fastest] = map.velocity, [narrowest, widest] = map.amplitude;
  if (limits.stillNeedsPoisson0 && nu > 0 && velocity < slowest) {
    refuse("velocity", general(velocity), `allowed for nu = ${general(nu)} is ${general(slowest)} or more: ` +
      "the static limit is proved for nu = 0; microslip.solve computes it");
  }
  if (amplitude === 0) return { value: 1, error: ROUNDING, source: "no vibration" };
  const wide = amplitude > widest;
  const below = wide ? limits.sameLimit(velocity, amplitude, widest) : velocity;
  refuseUnknown(map, limits, below, amplitude);
  let [value, error] = inside(map, clipped(below, slowest, fastest),
    clipped(amplitude, narrowest, widest), nu);
  let source = "map";
  if (amplitude < narrowest) {
    const low = clipped(value - error, 0, 1);
    [value, error] = bracketed(low, 1, 1 - ((1 - value) * amplitude) / narrowest);
    source = "between map and no vibration";
  }
  const held = Math.min(amplitude, widest);
  if (below < slowest && limits.still) {
    const still = limits.still(held, map.rule), share = (below / slowest) ** SLOW_EXPONENT;
    [value, error] = bracketed(still, Math.max(value + error, still), still + share * (value - still));
    source = "between static limit and map";
  } else if (below > fastest) {
    const low = clipped(largestKnown(1 - limits.drop(below, held), value - error), 0, 1);
    const far = 1 - (1 - value) * (fastest / below) ** 2;
    [value, error] = bracketed(low, 1, Number.isNaN(far) ? low : far);
    source = "between map and fast sliding";
  }
  if (wide) {
    const end = limits.large(velocity, amplitude);
    const left = ((value - end) * widest) / amplitude;
    error = distanceAt(map, limits, below, nu) + Math.abs(left) + error;
    value = clipped(end + left, 0, 1);
    source = "between map and large amplitude";
  }
  [value, error] = withinTheBalance(limits, value, error, velocity, amplitude);
  if (velocity === 0) {
    [value, error, source] = [limits.still(amplitude, map.rule), ROUNDING, "static limit"];
  }
  return { value, error: Number.isNaN(value) || Number.isNaN(error) ? Infinity : error, source };
}

// No worse than the energy balance allows; NaN stays what it is.
function withinTheBalance(limits, value, error, velocity, amplitude) {
  const low = Math.max(1 - limits.drop(velocity, amplitude), 0);
  const kept = clipped(value, low, 1);
  const reach = Math.max(1 - kept, kept - low) + ROUNDING;
  return [kept, Number.isNaN(kept) ? error : Math.min(error, reach)];
}

function refuseUnknown(map, limits, velocity, amplitude) {
  const [slowest] = map.velocity, [, widest] = map.amplitude;
  const advice = "the page does not know its limit beyond; friction.at and microslip.solve do";
  if (velocity < slowest && !limits.still) {
    refuse("velocity", general(velocity), `allowed for ${map.scene} is ${general(slowest)} or more: ${advice}`);
  }
  if (amplitude > widest && !limits.large) {
    refuse("amplitude", general(amplitude), `allowed for ${map.scene} is ${general(widest)} or less: ${advice}`);
  }
}

// Answers of a map that no limit is known of.
function mapAlone(map, velocity, amplitude, poisson) {
  const what = map.pressure === "hertz" ? map.scene : `pressure ${map.pressure}`;
  const advice = `no limit of ${what} is known: with a tolerance the solver is asked`;
  if (velocity === 0) refuse("velocity", 0, `the map has none such; ${advice}`);
  for (const [name, value] of Object.entries({ velocity, amplitude })) {
    const [low, high] = map[name];
    if (value < low || value > high) {
      refuse(name, general(value), `allowed is ${general(low)} to ${general(high)}; ${advice}`);
    }
  }
  const [value, error] = inside(map, velocity, amplitude, poisson);
  return { value, error, source: "map" };
}
