// A certified map: friction and its error bound at any point of its range.
//
// This file does not depend on the page, so that node can run it. The answers equal those of
// microslip.at; see datasets/query/cells.py and sweeps/map_coordinates.py for the derivation.

const SAME_POISSON = 1e-12; // ratios that differ by less count as equal

// An error for invalid arguments, with a one-line message.
class Refusal extends Error {}

function refuse(name, value, allowed) {
  throw new Refusal(`${name} = ${value}: ${allowed}`);
}

function clipped(value, low, high) {
  return Math.min(Math.max(value, low), high);
}

function bordersOf(map) {
  const [low, high] = map.amplitude;
  return [low, ...map.kink_amplitudes.filter((a) => low < a && a < high), high];
}

// Velocity of the kink at an amplitude, see theory/kinks.py.
function kinkVelocity(map, amplitude) {
  const [first, ...rest] = map.kink_velocity;
  if (!rest.length) return first;
  const [n1, c0, c1, c2] = rest, square = amplitude ** 2;
  return (first + n1 * amplitude + square) / (c0 + c1 * amplitude + c2 * square);
}

function isCut(map) {
  const [slow, fast] = map.velocity, { clear } = map.gathering;
  if (!map.kink_velocity.length || fast <= clear ** 2 * slow) return false;
  const atEnds = map.amplitude.map((amplitude) => kinkVelocity(map, amplitude));
  return Math.max(...atEnds) > clear * slow && Math.min(...atEnds) < fast / clear;
}

// Relative position of a value between two ends, clipped to 0 to 1.
function shareOf(value, [low, high]) {
  return clipped((value - low) / (high - low), 0, 1);
}

// Relative position of an amplitude A between two others in log(1 + spread A), 0 to 1.
function spreadShare(map, amplitude, ends) {
  const small = (a) => Math.log1p(map.gathering.spread * a);
  return shareOf(small(amplitude), ends.map(small));
}

// Scaled coordinate of an amplitude in a patch, 0 to 1. It is graded towards kinks and, in a patch
// between 0 and a kink, also towards 0.
function even(map, amplitude, ends) {
  const [low, above] = ends.map((end) => map.kink_amplitudes.includes(end));
  const below = low || (above && ends[0] === 0);
  const s = shareOf(amplitude, ends), power = 1 / map.gathering.at_kinks;
  if (below && above) return 0.5 - Math.sin(Math.asin(1 - 2 * s) / 3);
  if (!below && !above) return spreadShare(map, amplitude, ends);
  return below ? s ** power : 1 - (1 - s) ** power;
}

// Scaled amplitude of a map that is divided at kinks.
function rowOf(map, amplitude) {
  const borders = bordersOf(map);
  let y = 0;
  for (let row = 0; row + 1 < borders.length; row++) {
    const ends = [borders[row], borders[row + 1]];
    if (amplitude >= ends[0] && amplitude <= ends[1]) y = row + even(map, amplitude, ends);
  }
  return y;
}

// Scaled coordinates of a point in the range, one for each direction of the cells.
function scaled(map, velocity, amplitude, poisson) {
  const [slow, fast] = map.velocity, { clear, slow_power, faster } = map.gathering;
  const power = (v) => v ** slow_power;
  let x = shareOf(Math.log(velocity), [Math.log(slow), Math.log(fast)]), y = rowOf(map, amplitude);
  if (isCut(map)) {
    const middle = clipped(kinkVelocity(map, amplitude), clear * slow, fast / clear);
    if (velocity <= middle) {
      x = shareOf(power(velocity), [power(slow), power(middle)]);
    } else {
      x = faster + shareOf(Math.log(velocity), [Math.log(middle), Math.log(fast)]);
      y = spreadShare(map, amplitude, map.amplitude);
    }
  }
  return map.nodes.length > 2 ? [x, y, shareOf(poisson, map.poisson)] : [x, y];
}

// Lagrange weights of equally spaced nodes, at a relative position between the first and last node.
function weightsAt(count, share) {
  const at = (count - 1) * share;
  return Array.from({ length: count }, (_, own) => {
    let weight = 1;
    for (let other = 0; other < count; other++) {
      if (other !== own) weight *= (at - other) / (own - other);
    }
    return weight;
  });
}

// The polynomial of a cell. The nodes of the last direction are contiguous.
function polynomial(values, weights) {
  let left = values;
  for (const along of [...weights].reverse()) {
    const next = [];
    for (let start = 0; start < left.length; start += along.length) {
      next.push(along.reduce((sum, weight, k) => sum + weight * left[start + k], 0));
    }
    left = next;
  }
  return left[0];
}

// Friction and its error bound inside the range: [value, error]; [NaN, Infinity] if a point of the
// cell is unknown. On a border the last cell is used.
function inside(map, velocity, amplitude, poisson) {
  const place = scaled(map, velocity, amplitude, poisson);
  const directions = map.nodes.length, count = map.nodes.reduce((all, n) => all * n, 1);
  let found = [NaN, Infinity];
  for (let cell = 0; cell < map.bounds.length; cell++) {
    const ends = place.map((_, d) => {
      const at = 2 * (cell * directions + d);
      return [map.borders[at], map.borders[at + 1]];
    });
    if (place.some((at, d) => at < ends[d][0] || at > ends[d][1])) continue;
    const picked = map.cells.slice(cell * count, (cell + 1) * count).map((k) => map.values[k]);
    const weights = place.map((at, d) =>
      weightsAt(map.nodes[d], (at - ends[d][0]) / (ends[d][1] - ends[d][0])));
    const value = picked.includes(null) ? NaN : polynomial(picked, weights);
    const bound = map.bounds[cell];
    found = [value, Number.isNaN(value) || bound === null ? Infinity : bound];
  }
  return found;
}

// Returns Poisson's ratio. Throws a Refusal if it is outside the range of a map.
function poissonWithin(map, poisson) {
  const [low, high] = map.poisson;
  if (!(poisson >= low - SAME_POISSON && poisson <= high + SAME_POISSON)) {
    const range = high > low ? `${general(low)} to ${general(high)}` : `${general(low)}, the dataset's only one`;
    refuse("poisson", poisson, `allowed is ${range}; microslip.solve computes any`);
  }
  return poisson;
}

// Formats a number as Python's format "g" does, with `count` digits and without trailing zeros.
function general(value, count = 6) {
  if (!Number.isFinite(value) || value === 0) return String(value);
  const [digits, exponent] = rounded(Math.abs(value), count);
  const sign = value < 0 ? "-" : "", kept = digits.replace(/0+$/, "");
  if (exponent < -4 || exponent >= count) {
    const power = `${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
    return `${sign}${kept[0]}${kept.length > 1 ? `.${kept.slice(1)}` : ""}e${power}`;
  }
  if (exponent < 0) return `${sign}0.${"0".repeat(-exponent - 1)}${kept}`;
  const whole = digits.slice(0, exponent + 1), rest = kept.slice(exponent + 1);
  return sign + whole + (rest && `.${rest}`);
}

// Digits and exponent of a positive number, rounded half to even as in Python.
function rounded(value, count) {
  const [exact, power] = value.toExponential(count + 40).replace(".", "").split("e");
  if (/^50*$/.test(exact.slice(count)) && Number(exact[count - 1]) % 2 === 0) {
    return [exact.slice(0, count), Number(power)];
  }
  const [digits, exponent] = value.toExponential(count - 1).replace(".", "").split("e");
  return [digits, Number(exponent)];
}
