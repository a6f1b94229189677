// Elliptic integrals for the limits of friction.

// Complete integrals at the complementary modulus q, 0 < q <= 1, by the arithmetic-geometric mean:
// K, and K - E without cancellation.
function complete(q) {
  let a = 1, b = q, sum = ((1 - q) * (1 + q)) / 2, power = 0.5;
  for (let k = 0; k < 60 && Math.abs(a - b) > 1e-16 * a; k++) {
    const difference = (a - b) / 2;
    [a, b] = [(a + b) / 2, Math.sqrt(a * b)];
    power *= 2;
    sum += power * difference * difference;
  }
  const K = Math.PI / (a + b);
  return { K, KlessE: K * sum };
}

function completeE(q) {
  if (q === 0) return 1;
  const { K, KlessE } = complete(q);
  return K - KlessE;
}

// Carlson's R_F(x, y, z), by duplication.
function carlsonF(x, y, z) {
  for (let k = 0; k < 60; k++) {
    const mean = (x + y + z) / 3;
    const [X, Y] = [1 - x / mean, 1 - y / mean], Z = -X - Y;
    if (Math.max(Math.abs(X), Math.abs(Y), Math.abs(Z)) < 1e-3) {
      const e2 = X * Y - Z * Z, e3 = X * Y * Z;
      const series = 1 - e2 / 10 + e3 / 14 + (e2 * e2) / 24 - (3 * e2 * e3) / 44 - (5 * e2 ** 3) / 208;
      return (series + (3 * e3 * e3) / 104 + (e2 * e2 * e3) / 16) / Math.sqrt(mean);
    }
    const root = Math.sqrt(x * y) + Math.sqrt(x * z) + Math.sqrt(y * z);
    [x, y, z] = [(x + root) / 4, (y + root) / 4, (z + root) / 4];
  }
  return NaN;
}

// Carlson's R_D(x, y, z).
function carlsonD(x, y, z) {
  let sum = 0, power = 1;
  for (let k = 0; k < 60; k++) {
    const mean = (x + y + 3 * z) / 5;
    const [X, Y] = [1 - x / mean, 1 - y / mean], Z = -(X + Y) / 3;
    if (Math.max(Math.abs(X), Math.abs(Y), Math.abs(Z)) < 1e-3) {
      const e2 = X * Y - 6 * Z * Z, e3 = (3 * X * Y - 8 * Z * Z) * Z;
      const e4 = 3 * (X * Y - Z * Z) * Z * Z, e5 = X * Y * Z ** 3;
      const series = 1 - (3 * e2) / 14 + e3 / 6 + (9 * e2 * e2) / 88 - (3 * e4) / 22 - (9 * e2 * e3) / 52 + (3 * e5) / 26;
      const rest = -(e2 ** 3) / 16 + (3 * e3 * e3) / 40 + (3 * e2 * e4) / 20;
      return (power * (series + rest)) / (mean * Math.sqrt(mean)) + 3 * sum;
    }
    const root = Math.sqrt(x * y) + Math.sqrt(x * z) + Math.sqrt(y * z);
    sum += power / (Math.sqrt(z) * (z + root));
    power /= 4;
    [x, y, z] = [(x + root) / 4, (y + root) / 4, (z + root) / 4];
  }
  return NaN;
}
