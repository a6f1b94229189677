// Friction at any velocity and amplitude: from a certified map, or from bounds outside its range.
//
// The answers equal those of microslip.at; see datasets/query/beyond.py for the derivation.

const ROUNDING = 1e-12;
const SLOW_EXPONENT = 2 / 3; // power of the velocity with which friction approaches its static limit
const FAST_EXPONENT = 2; // power of 1 / velocity with which friction approaches 1
const NARROW_EXPONENT = 1; // power of the amplitude with which friction departs from 1
const WIDE_EXPONENT = 1; // power of 1 / amplitude with which friction nears its large-amplitude limit
const STEEPEST = 2; // largest local exponent of a power law, relative to the asymptotic one

// Clips a value to its bracket. Returns the result and its largest distance to an end of the
// bracket.
function bracketed(low, high, guess) {
  const value = clipped(guess, low, high);
  return [value, Math.max(high - value, value - low) + ROUNDING];
}

function largestKnown(a, b) {
  if (Number.isNaN(a)) return b;
  return Number.isNaN(b) ? a : Math.max(a, b);
}

const largeAtEdges = new WeakMap();

// The large-amplitude limit along the upper edge of a map, computed once.
function largeAtEdge(map, limits) {
  if (!largeAtEdges.has(map)) {
    largeAtEdges.set(map, map.edge.map((at) => limits.large(at, map.amplitude[1], map.rule)));
  }
  return largeAtEdges.get(map);
}

// Largest difference between the upper edge of the map and the large-amplitude limit, within a
// decade of a velocity.
function distanceAt(map, limits, velocity, poisson) {
  const [slow, fast] = map.velocity, widest = map.amplitude[1];
  const away = map.edge.map((at) => Math.abs(Math.log10(clipped(velocity, slow, fast) / at)));
  const nearest = Math.min(...away);
  const ends = largeAtEdge(map, limits);
  let most = 0;
  map.edge.forEach((at, k) => {
    if (away[k] > 1 && away[k] !== nearest) return;
    const [value, error] = inside(map, at, widest, poisson);
    const off = Math.abs(value - ends[k]) + error;
    most = Number.isNaN(off) ? NaN : Math.max(most, off);
  });
  return most;
}

// Returns friction, its error bound, and its source: { value, error, source }. Throws a Refusal if
// an argument is invalid, or outside the map of a motion without limits.
function frictionAt(map, velocity, amplitude, poisson) {
  for (const [name, value] of Object.entries({ velocity, amplitude })) {
    if (!(Number.isFinite(value) && value >= 0)) refuse(name, value, "allowed is a finite number >= 0");
  }
  const nu = poissonWithin(map, poisson);
  const limits = map.has_limits ? LIMITS[map.motion] : undefined;
  if (limits === undefined) return mapAlone(map, velocity, amplitude, nu);
  const [slowest, fastest] = map.velocity, [narrowest, widest] = map.amplitude;
  if (amplitude === 0) return { value: 1, error: ROUNDING, source: "no vibration" };
  const wide = amplitude > widest;
  const below = wide ? limits.sameLimit(velocity, amplitude, widest) : velocity;
  let [value, error] = inside(map, clipped(below, slowest, fastest),
    clipped(amplitude, narrowest, widest), nu);
  let source = "map";
  if (amplitude < narrowest) {
    const low = clipped(value - error, 0, 1);
    const share = (amplitude / narrowest) ** NARROW_EXPONENT, gap = Math.max(1 - value - error, 0);
    const high = Math.max(1 - share ** STEEPEST * gap, low);
    [value, error] = bracketed(low, high, 1 - (1 - value) * share);
    source = "between map and no vibration";
  }
  const held = Math.min(amplitude, widest);
  if (below < slowest) {
    const still = staticLimit(map.rule, limits, held, nu), least = Math.max(still.value - still.error, 0);
    const share = (below / slowest) ** SLOW_EXPONENT;
    const low = least + share ** STEEPEST * Math.max(value - error - least, 0);
    const high = Math.max(value + error, still.value + still.error);
    [value, error] = bracketed(low, high, still.value + share * (value - still.value));
    source = "between static limit and map";
  } else if (below > fastest) {
    const low = clipped(largestKnown(1 - limits.drop(below, held), value - error), 0, 1);
    const share = (fastest / below) ** FAST_EXPONENT, gap = largestKnown(1 - value - error, 0);
    const high = Math.max(1 - share ** STEEPEST * gap, low), far = 1 - (1 - value) * share;
    [value, error] = bracketed(low, high, Number.isNaN(far) ? low : far);
    source = "between map and fast sliding";
  }
  if (wide) {
    const end = limits.large(velocity, amplitude, map.rule);
    const share = (widest / amplitude) ** WIDE_EXPONENT, gap = (value - end) * share;
    error += (distanceAt(map, limits, below, nu) + Math.abs(gap)) * (1 - share ** STEEPEST);
    value = clipped(end + gap, 0, 1);
    source = "between map and large amplitude";
  }
  [value, error] = withinTheBalance(limits, value, error, velocity, amplitude);
  if (velocity === 0) {
    return { ...staticLimit(map.rule, limits, amplitude, nu), source: "static limit" };
  }
  return { value, error: Number.isNaN(value) || Number.isNaN(error) ? Infinity : error, source };
}

// Friction and its error bound in the limit of vanishing velocity, at any Poisson's ratio.
function staticLimit(rule, limits, amplitude, poisson) {
  const high = limits.still(amplitude, rule);
  const low = Math.max(high - limits.poissonDrop * (poisson / (2 - poisson)) ** 2, 0);
  return { value: (high + low) / 2, error: (high - low) / 2 + ROUNDING };
}

// Clips a result to the bounds from the energy balance. NaN is not changed.
function withinTheBalance(limits, value, error, velocity, amplitude) {
  const low = Math.max(1 - limits.drop(velocity, amplitude), 0);
  const kept = clipped(value, low, 1);
  const reach = Math.max(1 - kept, kept - low) + ROUNDING;
  return [kept, Number.isNaN(kept) ? error : Math.min(error, reach)];
}

// Friction from the map alone, for a motion without limits.
function mapAlone(map, velocity, amplitude, poisson) {
  const what = map.pressure === "hertz" ? map.motion : `pressure ${map.pressure}`;
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
