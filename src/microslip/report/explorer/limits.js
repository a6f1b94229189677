// Limits and bounds of friction outside the maps, by motion; see theory/paper.py and bounds.py.

const LOWEST = 2 ** -1022; // the smallest normal number

// Friction of a rigid slider, the limit for large amplitudes (Eq 6).
function largeTransverse(velocity, amplitude) {
  const total = Math.hypot(velocity, amplitude);
  const q = amplitude > 0 ? velocity / total : 1;
  const elliptic = q < 1e-9 ? Math.log(4) - Math.log(Math.max(q, LOWEST)) : complete(q).K;
  return (2 / Math.PI) * q * elliptic;
}

// Nodes of a quadrature rule over a stick zone of radius c: weight, sqrt(1 - r^2), sqrt(c^2 - r^2).
function stickZone(rule, c, complement) {
  const least = Math.max(complement, 1e-8), end = Math.asinh(c / least);
  return rule.nodes.map((node, k) => {
    const eta = end * Math.sin((Math.PI / 2) * node) ** 2;
    const step = end * (Math.PI / 2) * Math.sin(Math.PI * node) * rule.weights[k];
    return [step, least * Math.cosh(eta), least * Math.sinh(eta)];
  });
}

// Static friction under transverse oscillation for Poisson's ratio 0.
function staticTransverse(amplitude, rule) {
  const a = Math.min(amplitude, 1);
  const parts = stickZone(rule, Math.sqrt(1 - a), Math.sqrt(a)).map(([step, bound, inner]) =>
    step * inner * bound * Math.sqrt(inner * (2 * bound - inner)));
  return Math.min(3 * parts.reduce((sum, part) => sum + part, 0), 1);
}

// Stick radius of an oscillating bore (Eq 32), by Newton's method for its logarithm.
function boreStickRadius(amplitude) {
  const target = amplitude * complete(0.5).KlessE;
  let log = (-2 / Math.PI) * target;
  for (let k = 0; k < 30; k++) {
    const { K, KlessE } = complete(Math.exp(Math.max(log, -20)));
    const off = (log < -20 ? Math.log(4) - 1 - log : KlessE) - target;
    const change = off / (log < -20 ? 1 : K - KlessE);
    log = Math.min(log + change, 0);
    if (Math.abs(change) <= 1e-8 * Math.abs(log)) break;
  }
  return Math.max(Math.exp(log), LOWEST);
}

// Torsional traction over the friction bound at a radius inside the stick radius (Lubkin).
function torsionShare(r, c) {
  if (r >= c) return 1;
  const rho = r / c, cos2 = (1 - rho) * (1 + rho), delta2 = (1 - c * rho) * (1 + c * rho);
  const first = rho * carlsonF(cos2, delta2, 1);
  const rest = (rho ** 3 / 3) * carlsonD(cos2, delta2, 1) + rho * Math.sqrt(cos2 / delta2);
  const { K, KlessE } = complete(Math.max(c, 1e-150));
  const share = (2 / Math.PI) * ((K - KlessE) * first - (c > 1e-150 ? c * c * K : 0) * rest);
  return clipped(share, 0, 1);
}

// Static friction of an oscillating bore for every Poisson's ratio.
function staticBore(amplitude, rule) {
  const c = boreStickRadius(amplitude);
  const parts = stickZone(rule, c, Math.sqrt((1 - c) * (1 + c))).map(([step, bound, inner]) => {
    const r = Math.sqrt(Math.max(c - inner, 0) * (c + inner));
    return step * inner * bound ** 2 * Math.acos(torsionShare(r, c));
  });
  return Math.min((6 / Math.PI) * parts.reduce((sum, part) => sum + part, 0), 1);
}

// Friction of a steady bore at the velocity 1/inverse >= 1 (Eq 21): rings over their depth y.
function fastForward(inverse, rule) {
  return rule.nodes.reduce((sum, y, k) => {
    const rest = Math.sqrt(1 - inverse ** 2 * (1 - y * y)); // the complementary modulus
    return sum + 3 * rule.weights[k] * y * y * (2 / Math.PI) * completeE(rest);
  }, 0);
}

// Friction of a quasi-steady oscillating bore (Eq 29).
function largeBore(velocity, _amplitude, rule) {
  if (velocity === 0) return 0;
  if (velocity >= 1) {
    let sum = 0;
    for (let k = 0; k < 128; k++) {
      sum += fastForward(Math.cos((k + 0.5) * (Math.PI / 256)) / velocity, rule);
    }
    return sum / 128;
  }
  const v = clipped(velocity, LOWEST, 1 - 1e-16), gap = 1 - v;
  const sine = Math.sqrt(gap * (1 + v));
  const rotating = ((3 * Math.PI) / 8) * ((v - v ** 3 / 8) * Math.log((1 + sine) / v) - (v * sine) / 8);
  const end = Math.asinh(Math.sqrt(v / gap));
  const sliding = rule.nodes.reduce((sum, node, k) => {
    const sinh = Math.sinh(end * node), s = clipped(1 - (gap / v) * sinh ** 2, 0, 1);
    const part = (2 * Math.sqrt(gap) * sinh * fastForward(s, rule)) / Math.sqrt(1 + v * s);
    return sum + rule.weights[k] * part;
  }, 0);
  return (2 / Math.PI) * (rotating + end * sliding);
}

const LIMITS = {
  transverse: {
    still: staticTransverse,
    poissonDrop: 0.1, // POISSON_DROP of datasets/query/beyond.py
    large: largeTransverse,
    sameLimit: (velocity, amplitude, other) => (velocity * other) / amplitude,
    drop: (velocity, amplitude) => (amplitude === 0 ? 0 : 1 / ((velocity / amplitude) ** 2 + 0.5)),
  },
  bore: {
    still: staticBore,
    poissonDrop: 0,
    large: largeBore,
    sameLimit: (velocity) => velocity,
    drop: (velocity, amplitude) => {
      if (amplitude === 0) return 0;
      return velocity <= 1 ? 1 : Math.min(1, 0.2 / (velocity - 1) ** 2);
    },
  },
};
